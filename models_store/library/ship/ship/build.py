"""Models a ship, bow towards +x: a hull with a raised foredeck, deckhouses, funnels, masts with or without sails.

The hull is a box that is extruded towards bow and stern and then brought into shape; what stands on the deck hangs on
its vertices.
"""

from pathlib import Path

from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.sketching import push, put
from models_store.library.annotations import AnnotatingRecorder, publish_annotated
from shapewright.modeling import Component, Element, Mirror, ProceduralModel, Target, when

MIDDLE, FORE, BOW, AFT = 20.0, 16.0, 12.0, 16.0
BEAM, DEPTH, BOTTOM = 12.0, 8.0, 0.7
RAKE, SHEER, STERN_WIDTH = 4.0, 2.0, 0.75
HOUSE_LENGTH, HOUSE_WIDTH, TIER = 14.0, 0.75, 3.0
FUNNEL, FUNNEL_WIDTH = 6.0, 3.0
MAST, MAST_WIDTH, SAIL, SAIL_WIDTH = 26.0, 0.8, 18.0, 13.0
KEEL = 3.0


def model() -> AnnotatingRecorder:
    """Model the ship."""
    r = AnnotatingRecorder(
        "ship", "ship", unit_m=1.0, description="A ship: freighter, liner, warship, sailing ship, yacht."
    )
    r.parameter("middle_length", "Length amidships", 0.15, 2.5, unit="m", base_value=MIDDLE)
    r.parameter("end_length", "Length of the fore and the after body", 0.4, 1.7, unit="m", base_value=FORE)
    r.parameter("bow_length", "Bow length", 0.4, 1.7, unit="m", base_value=BOW)
    r.parameter("beam", "Beam", 0.55, 2.0, unit="m", base_value=BEAM)
    r.parameter("depth", "Hull depth", 0.5, 1.6, unit="m", base_value=DEPTH)
    r.parameter("bottom_width", "Width of the bottom (of the beam)", 0.25, 1.35, base_value=BOTTOM)
    r.parameter("bow_rake", "Bow rake", -0.5, 2.2, unit="m", base_value=RAKE)
    r.parameter("sheer", "Rise of the deck towards bow and stern", -0.2, 2.5, unit="m", base_value=SHEER)
    r.parameter("stern_width", "Stern width (of the beam)", 0.4, 1.3, base_value=STERN_WIDTH)
    r.switch("keel", "Keel fin")
    r.parameter("keel_depth", "Keel depth", 0.3, 3.0, unit="m", base_value=KEEL, active_when=[when("keel", 1)])
    r.choice("superstructure", "Superstructure", ("at the stern", "amidships and aft", "amidships", "none"))
    housed = [when("superstructure", 1, 3)]
    r.parameter("house_length", "Deckhouse length", 0.35, 1.5, unit="m", base_value=HOUSE_LENGTH, active_when=housed)
    r.limit("house_length", maximum=("end_length", 0.1, 1.0))
    r.parameter("house_width", "Deckhouse width (of the beam)", 0.5, 1.25, base_value=HOUSE_WIDTH, active_when=housed)
    r.parameter("tier_height", "Tier height", 0.5, 2.2, unit="m", base_value=TIER, active_when=housed)
    r.choice("funnels", "Funnels", ("one", "three", "two", "none"), active_when=housed)
    smoking = [*housed, when("funnels", 1, 3)]
    r.parameter("funnel_height", "Funnel height", 0.4, 2.0, unit="m", base_value=FUNNEL, active_when=smoking)
    r.parameter("funnel_width", "Funnel diameter", 0.5, 1.6, unit="m", base_value=FUNNEL_WIDTH, active_when=smoking)
    r.choice("masts", "Masts", ("one", "three", "two", "none"))
    rigged = [when("masts", 1, 3)]
    r.parameter("mast_height", "Mast height", 0.3, 1.8, unit="m", base_value=MAST, active_when=rigged)
    r.choice("sails", "Sails", ("none", "square", "triangular"), active_when=rigged)
    r.parameter(
        "sail_width",
        "Sail width",
        0.5,
        1.5,
        unit="m",
        base_value=SAIL_WIDTH,
        active_when=[*rigged, when("sails", 2, 3)],
    )
    deck = _hull(r)
    _superstructure(r, deck)
    _masts(r, deck)
    r.symmetry(mirrors=("y",))
    return r


def build() -> ProceduralModel:
    """Return the procedural model."""
    return model().build()


def _hull(r: AnnotatingRecorder) -> list[list[Element]]:
    """A hull of width and depth 1 first; returns the deck's vertices at shoulder, both ends of the middle, quarter."""
    hull = r.box(1.0, 1.0, 1.0, offset=(0.0, 0.0, -1.0))
    fore, aft = hull.sides[1], hull.sides[3]
    r.judge("length amidships", important=True)
    r.scale(put(hull.whole), MIDDLE, "u", size="middle_length")
    midship = [r.vertices_of(face) for face in (fore, aft)]
    r.judge("length of the fore and the after body", important=True)
    r.extrude(fore, FORE, length="end_length")
    shoulder = r.vertices_of(fore)
    r.judge("length of the bow", important=True)
    r.extrude(fore, BOW, length="bow_length")
    r.judge("length of the fore and the after body", important=True)
    r.extrude(aft, AFT, length="end_length")
    quarter = r.vertices_of(aft)
    r.judge("length of the stern", important=False)
    r.extrude(aft, 3.0)
    sections = [r.vertices_of(fore), shoulder, *midship, quarter, r.vertices_of(aft)]
    for ring, label, width in (
        (sections[0], "sharpness of the bow", 0.04),
        (sections[1], "fullness of the fore body", 0.85),
        (sections[5], "width of the stern", STERN_WIDTH),
    ):
        r.judge(label, important=label == "width of the stern")
        if ring is sections[5]:
            r.scale(put(*ring), width, "v", size="stern_width")
        else:
            r.scale(put(*ring), width, "v")
    r.judge("width of the bottom", important=True)
    for ring in sections:
        r.scale(put(*_half(r, ring, -1)), BOTTOM, "v", size="bottom_width")
    r.judge("beam", important=True)
    r.scale(put(hull.whole), BEAM, "v", size="beam")
    r.judge("depth", important=True)
    r.scale(put(hull.whole, pivot=tuple(_half(r, sections[2], -1))), DEPTH, "z", size="depth")
    r.judge("bow rake", important=True)
    push(r, _half(r, sections[0], 1), (RAKE, 0.0, 0.0), length="bow_rake")
    r.judge("rise of the stern's bottom", important=False)
    push(r, _half(r, sections[5], -1), (0.0, 0.0, 0.45 * DEPTH), length="depth")
    r.judge("rise of the deck towards bow and stern", important=False)
    for ring, share in ((sections[0], 1.0), (sections[1], 0.3), (sections[5], 0.6)):
        push(r, _half(r, ring, 1), (0.0, 0.0, share * SHEER), length="sheer")
    bottoms = {v.id for ring in sections for v in _half(r, ring, -1)}
    rim = {e for v in r.vertices_of(hull.whole) if v.id not in bottoms for e in r.mesh.edges_of_vertex(v.id)}
    r.mark_sharp(aft, *(Element("edge", e) for e in sorted(rim) if not bottoms & set(r.mesh.edge(e))))
    r.mark_sharp(*(Element("edge", r.mesh.edge_between(v.id, w.id)) for v, w in _stem(r, fore)))
    _keel(r, [v for ring in midship for v in _half(r, ring, -1)])
    return [_half(r, ring, 1) for ring in sections[1:5]]


def _half(r: AnnotatingRecorder, ring: list[Element], side: int) -> list[Element]:
    """Return the two upper (1) or lower (-1) vertices of a section."""
    in_order = sorted(ring, key=lambda vertex: float(r.positions(vertex)[0, 2]) * side)
    return in_order[2:]


def _stem(r: AnnotatingRecorder, fore: Element) -> list[tuple[Element, Element]]:
    """Return the two upright edges at the bow, each by its ends."""
    ring = sorted(r.vertices_of(fore), key=lambda vertex: float(r.positions(vertex)[0, 1]))
    return [(ring[0], ring[1]), (ring[2], ring[3])]


def _keel(r: AnnotatingRecorder, bottom: list[Element]) -> None:
    """A fin below the middle of the hull that starts well inside."""
    keel = r.box(1.0, 0.5, 0.2, offset=(0.0, 0.0, -0.1), anchor=put(*bottom))
    r.mark_sharp(*keel.faces)
    r.judge("length of the keel fin", important=False)
    r.scale(put(keel.whole), 0.7 * MIDDLE, "u", size="middle_length")
    r.judge("root of the keel fin", important=False)
    push(r, keel.top, (0.0, 0.0, 0.4 * DEPTH), length="depth")
    r.judge("depth of the keel fin", important=True)
    push(r, keel.bottom, (0.0, 0.0, -KEEL), length="keel_depth")
    r.part("keel", [keel], [when("keel", 1)])


def _superstructure(r: AnnotatingRecorder, deck: list[list[Element]]) -> None:
    """Deckhouses of two tiers amidships and at the stern, and funnels on them, all in the same strokes."""
    anchors = [put(*deck[1], *deck[2]), put(*deck[3])]
    houses = [r.box(1.0, 1.0, 0.8, offset=(x, 0.0, -0.8), anchor=at) for x, at in zip((0.0, 0.5), anchors, strict=True)]
    tops = [house.top for house in houses]
    r.mark_sharp(*(face for house in houses for face in house.faces))
    for tier in (1, 2):
        r.judge("tier height", important=True)
        r.extrude(tops, TIER, length="tier_height")
        r.mark_sharp(*(side for top in tops for side in r.new_sides(top)))
        if tier == 1:
            r.judge("step between the tiers", important=False)
            r.extrude(tops, 0.1)
            r.judge("length of the upper tier", important=False)
            r.scale(tops, 0.75, "uv")
            r.mark_sharp(*(side for top in tops for side in r.new_sides(top)))
    hinged = [put(house.whole, pivot=at.elements) for house, at in zip(houses, anchors, strict=True)]
    r.judge("deckhouse length", important=True)
    r.scale(hinged, HOUSE_LENGTH, "u", size="house_length")
    r.judge("deckhouse width", important=True)
    r.scale(hinged, HOUSE_WIDTH, "v", size="house_width")
    r.judge("deckhouse width following the beam", important=False)
    r.scale(hinged, BEAM, "v", size="beam")
    middle, pairs = _funnels(r, tops)
    r.part("deckhouse amidships", houses[:1], [when("superstructure", 2, 3)])
    r.part("deckhouse at the stern", houses[1:], [when("superstructure", 1, 2)])
    r.part("funnel amidships", middle[:1], [when("superstructure", 2, 3), when("funnels", 1, 2)])
    r.part("funnel at the stern", middle[1:], [when("superstructure", 1), when("funnels", 1, 2)])
    r.part("pair of funnels amidships", pairs[0], [when("superstructure", 2, 3), when("funnels", 2, 3)])
    r.part("pair of funnels at the stern", pairs[1], [when("superstructure", 1), when("funnels", 2, 3)])


def _funnels(r: AnnotatingRecorder, roofs: list[Element]) -> tuple[list[Component], list[list[Component]]]:
    """One funnel in the middle of each roof, and one before and one behind it."""
    diameter = control_diameter(1.0, 8)
    size = (diameter, diameter, 0.6)
    made = [r.base("prism", size, sides=8, offset=(0.0, 0.0, -0.6), anchors=[put(roof)] * 3) for roof in roofs]
    everyone = [funnel for trio in made for funnel in trio]
    tops = [funnel.top for funnel in everyone]
    r.judge("funnel height", important=True)
    r.extrude(tops, FUNNEL, length="funnel_height")
    r.mark_sharp(*tops)
    r.judge("funnel diameter", important=True)
    r.scale([put(funnel.whole) for funnel in everyone], FUNNEL_WIDTH, "uv", size="funnel_width")
    r.judge("funnel taper", important=False)
    r.scale(tops, 0.85, "uv")
    r.judge("funnel rake", important=False)
    r.drag([put(top) for top in tops], 0.0, 0.8, 180.0)
    r.judge("distance between the funnels", important=False)
    pairs = [put(trio[1].whole) for trio in made]
    pairs += [Target((trio[2].whole,), "world", (Mirror("x"),)) for trio in made]
    r.drag(pairs, 0.0, 0.26 * HOUSE_LENGTH, 0.0, length="house_length")
    return [trio[0] for trio in made], [trio[1:] for trio in made]


def _masts(r: AnnotatingRecorder, deck: list[list[Element]]) -> None:
    """A main mast, a fore and a mizzen mast, each with a square sail across and a triangular one behind it."""
    places = [put(*deck[1], *deck[2]), put(*deck[0]), put(*deck[3])]
    size = (MAST_WIDTH, MAST_WIDTH, 1.0)
    masts = [r.base("prism", size, sides=6, offset=(0.0, 0.0, -1.0), anchors=place)[0] for place in places]
    r.judge("mast height", important=True)
    r.extrude([mast.top for mast in masts], MAST, length="mast_height")
    r.judge("mast taper", important=False)
    r.scale([mast.top for mast in masts], 0.5, "uv")
    r.mark_sharp(*(face for mast in masts for face in (mast.bottom, mast.top)))
    square = [r.box(0.25, 1.0, 0.25, offset=(0.0, 0.0, 0.3), anchor=place) for place in places]
    lateen = [r.box(1.0, 0.25, 0.75, offset=(-0.5, 0.0, 0.2), anchor=place) for place in places]
    r.mark_sharp(*(face for sail in (*square, *lateen) for face in sail.faces))
    bellies = [r.vertices_of(sail.top) for sail in square]
    r.judge("height of the sail's upper half", important=False)
    r.extrude([sail.top for sail in square], 0.3)
    for sail in square:
        sides = r.new_sides(sail.top)
        r.mark_sharp(*(e for side in sides for e in r.edges_of(side)))
    r.judge("belly of the sails", important=False)
    r.drag([put(*belly) for belly in bellies], 0.0, 1.6, 0.0)
    r.judge("width of the sails at the top", important=False)
    r.scale([put(sail.top) for sail in square], 0.75, "v")
    peaks = [r.vertices_of(max(r.edges_of(sail.sides[3]), key=lambda e: float(r.centre(e)[2]))) for sail in lateen]
    r.judge("peak of the triangular sails", important=False)
    r.drag([put(*peak) for peak in peaks], 0.0, 0.94, 0.0)
    r.judge("sail height following the mast", important=False)
    sails = [*square, *lateen]
    r.scale(
        [put(sail.whole, pivot=place.elements) for sail, place in zip(sails, places * 2, strict=True)],
        MAST,
        "z",
        size="mast_height",
    )
    r.judge("sail width", important=True)
    r.scale([put(sail.whole) for sail in square], SAIL_WIDTH, "v", size="sail_width")
    r.scale(
        [put(s.whole, pivot=p.elements) for s, p in zip(lateen, places, strict=True)],
        SAIL_WIDTH,
        "u",
        size="sail_width",
    )
    r.part("main mast", masts[:1], [when("masts", 1, 2)])
    r.part("fore and mizzen mast", masts[1:], [when("masts", 2, 3)])
    for number, kind, found in ((2, "square", square), (3, "triangular", lateen)):
        r.part(f"main {kind} sail", found[:1], [when("masts", 1, 2), when("sails", number)])
        r.part(f"fore and mizzen {kind} sails", found[1:], [when("masts", 2, 3), when("sails", number)])


if __name__ == "__main__":
    publish_annotated(model(), Path(__file__).parent)
