"""Models a tower: three stages, each set back behind the one below, a gallery and a roof, on a podium.

The round, the square and the octagonal tower are modelled in the same strokes; so are their roofs.
"""

import math
from pathlib import Path

from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.sketching import put
from models_store.library.annotations import AnnotatingRecorder, publish_annotated
from shapewright.modeling import Component, Element, ProceduralModel, Target, Turn, when

ROUND_SIDES = 16
WIDTH = 6.0
STAGES = (9.0, 5.0, 3.0)
TAPER, SETBACK = 0.94, 0.88
CORBEL, OVERHANG, GALLERY = 0.7, 1.25, 1.6
ROOF, MAST, MAST_WIDTH = 5.0, 4.0, 0.35
PODIUM, PODIUM_HEIGHT = 7.5, 0.8
MERLON = (0.18, 0.18, 1.0)  # shares of the tower's width, metres
LEDGE = 0.15


def model() -> AnnotatingRecorder:
    """Model the tower."""
    r = AnnotatingRecorder(
        "tower", "tower", unit_m=1.0, description="A tower of three stages with a gallery and a roof."
    )
    r.choice("plan", "Plan", ("round", "square", "octagonal"))
    r.choice("roof", "Roof", ("pointed", "dome", "battlements", "flat"))
    r.parameter("width", "Width at the foot", 0.4, 2.0, unit="m", base_value=WIDTH)
    r.parameter("lower_height", "Height of the lower stage", 0.3, 2.0, unit="m", base_value=STAGES[0])
    r.parameter("middle_height", "Height of the middle stage", 0.2, 2.5, unit="m", base_value=STAGES[1])
    r.parameter("upper_height", "Height of the upper stage", 0.2, 2.5, unit="m", base_value=STAGES[2])
    r.parameter("taper", "Width lost along a stage (top of bottom)", 0.82, 1.05, base_value=TAPER)
    r.parameter("setback", "Width of a stage (of the one below)", 0.65, 1.1, base_value=SETBACK)
    r.parameter("overhang", "Width of the gallery (of the stage below)", 0.75, 1.4, base_value=OVERHANG)
    r.parameter("gallery_height", "Gallery height", 0.2, 2.2, unit="m", base_value=GALLERY)
    r.parameter("roof_height", "Roof height", 0.25, 2.6, unit="m", base_value=ROOF, active_when=[when("roof", 1, 2)])
    r.switch("mast", "Mast")
    r.parameter("mast_length", "Mast length", 0.25, 2.5, unit="m", base_value=MAST, active_when=[when("mast", 1)])
    r.parameter("podium_width", "Podium width", 0.5, 1.8, unit="m", base_value=PODIUM)
    r.limit("podium_width", minimum=("width", 0.0, 0.82))
    r.parameter("podium_height", "Podium height", 0.4, 3.5, unit="m", base_value=PODIUM_HEIGHT)
    podium = _podium(r)
    shafts = _plans(r, podium.top, STAGES[0], "height of the lower stage", "lower_height")
    _shaft(r, shafts)
    gallery = _gallery(r, shafts)
    _top(r, shafts, gallery)
    r.symmetry(mirrors=("x", "y"), axis="z", order=4)
    return r


def build() -> ProceduralModel:
    """Return the procedural model."""
    return model().build()


def _podium(r: AnnotatingRecorder) -> Component:
    podium = r.box(1.0, 1.0, 1.0)
    r.mark_sharp(*podium.faces)
    r.judge("podium width", important=True)
    r.scale(put(podium.whole), PODIUM, "uv", size="podium_width")
    r.judge("podium height", important=False)
    r.scale(put(podium.whole, pivot=(podium.bottom,)), PODIUM_HEIGHT, "z", size="podium_height")
    return podium


def _plans(
    r: AnnotatingRecorder, below: Element | list[Element], height: float, label: str, name: str
) -> list[Component]:
    """A round, a square and an octagonal column of width 1 on the same place, or each on its own."""
    places = below if isinstance(below, list) else [below] * 3
    made = []
    for sides, place in zip((ROUND_SIDES, 4, 8), places, strict=True):
        turn_deg = 180.0 / sides
        diameter = control_diameter(1.0, sides) if sides == ROUND_SIDES else 1.0 / math.cos(math.radians(turn_deg))
        column = r.prism(sides, diameter, 0.1, offset=(0.0, 0.0, -0.1), anchor=put(place))
        r.mark_sharp(*((column.bottom, column.top) if sides == ROUND_SIDES else column.faces))
        if sides != ROUND_SIDES:
            r.judge("turn of the plan", important=False)
            r.rotate(put(column.whole), turn_deg, "z")
        made.append(column)
    r.judge(label, important=True)
    _rise(r, made, height, name)
    return made


def _rise(r: AnnotatingRecorder, columns: list[Component], by: float, name: str = "") -> None:
    """Extrude all columns; the edges of the angular ones stay sharp, and every rim."""
    tops = [column.top for column in columns]
    if name:
        r.extrude(tops, by, length=name)
    else:
        r.extrude(tops, by)
    r.mark_sharp(tops[0], *(side for top in tops[1:] for side in r.new_sides(top)))


def _shaft(r: AnnotatingRecorder, columns: list[Component]) -> None:
    """Taper the lower stage and set two more upon it."""
    tops = [put(column.top) for column in columns]
    r.judge("taper of the stages", important=True)
    r.scale(tops, TAPER, "uv", size="taper")
    for label, height, name in (("middle", STAGES[1], "middle_height"), ("upper", STAGES[2], "upper_height")):
        r.judge("rise of a ledge", important=False)
        _rise(r, columns, LEDGE)
        r.judge("setback of the stages", important=True)
        r.scale(tops, SETBACK, "uv", size="setback")
        r.judge(f"height of the {label} stage", important=True)
        _rise(r, columns, height, name)
        r.judge("taper of the stages", important=True)
        r.scale(tops, TAPER, "uv", size="taper")


def _gallery(r: AnnotatingRecorder, columns: list[Component]) -> list[list[Element]]:
    """A wider storey; returns its vertices, which are widened once the roofs stand upon them."""
    r.judge("rise of the corbels", important=False)
    _rise(r, columns, CORBEL)
    lower = [r.vertices_of(column.top) for column in columns]
    r.judge("gallery height", important=True)
    _rise(r, columns, GALLERY, "gallery_height")
    return [rim + r.vertices_of(column.top) for rim, column in zip(lower, columns, strict=True)]


def _top(r: AnnotatingRecorder, shafts: list[Component], gallery: list[list[Element]]) -> None:
    """Roofs of the gallery's width, battlements around its edge, a mast out of the middle."""
    tops = [shaft.top for shaft in shafts]
    pointed = _plans(r, tops, ROOF - 0.1, "height of the pointed roof", "roof_height")
    r.judge("width of the roof's tip", important=False)
    r.scale([put(roof.top) for roof in pointed], 0.03, "uv")
    domes = _plans(r, tops, 0.4 * ROOF, "height of the dome", "roof_height")
    for rise, shares in ((0.3, 0.83), (0.2, 0.62), (0.1, 0.4)):
        r.judge("roundness of the dome", important=False)
        r.scale([put(dome.top) for dome in domes], shares, "uv")
        r.judge("height of the dome", important=True)
        _rise(r, domes, rise * ROOF, "roof_height")
        r.mark_sharp(*r.edges_of(domes[0].top), sharp=False)
    r.judge("roundness of the dome", important=False)
    r.scale([put(dome.top) for dome in domes], 0.15, "uv")
    merlons = [_battlements(r, top, corners) for top, corners in zip(tops, (0.31, 0.42, 0.31), strict=True)]
    above = [
        put(*rim, pointed[i].whole, domes[i].whole, *(m.whole for m in merlons[i])) for i, rim in enumerate(gallery)
    ]
    upon = [put(pointed[i].whole, domes[i].whole, *(m.whole for m in merlons[i])) for i in range(3)]
    r.judge("width of what is on top, following the stages", important=False)
    for share, name in ((TAPER, "taper"), (SETBACK, "setback")) * 2:
        r.scale(upon, share, "uv", size=name)
    r.scale(upon, TAPER, "uv", size="taper")
    r.judge("overhang of the gallery", important=True)
    r.scale(above, OVERHANG, "uv", size="overhang")
    r.judge("width", important=True)
    wholes = [put(shafts[i].whole, pointed[i].whole, domes[i].whole, *(m.whole for m in merlons[i])) for i in range(3)]
    r.scale(wholes, WIDTH, "uv", size="width")
    mast = _mast(r, shafts[0])
    for number, name in enumerate(("round", "square", "octagonal")):
        plan = when("plan", number + 1)
        r.part(f"{name} tower", [shafts[number]], [plan])
        r.part(f"{name} pointed roof", [pointed[number]], [plan, when("roof", 1)])
        r.part(f"{name} dome", [domes[number]], [plan, when("roof", 2)])
        r.part(f"{name} battlements", merlons[number], [plan, when("roof", 3)])
    r.part("mast", [mast], [when("mast", 1)])


def _battlements(r: AnnotatingRecorder, top: Element, corners: float) -> list[Component]:
    """Eight blocks around the edge: four at the sides, four between them."""
    around = [put(top), *(Target((top,), "world", (Turn("z", 90.0 * i),)) for i in (1, 2, 3))]
    made = [
        merlon
        for x, y in ((0.42, 0.0), (corners, corners))
        for merlon in r.base("box", MERLON, offset=(x, y, -0.05), anchors=around)
    ]
    r.mark_sharp(*(face for merlon in made for face in merlon.faces))
    return made


def _mast(r: AnnotatingRecorder, shaft: Component) -> Component:
    """A pole that stands on the gallery and shows above whatever roof there is."""
    mast = r.prism(8, control_diameter(MAST_WIDTH, 8), 0.1, offset=(0.0, 0.0, -0.1), anchor=put(shaft.top))
    r.judge("height of the roof at the mast", important=False)
    r.extrude(mast.top, ROOF, length="roof_height")
    r.judge("mast length", important=True)
    r.extrude(mast.top, MAST, length="mast_length")
    r.judge("mast taper", important=False)
    r.scale(mast.top, 0.4, "uv")
    r.mark_sharp(mast.bottom, mast.top)
    return mast


if __name__ == "__main__":
    publish_annotated(model(), Path(__file__).parent)
