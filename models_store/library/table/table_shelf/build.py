"""Models a table with something between its legs: rails, a shelf or bars, slats at the ends.

Legs stay straight, so that rails meet them at any height. Everything hangs beneath the top, whose underside is z = 0.
"""

from pathlib import Path

from models_store.library.aids.beam import beam
from models_store.library.aids.boards import ACROSS, QUADRANTS, board, placed, pull, shift, spread, stretch
from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from shapewright.modeling import Component, ProceduralModel, Recorder, Target, when
from shapewright.modeling.elements import Axis

LENGTH, WIDTH, THICKNESS = 1.10, 0.55, 0.03
LEG_LENGTH, LEG_THICKNESS, LEG_INSET = 0.50, 0.045, 0.03
ROUND_SIDES = 8
RAIL_HEIGHT, RAIL_THICKNESS, RAIL_DEPTH = 0.04, 0.02, 0.011  # depth: of its middle behind the legs' outer faces
RAIL_DROP = 0.03  # from the top to the upper rails' middle
SHELF_HEIGHT, SHELF_THICKNESS = 0.14, 0.02
BARS, BAR_THICKNESS = 4, 0.014
SLAT_WIDTH, SLAT_THICKNESS = 0.02, 0.012
END_SLATS, SIDE_SLATS = 5, 9
HALF_X, HALF_Y = LENGTH / 2, WIDTH / 2
EDGE_X, EDGE_Y = HALF_X - LEG_INSET, HALF_Y - LEG_INSET  # of the legs, outside
RAIL_X, RAIL_Y = EDGE_X - RAIL_DEPTH, EDGE_Y - RAIL_DEPTH
SHELF_Z = SHELF_HEIGHT - LEG_LENGTH


def build() -> ProceduralModel:
    """Model the table."""
    r = Recorder(
        "table_shelf", "table", unit_m=1.0, description="A table with rails, a shelf, bars or slats between four legs."
    )
    _declare(r)
    top = board(r, (-HALF_X, -HALF_Y, 0.0), (HALF_X, HALF_Y, THICKNESS))[0]
    r.scale(Target((top.whole,), "world"), 1.0, "z", pivot=top.bottom, size="top_thickness")
    kinds = _legs(r)
    between = _between(r)
    _stretch(r, top, [leg for kind in kinds for leg in kind.components], between)

    r.part("square legs", kinds[0].components, [when("legs", 1)])
    r.part("round legs", kinds[1].components, [when("legs", 2)])
    lower = {"end rails": (2, 4), "side rails": (1, 3), "shelf": (1, 1), "bars": (2, 2), "middle rail": (4, 4)}
    for name, range_ in lower.items():
        r.part(name, between[name], [when("lower", *range_)])
    r.part("upper rails", between["upper rails"], [when("upper_rails", 1)])
    r.part("slats at the ends", between["end slats"], [when("slats", 2, 3)])
    r.part("slats at the sides", between["side slats"], [when("slats", 3), when("lower", 1, 3)])
    r.symmetry(mirrors=("x", "y"), axis="z", order=2)
    return r.build()


def _declare(r: Recorder) -> None:
    r.parameter("top_length", "Top length", 0.45, 1.7, unit="m", base_value=LENGTH)
    r.parameter("top_width", "Top width", 0.55, 2.0, unit="m", base_value=WIDTH)
    r.parameter("top_thickness", "Top thickness", 0.3, 2.5, unit="m", base_value=THICKNESS)
    r.choice("legs", "Legs", ("square", "round"))
    r.parameter("leg_length", "Leg length", 0.5, 1.7, unit="m", base_value=LEG_LENGTH)
    r.parameter("leg_thickness", "Leg thickness", 0.3, 2.0, unit="m", base_value=LEG_THICKNESS)
    r.parameter("leg_inset", "Leg inset from the ends", 0.0, 5.0, unit="m", base_value=LEG_INSET)
    r.limit("leg_inset", maximum=("top_length", 0.0, 6.0))
    r.parameter("leg_inset_sides", "Leg inset from the long sides", 0.0, 3.0, unit="m", base_value=LEG_INSET)
    r.limit("leg_inset_sides", maximum=("top_width", 0.0, 3.0))
    r.choice("lower", "Between the feet", ("shelf", "bars", "rails all round", "rails in an H"))
    r.parameter("shelf_height", "Height of shelf or lower rails", 0.4, 2.8, unit="m", base_value=SHELF_HEIGHT)
    r.limit("shelf_height", maximum=("leg_length", 0.0, 2.4))
    r.parameter("rail_height", "Rail height", 0.3, 2.0, unit="m", base_value=RAIL_HEIGHT)
    r.switch("upper_rails", "Upper rails")
    drop = (when("upper_rails", 1),)
    r.parameter("rail_drop", "Upper rails below the top", 0.3, 2.2, unit="m", base_value=RAIL_DROP, active_when=drop)
    r.limit("rail_drop", minimum=("rail_height", 0.0, RAIL_HEIGHT / 2 / RAIL_DROP))
    r.parameter("rail_thickness", "Rail thickness", 0.4, 1.3, unit="m", base_value=RAIL_THICKNESS)
    r.choice("slats", "Upright slats", ("none", "at the ends", "at ends and sides"))
    some = (when("slats", 2, 3),)
    r.parameter("slat_width", "Slat width", 0.5, 2.0, unit="m", base_value=SLAT_WIDTH, active_when=some)


def _legs(r: Recorder) -> list[Loft]:
    """Square and round legs, their outer corners at the legs' edges; thickness grows inwards."""
    place = (EDGE_X - LEG_THICKNESS / 2, EDGE_Y - LEG_THICKNESS / 2, 0.0)
    kinds = []
    for sides in (4, ROUND_SIDES):
        wide = LEG_THICKNESS if sides == 4 else control_diameter(LEG_THICKNESS, sides)
        sections = [Section(0.0, wide, wide), Section(LEG_LENGTH, wide, wide)]
        kinds.append(beam(r, "-z", sections, sides=sides, offset=place, anchors=placed(QUADRANTS)))
    corners = [max(ring, key=lambda v: float(abs(r.positions(v)[0, :2]).sum())) for ring in kinds[0].rings[0]]
    legs = [
        Target((component.whole,), "world", image, (corner,))
        for kind in kinds
        for component, image, corner in zip(kind.components, QUADRANTS, corners, strict=True)
    ]
    r.scale(legs, 1.0, "uv", size="leg_thickness")
    return kinds


def _between(r: Recorder) -> dict[str, list[Component]]:
    """What stands between the legs, at its base size but for heights and thicknesses of its own."""
    made = {
        "upper rails": _rails(r, -RAIL_DROP, "x") + _rails(r, -RAIL_DROP, "y"),
        "end rails": _rails(r, SHELF_Z, "y"),
        "side rails": _rails(r, SHELF_Z, "x"),
        "middle rail": _lying(r, 0.0, RAIL_THICKNESS, RAIL_HEIGHT),
        "shelf": _lying(r, 0.0, 2 * RAIL_Y, SHELF_THICKNESS),
        "bars": [bar for y in _row(BARS, RAIL_Y) for bar in _lying(r, y, BAR_THICKNESS, BAR_THICKNESS)],
        "end slats": [slat for y in _row(END_SLATS, RAIL_Y) for slat in _upright(r, "x", RAIL_X, y)],
        "side slats": [slat for x in _row(SIDE_SLATS, RAIL_X) for slat in _upright(r, "y", x, RAIL_Y)],
    }
    along_x = [*made["upper rails"][:2], *made["side rails"], *made["middle rail"]]
    along_y = [*made["upper rails"][2:], *made["end rails"]]
    for components, axis, name in (
        ([*along_x, *along_y], "z", "rail_height"),
        (along_x, "v", "rail_thickness"),
        (along_y, "u", "rail_thickness"),
        (made["end slats"], "v", "slat_width"),
        (made["side slats"], "u", "slat_width"),
    ):
        r.scale([Target((component.whole,), "world") for component in components], 1.0, axis, size=name)
    pull(r, made["upper rails"], "z", -RAIL_DROP, "rail_drop", beyond=0.0)
    return made


def _rails(r: Recorder, z: float, axis: Axis) -> list[Component]:
    """Two rails along an axis, one on each side."""
    low, high = z - RAIL_HEIGHT / 2, z + RAIL_HEIGHT / 2
    half = RAIL_THICKNESS / 2
    if axis == "x":
        return board(r, (-RAIL_X, RAIL_Y - half, low), (RAIL_X, RAIL_Y + half, high), ACROSS["y"])
    return board(r, (RAIL_X - half, -RAIL_Y, low), (RAIL_X + half, RAIL_Y, high), ACROSS["x"])


def _lying(r: Recorder, y: float, width: float, height: float) -> list[Component]:
    """A board from end to end at the height of the shelf."""
    low, high = (-RAIL_X, y - width / 2, SHELF_Z - height / 2), (RAIL_X, y + width / 2, SHELF_Z + height / 2)
    return board(r, low, high)


def _upright(r: Recorder, thin: Axis, x: float, y: float) -> list[Component]:
    """A slat from the shelf's height to the top, and its image on the other side; ``thin`` is across it."""
    half_x, half_y = (SLAT_THICKNESS, SLAT_WIDTH) if thin == "x" else (SLAT_WIDTH, SLAT_THICKNESS)
    low, high = (x - half_x / 2, y - half_y / 2, SHELF_Z), (x + half_x / 2, y + half_y / 2, 0.0)
    return board(r, low, high, ACROSS[thin])


def _row(count: int, edge: float) -> list[float]:
    """Return places in a row between -edge and edge, evenly with the same gap at both ends."""
    return [edge * (2 * (i + 1) / (count + 1) - 1) for i in range(count)]


def _stretch(r: Recorder, top: Component, legs: list[Component], between: dict[str, list[Component]]) -> None:
    names = ("end rails", "side rails", "middle rail", "shelf", "bars")
    lower = [component for name in names for component in between[name]]
    slats = [*between["end slats"], *between["side slats"]]
    pull(r, [*legs, *lower, *slats], "z", -LEG_LENGTH, "leg_length", beyond=SHELF_Z / 2)
    low_ends = tuple(vertex for slat in slats for vertex in r.vertices_of(slat.bottom))
    raised = Target((*(component.whole for component in lower), *low_ends), "world")
    shift(r, [raised], (0.0, 0.0, SHELF_HEIGHT), "shelf_height")

    wide = [*legs, *between["upper rails"], *between["end rails"], *between["side rails"], *between["shelf"]]
    crossing = [*wide, *between["middle rail"], *between["bars"], *between["end slats"]]
    for name, half, also in (("leg_inset", -LEG_INSET, []), ("top_length", HALF_X, [top])):
        stretch(r, [*crossing, *also], "x", half, name)
        spread(r, between["side slats"], "x", half, RAIL_X, name)
    for name, half, also in (("leg_inset_sides", -LEG_INSET, []), ("top_width", HALF_Y, [top])):
        stretch(r, [*wide, *between["side slats"], *also], "y", half, name)
        spread(r, [*between["bars"], *between["end slats"]], "y", half, RAIL_Y, name)


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
