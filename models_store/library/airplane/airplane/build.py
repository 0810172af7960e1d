"""Models an airplane, nose towards +x: fuselage, wings, tail, and one of several kinds of engines.

Left follows right in operations of its own. What can be elsewhere (a second pair of wings above, a tailplane on top of
the fin, twin fins) is modelled in the same strokes as the usual one.
"""

from pathlib import Path

from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.sketching import edge_towards, push, put
from models_store.library.annotations import AnnotatingRecorder, publish_annotated
from shapewright.modeling import Component, Element, Mirror, ProceduralModel, Target, when

SIDES = 8
DIAMETER = 1.2
FRONT, NOSE, REAR, TAIL = 2.4, 1.2, 2.6, 2.0
CHORD, THICKNESS, SPAN = 1.7, 0.14, 4.2
TAPER = 0.45  # share of the chord that is lost at the tip
SWEEP, DIHEDRAL, BELOW = 1.1, 0.35, 0.25
GAP = 1.3
FIN, STABILIZER, TAIL_CHORD, TAIL_TAPER, TAIL_SWEEP = 1.3, 1.5, 1.0, 0.6, 0.45
ENGINE, ENGINE_LENGTH = 0.5, 1.1


def model() -> AnnotatingRecorder:
    """Model the airplane."""
    r = AnnotatingRecorder(
        "airplane", "airplane", unit_m=1.0, description="An airplane: airliner, propeller plane, biplane, jet."
    )
    r.parameter("fuselage_diameter", "Fuselage diameter", 0.5, 1.5, unit="m", base_value=DIAMETER)
    r.parameter("fuselage_flatness", "Fuselage height (of its width)", 0.7, 1.4, base_value=1.0)
    r.parameter("front_length", "Fuselage length before the wings", 0.5, 1.8, unit="m", base_value=FRONT)
    r.parameter("rear_length", "Fuselage length behind the wings", 0.5, 1.6, unit="m", base_value=REAR)
    r.parameter("nose_length", "Nose length", 0.5, 2.8, unit="m", base_value=NOSE)
    r.parameter("tail_upsweep", "Tail upsweep", -0.5, 2.0, unit="m", base_value=0.2)
    r.switch("canopy", "Canopy")
    r.parameter("wing_span", "Wing length", 0.4, 1.6, unit="m", base_value=SPAN)
    r.parameter("wing_chord", "Wing chord at the root", 0.55, 1.8, unit="m", base_value=CHORD)
    r.parameter("wing_thickness", "Wing thickness", 0.3, 1.6, unit="m", base_value=THICKNESS)
    r.parameter("wing_taper", "Wing taper (share of chord lost at the tip)", 0.0, 2.0, base_value=TAPER)
    r.parameter("wing_sweep", "Wing sweep (setback of the tip)", -0.4, 3.0, unit="m", base_value=SWEEP)
    r.parameter("wing_dihedral", "Rise of the wing tips", -2.0, 3.0, unit="m", base_value=DIHEDRAL)
    r.parameter("wing_drop", "Distance of the wings below the axis", -1.5, 1.5, unit="m", base_value=BELOW)
    r.limit("wing_drop", minimum=("fuselage_diameter", 0.0, -1.0), maximum=("fuselage_diameter", 0.0, 1.0))
    r.choice("wings", "Wings", ("one pair", "two pairs, one above the other"))
    r.parameter(
        "wing_gap", "Gap between the wings", 0.75, 1.35, unit="m", base_value=GAP, active_when=[when("wings", 2)]
    )
    r.choice("tail", "Tail", ("conventional", "twin fins", "T-tail"))
    r.parameter("fin_height", "Fin height", 0.5, 1.6, unit="m", base_value=FIN)
    r.parameter("stabilizer_span", "Tailplane length", 0.5, 1.6, unit="m", base_value=STABILIZER)
    r.parameter("tail_chord", "Chord of the tail's surfaces", 0.6, 1.5, unit="m", base_value=TAIL_CHORD)
    r.choice(
        "engines",
        "Engines",
        ("two under the wings", "four under the wings", "two at the rear", "propeller at the nose", "inside"),
    )
    jets = [when("engines", 1, 3)]
    r.parameter("engine_size", "Engine diameter", 0.6, 1.6, unit="m", base_value=ENGINE, active_when=jets)
    r.parameter("engine_length", "Engine length", 0.6, 2.2, unit="m", base_value=ENGINE_LENGTH, active_when=jets)
    body, nose, joint = _fuselage(r)
    wings = _wings(r, body)
    _tail(r, body)
    _engines(r, wings, joint)
    _propeller(r, nose)
    r.symmetry(mirrors=("y",))
    return r


def build() -> ProceduralModel:
    """Return the procedural model."""
    return model().build()


def _fuselage(r: AnnotatingRecorder) -> tuple[Component, Element, list[Element]]:
    """A tube of diameter 1 first; its nose, and the section before the tail."""
    body = r.prism(SIDES, control_diameter(1.0, SIDES), CHORD, offset=(0.0, 0.0, -CHORD / 2))
    r.judge("laying the fuselage down", important=False)
    r.rotate(put(body.whole), 90.0, "v")
    r.judge("length of the front", important=True)
    r.extrude(body.top, FRONT, length="front_length")
    cockpit = r.vertices_of(body.top)
    for share, size in ((0.45, 0.8), (0.4, 0.5), (0.15, 0.3)):
        r.judge("nose length", important=True)
        r.extrude(body.top, share * NOSE, length="nose_length")
        r.judge("slimness of the nose", important=False)
        r.scale(body.top, size, "uv")
    r.judge("length of the rear", important=True)
    r.extrude(body.bottom, REAR, length="rear_length")
    joint = r.vertices_of(body.bottom)
    r.judge("slimness of the rear", important=False)
    r.scale(body.bottom, 0.85, "uv")
    r.judge("length of the rear", important=True)
    r.extrude(body.bottom, TAIL, length="rear_length")
    r.judge("thickness of the tail", important=False)
    r.scale(body.bottom, 0.35, "uv")
    r.judge("tail upsweep", important=False)
    push(r, body.bottom, (0.0, 0.0, 0.2), length="tail_upsweep")
    r.mark_sharp(body.bottom)
    r.judge("fuselage diameter", important=True)
    r.scale(put(body.whole), DIAMETER, "vz", size="fuselage_diameter")
    r.judge("fuselage height", important=True)
    r.scale(put(body.whole, pivot=tuple(cockpit)), 1.0, "z", size="fuselage_flatness")
    seat = max(cockpit, key=lambda vertex: float(r.positions(vertex)[0, 2]))
    canopy = r.box(1.9, 0.8, 0.75, offset=(-0.35, 0.0, -0.4), anchor=put(seat))
    r.judge("length of the canopy's roof", important=False)
    r.scale(put(canopy.top), 0.55, "u")
    r.judge("width of the canopy's roof", important=False)
    r.scale(put(canopy.top), 0.75, "v")
    r.part("canopy", [canopy], [when("canopy", 1)])
    return body, body.top, joint


def _wings(r: AnnotatingRecorder, body: Component) -> dict[int, list[tuple[Element, ...]]]:
    """A lower and an upper wing on each side; returns the sections of the lower ones: root, root of the tip, tip.

    The struts between them belong to the upper ones.
    """
    sections: dict[int, list[tuple[Element, ...]]] = {}
    upper: list[Component] = []
    middle = put(*(v for v in r.vertices_of(body.whole) if abs(r.positions(v)[0, 0]) < CHORD))
    for side in (1, -1):
        pair = [r.box(1.0, 0.4, 1.0, offset=(0.0, 0.2 * side, -0.5), anchor=middle) for _ in range(2)]
        tips = [wing.sides[1 + side] for wing in pair]
        root = [tuple(r.vertices_of(face)) for face in (pair[0].sides[1 - side], tips[0])]
        r.mark_sharp(*(face for wing in pair for face in wing.faces))
        r.judge("wing length", important=True, direction="wing sweep by turning")
        r.extrude([put(face) for face in tips], 0.0, SPAN, 90.0 * side, length="wing_span")
        r.mark_sharp(*(new for face in tips for new in r.new_sides(face)))
        r.judge("wing taper", important=True)
        r.drag(_fore_and_aft(r, tips), 0.0, TAPER / 2, 180.0, length="wing_taper")
        wholes = [put(wing.whole) for wing in pair]
        r.judge("wing thickness", important=False)
        r.scale(wholes, THICKNESS, "z", size="wing_thickness")
        r.judge("wing chord", important=True)
        r.scale(wholes, CHORD, "u", size="wing_chord")
        r.judge("wing sweep", important=True)
        r.drag([put(face) for face in tips], 0.0, SWEEP, 180.0, length="wing_sweep")
        r.judge("rise of the wing tips", important=True)
        r.drag([put(face) for face in tips], DIHEDRAL, length="wing_dihedral")
        r.judge("height of the wings on the fuselage", important=False)
        r.drag(wholes, -BELOW, length="wing_drop")
        sections[side] = [*root, tuple(r.vertices_of(tips[0]))]
        feet = [put(*root[1], *sections[side][2]), put(*root[0], *root[1])]
        struts = [
            r.box(0.08, 0.05, 0.1, offset=(along, 0.0, -0.05), anchor=foot) for foot in feet for along in (-0.25, 0.25)
        ]
        r.judge("gap between the wings", important=True)
        push(r, put(pair[1].whole, *(strut.top for strut in struts)), (0.0, 0.0, GAP), length="wing_gap")
        upper += [pair[1], *struts]
    r.part("upper wings", upper, [when("wings", 2)])
    return sections


def _fore_and_aft(r: AnnotatingRecorder, faces: list[Element]) -> list[Target]:
    """Return the front edges of wing tips, and the rear ones as their mirror images."""
    front = [put(edge_towards(r, face, (1.0, 0.0, 0.0))) for face in faces]
    rear = [Target((edge_towards(r, face, (-1.0, 0.0, 0.0)),), "world", (Mirror("x"),)) for face in faces]
    return front + rear


def _tail(r: AnnotatingRecorder, body: Component) -> None:
    """One fin or two, and a tailplane at their feet or on top of the one."""
    end = put(body.bottom)
    fins = [r.box(1.0, 0.09, 0.4, offset=(0.45, y, -0.1), anchor=end) for y in (0.0, 0.45, -0.45, 0.0)]
    tops = [put(fin.top) for fin in fins]
    r.mark_sharp(*(face for fin in fins for face in fin.faces))
    r.judge("fin height", important=True)
    r.extrude([fin.top for fin in fins], FIN, length="fin_height")
    r.mark_sharp(*(side for fin in fins for side in r.new_sides(fin.top)))
    r.judge("fin taper", important=False)
    r.scale(tops, TAIL_TAPER, "u")
    r.judge("fin sweep", important=False)
    r.drag(tops, 0.0, TAIL_SWEEP, 180.0)
    r.judge("fin chord", important=True)
    r.scale([put(fin.whole) for fin in fins], TAIL_CHORD, "u", size="tail_chord")
    planes = []
    for side in (1, -1):
        low = r.box(1.0, 0.3, 0.08, offset=(0.4, 0.15 * side, -0.04), anchor=end)
        high = r.box(1.0, 0.3, 0.08, offset=(0.0, 0.15 * side, -0.04), anchor=put(fins[3].top))
        tips = [plane.sides[1 + side] for plane in (low, high)]
        r.mark_sharp(*low.faces, *high.faces)
        r.judge("tailplane length", important=True, direction="tailplane sweep by turning")
        r.extrude([put(tip) for tip in tips], 0.0, STABILIZER, 90.0 * side, length="stabilizer_span")
        r.mark_sharp(*(new for tip in tips for new in r.new_sides(tip)))
        r.judge("tailplane taper", important=False)
        r.scale([put(tip) for tip in tips], TAIL_TAPER, "u")
        r.judge("tailplane sweep", important=False)
        r.drag([put(tip) for tip in tips], 0.0, TAIL_SWEEP, 180.0)
        r.judge("tailplane chord", important=True)
        r.scale([put(plane.whole) for plane in (low, high)], TAIL_CHORD, "u", size="tail_chord")
        planes.append((low, high))
    r.part("fin", fins[:1], [when("tail", 1)])
    r.part("twin fins", fins[1:3], [when("tail", 2)])
    r.part("low tailplane", [low for low, _ in planes], [when("tail", 1, 2)])
    r.part("T-tail", [fins[3], *(high for _, high in planes)], [when("tail", 3)])


def _engines(r: AnnotatingRecorder, wings: dict[int, list[tuple[Element, ...]]], rear: list[Element]) -> None:
    """Nacelles below the wings at two places and at the rear of the fuselage, all alike."""
    ring = sorted(rear, key=lambda vertex: float(r.positions(vertex)[0, 1]))
    inner = [(*wings[side][0], *wings[side][1], *wings[side][2]) for side in (1, -1)]
    outer = [(*wings[side][1], *wings[side][2]) for side in (1, -1)]
    sides = [(ring[-1],), (ring[0],)]
    pairs, pylons = [], []
    for places, at, size, pylon_at in (
        (inner, (0.45, 0.0, -0.42), (0.7, 0.08, 0.42), (0.15, 0.0, -0.42)),
        (outer, (0.45, 0.0, -0.42), (0.7, 0.08, 0.42), (0.15, 0.0, -0.42)),
        (sides, (0.1, 0.3, 0.05), (0.6, 0.6, 0.08), (0.1, 0.0, 0.01)),
    ):
        anchors = [put(*places[0]), Target(places[1], "world", (Mirror("y"),))]
        diameter = control_diameter(1.0, SIDES)
        low = (at[0], at[1], at[2] - 0.4)
        pairs.append(r.base("prism", (diameter, diameter, 0.8), sides=SIDES, offset=low, anchors=anchors))
        pylons.append(r.base("box", size, offset=pylon_at, anchors=anchors))
        r.mark_sharp(*(face for pylon in pylons[-1] for face in pylon.faces))
    images = [(), (Mirror("y"),)] * 3
    nacelles = [nacelle for pair in pairs for nacelle in pair]

    def targets(elements: list[Element]) -> list[Target]:
        return [Target((element,), "world", image) for element, image in zip(elements, images, strict=True)]

    wholes = targets([nacelle.whole for nacelle in nacelles])
    intakes, outlets = [n.top for n in nacelles], [n.bottom for n in nacelles]
    r.judge("laying the engines down", important=False)
    r.rotate(wholes, 90.0, "v")
    for faces, label, length, width in (
        (intakes, "lip of the intake", 0.1, 0.85),
        (outlets, "outlet", 0.15, 0.65),
        (intakes, "depth of the intake", -0.15, 0.8),
    ):
        r.judge(label, important=False)
        r.extrude(faces, length)
        r.judge(f"width of the {label.removeprefix('depth of the ')}", important=False)
        r.scale(faces, width, "uv")
    r.judge("engine length", important=False)
    r.scale(wholes, ENGINE_LENGTH, "u", size="engine_length")
    r.judge("engine diameter", important=True)
    r.scale(wholes, ENGINE, "vz", size="engine_size")
    r.part("inner engines", [*pairs[0], *pylons[0]], [when("engines", 1, 2)])
    r.part("outer engines", [*pairs[1], *pylons[1]], [when("engines", 2)])
    r.part("engines at the rear", [*pairs[2], *pylons[2]], [when("engines", 3)])


def _propeller(r: AnnotatingRecorder, nose: Element) -> None:
    """A spinner on the nose and a blade through it."""
    tip = put(nose)
    spinner = r.prism(SIDES, 0.34, 0.4, offset=(0.0, 0.0, -0.2), anchor=tip)
    r.judge("laying the spinner down", important=False)
    r.rotate(put(spinner.whole), 90.0, "v")
    r.judge("tip of the spinner", important=False)
    r.scale(spinner.top, 0.4, "uv")
    blade = r.box(0.05, 0.16, 2.0, offset=(0.05, 0.0, -1.0), anchor=tip)
    r.mark_sharp(*blade.faces)
    r.part("propeller", [spinner, blade], [when("engines", 4)])


if __name__ == "__main__":
    publish_annotated(model(), Path(__file__).parent)
