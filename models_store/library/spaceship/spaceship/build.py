"""Models a spaceship, bow towards +x: a disc that stretches to a hull, with wings, nacelles on pylons, a second hull.

The right side is modelled first, then the left one in operations of its own.
"""

import math
from pathlib import Path

from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.sketching import grow, push, put
from models_store.library.annotations import AnnotatingRecorder, publish_annotated
from shapewright.modeling import Component, Element, Mirror, ProceduralModel, Target, when

SIDES = 12
LENGTH, WIDTH, RIM = 9.0, 6.0, 0.9
BOW, STERN = 0.6, 0.8
DOME, KEEL = 0.8, 0.5
WING, WING_CHORD, WING_RISE = 3.0, 2.4, 0.4
PYLON, NACELLE_LENGTH, NACELLE = 1.6, 4.5, 0.8
NECK, SECOND_LENGTH, SECOND = 1.2, 5.0, 1.5
FIN = 1.6


def model() -> AnnotatingRecorder:
    """Model the spaceship."""
    r = AnnotatingRecorder(
        "spaceship", "spaceship", unit_m=1.0, description="A spaceship: saucer, cruiser, shuttle or fighter."
    )
    r.parameter("hull_length", "Hull length", 0.45, 1.9, unit="m", base_value=LENGTH)
    r.parameter("hull_width", "Hull width", 0.4, 1.7, unit="m", base_value=WIDTH)
    r.parameter("rim_height", "Height of the hull's rim", 0.3, 1.8, unit="m", base_value=RIM)
    r.parameter("bow_width", "Bow width (of the hull's)", 0.3, 1.7, base_value=BOW)
    r.parameter("stern_width", "Stern width (of the hull's)", 0.5, 1.3, base_value=STERN)
    r.parameter("dome_height", "Height of the upper dome", 0.1, 2.3, unit="m", base_value=DOME)
    r.parameter("keel_height", "Height of the lower dome", 0.1, 2.2, unit="m", base_value=KEEL)
    r.switch("wings", "Wings")
    winged = [when("wings", 1)]
    r.parameter("wing_span", "Wing length", 0.4, 1.8, unit="m", base_value=WING, active_when=winged)
    r.parameter("wing_chord", "Wing chord", 0.4, 1.5, unit="m", base_value=WING_CHORD, active_when=winged)
    r.parameter("wing_rise", "Rise of the wing tips", -3.0, 4.0, unit="m", base_value=WING_RISE, active_when=winged)
    r.choice("nacelles", "Nacelles", ("two above", "two above and two below", "none"))
    driven = [when("nacelles", 1, 2)]
    r.parameter("pylon_length", "Pylon length", 0.5, 2.0, unit="m", base_value=PYLON, active_when=driven)
    r.parameter("nacelle_length", "Nacelle length", 0.5, 1.7, unit="m", base_value=NACELLE_LENGTH, active_when=driven)
    r.parameter("nacelle_width", "Nacelle diameter", 0.5, 1.7, unit="m", base_value=NACELLE, active_when=driven)
    r.switch("second_hull", "Second hull below")
    second = [when("second_hull", 1)]
    r.parameter("neck_length", "Neck length", 0.3, 2.0, unit="m", base_value=NECK, active_when=second)
    r.parameter(
        "second_length", "Length of the second hull", 0.5, 1.6, unit="m", base_value=SECOND_LENGTH, active_when=second
    )
    r.switch("fin", "Fin")
    r.parameter("fin_height", "Fin height", 0.4, 1.8, unit="m", base_value=FIN, active_when=[when("fin", 1)])
    r.switch("nozzles", "Nozzles at the stern")
    hull, rim = _hull(r)
    _wings(r, rim)
    _nacelles(r, rim)
    _second_hull(r, hull)
    _stern(r, hull, rim)
    r.symmetry(mirrors=("y",))
    return r


def build() -> ProceduralModel:
    """Return the procedural model."""
    return model().build()


def _hull(r: AnnotatingRecorder) -> tuple[Component, dict[int, list[Element]]]:
    """A disc with a dome above and one below; its rim by angle, the lower and the upper vertex of each column."""
    hull = r.prism(SIDES, control_diameter(1.0, SIDES), 1.0, offset=(0.0, 0.0, -0.5))
    lower, upper = r.vertices_of(hull.bottom), r.vertices_of(hull.top)
    rim: dict[int, list[Element]] = {}
    for vertex in (*lower, *upper):
        x, y, _ = r.positions(vertex)[0]
        rim.setdefault(round(math.degrees(math.atan2(y, x))) % 360, []).append(vertex)
    r.judge("height of the rim", important=True)
    r.scale(put(hull.whole), RIM, "z", size="rim_height")
    for face, height, label, name in (
        (hull.top, DOME, "upper", "dome_height"),
        (hull.bottom, KEEL, "lower", "keel_height"),
    ):
        for rise, share in ((0.35, 0.65), (0.45, 0.6), (0.2, 0.5)):
            r.judge(f"height of the {label} dome", important=True)
            r.extrude(face, rise * height, length=name)
            r.judge(f"roundness of the {label} dome", important=False)
            r.scale(face, share, "uv")
    r.judge("hull length", important=True)
    r.scale(put(hull.whole), LENGTH, "u", size="hull_length")
    r.judge("hull width", important=True)
    r.scale(put(hull.whole), WIDTH, "v", size="hull_width")
    bow = [v for angle in (0, 30, 60, 300, 330) for v in rim[angle]]
    stern = [v for angle in (120, 150, 180, 210, 240) for v in rim[angle]]
    r.judge("bow width", important=True)
    r.scale(put(*bow), BOW, "v", size="bow_width")
    r.judge("stern width", important=True)
    r.scale(put(*stern), STERN, "v", size="stern_width")
    return hull, rim


def _wings(r: AnnotatingRecorder, rim: dict[int, list[Element]]) -> None:
    """Swept wings out of the sides of the hull."""
    wings = []
    for side in (-1, 1):
        root = put(*rim[90 if side > 0 else 270])
        wing = r.box(1.0, 2.0, 0.22, offset=(-0.4, -0.8 * side, -0.11), anchor=root)
        tip = wing.sides[1 + side]
        r.mark_sharp(*wing.faces)
        r.judge("wing length", important=True, direction="wing sweep by turning")
        grow(r, tip, (-0.17 * WING, side * WING, 0.0), length="wing_span")
        r.mark_sharp(*r.new_sides(tip))
        r.judge("wing taper", important=False)
        r.scale(put(tip), 0.5, "u")
        r.judge("rise of the wing tips", important=True)
        push(r, tip, (0.0, 0.0, WING_RISE), length="wing_rise")
        r.judge("wing chord", important=True)
        r.scale(put(wing.whole, pivot=root.elements), WING_CHORD, "u", size="wing_chord")
        wings.append(wing)
    r.part("wings", wings, [when("wings", 1)])


def _nacelles(r: AnnotatingRecorder, rim: dict[int, list[Element]]) -> None:
    """Tubes on pylons from the rear of the rim, upwards and outwards; the lower ones are mirror images."""
    upper: list[Component] = []
    lower: list[Component] = []
    for side in (-1, 1):
        root = rim[120 if side > 0 else 240]
        anchors = [put(*root), Target(tuple(root), "world", (Mirror("z"),))]
        pylons = r.base("box", (1.2, 0.25, 0.5), offset=(0.2, -0.25 * side, -0.1), anchors=anchors)
        tops = [Target((pylons[0].top,), "world"), Target((pylons[1].top,), "world", (Mirror("z"),))]
        r.mark_sharp(*(face for pylon in pylons for face in pylon.faces))
        r.judge("pylon length", important=True, direction="pylon direction")
        r.extrude(tops, PYLON, 0.7 * PYLON, 125.0 * side, length="pylon_length")
        r.mark_sharp(*(new for pylon in pylons for new in r.new_sides(pylon.top)))
        ends = [put(pylons[0].top), Target((pylons[1].top,), "world", (Mirror("z"),))]
        diameter = control_diameter(1.0, 8)
        tubes = r.base("prism", (diameter, diameter, 1.0), sides=8, offset=(0.0, 0.0, -0.5), anchors=ends)
        wholes = [put(tubes[0].whole), Target((tubes[1].whole,), "world", (Mirror("z"),))]
        r.judge("laying the nacelle down", important=False)
        r.rotate(wholes, 90.0, "v")
        fronts, rears = zip(
            *(sorted(tube.faces[:2], key=lambda face: -float(r.centre(face)[0])) for tube in tubes), strict=True
        )
        for faces, label, length, share in ((fronts, "head", 0.1, 0.5), (rears, "end", 0.15, 0.6)):
            r.judge(f"length of the nacelle's {label}", important=False)
            r.extrude(faces, length)
            r.judge(f"width of the nacelle's {label}", important=False)
            r.scale(faces, share, "uv")
        r.mark_sharp(*rears)
        r.judge("nacelle length", important=True)
        r.scale(wholes, NACELLE_LENGTH, "u", size="nacelle_length")
        r.judge("nacelle diameter", important=True)
        r.scale(wholes, NACELLE, "vz", size="nacelle_width")
        upper += [pylons[0], tubes[0]]
        lower += [pylons[1], tubes[1]]
    r.part("upper nacelles", upper, [when("nacelles", 1, 2)])
    r.part("lower nacelles", lower, [when("nacelles", 2)])


def _second_hull(r: AnnotatingRecorder, hull: Component) -> None:
    """A tube below the disc, on a neck that leans backwards."""
    neck = r.box(1.6, 0.35, 0.5, offset=(-0.6, 0.0, 0.0), anchor=put(hull.bottom))
    r.mark_sharp(*neck.faces)
    r.judge("neck length", important=True, direction="neck direction", direction_important=False)
    grow(r, neck.bottom, (-0.8 * NECK, 0.0, -NECK), length="neck_length")
    r.mark_sharp(*r.new_sides(neck.bottom))
    tube = r.prism(8, control_diameter(SECOND, 8), 1.0, offset=(0.0, 0.0, -0.6), anchor=put(neck.bottom))
    r.judge("laying the second hull down", important=False)
    r.rotate(put(tube.whole), -90.0, "v")
    for length, share in ((0.2, 0.8), (0.1, 0.5)):
        r.judge("length of the second hull's tail", important=False)
        r.extrude(tube.top, length)
        r.judge("slimness of the second hull's tail", important=False)
        r.scale(tube.top, share, "uv")
    r.mark_sharp(tube.bottom)
    r.judge("length of the second hull", important=True)
    r.scale(put(tube.whole), SECOND_LENGTH, "u", size="second_length")
    r.part("second hull", [neck, tube], [when("second_hull", 1)])


def _stern(r: AnnotatingRecorder, hull: Component, rim: dict[int, list[Element]]) -> None:
    """A fin upon the stern and two nozzles out of it."""
    root = max(rim[180], key=lambda vertex: float(r.positions(vertex)[0, 2]))
    fin = r.box(1.8, 0.18, 0.9, offset=(1.6, 0.0, -0.6), anchor=put(root))
    r.mark_sharp(*fin.faces)
    r.judge("fin height", important=True, direction="fin sweep by turning")
    grow(r, fin.top, (-0.6 * FIN, 0.0, FIN), length="fin_height")
    r.mark_sharp(*r.new_sides(fin.top))
    r.judge("fin taper", important=False)
    r.scale(put(fin.top), 0.55, "u")
    nozzles = []
    for side in (-1, 1):
        nozzle = r.prism(8, 0.7, 1.6, offset=(0.3, 0.0, -1.0), anchor=put(*rim[150 if side > 0 else 210]))
        r.judge("laying the nozzle down", important=False)
        r.rotate(put(nozzle.whole), -90.0, "v")
        r.mark_sharp(nozzle.top)
        r.judge("width of the nozzle", important=False)
        r.scale(nozzle.top, 1.35, "uv")
        nozzles.append(nozzle)
    r.part("fin", [fin], [when("fin", 1)])
    r.part("nozzles", nozzles, [when("nozzles", 1)])


if __name__ == "__main__":
    publish_annotated(model(), Path(__file__).parent)
