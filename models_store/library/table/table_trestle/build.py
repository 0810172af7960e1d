"""Models a table on two end supports: panels, pairs of posts, T-shaped columns, crossed or spread legs.

The supports are alternatives, all of the same depth and height; the underside of the top is z = 0.
"""

from pathlib import Path

from models_store.library.aids.boards import ACROSS, QUADRANTS, board, pull, shift, spread, stretch, strut
from models_store.library.author import publish
from shapewright.modeling import Component, ProceduralModel, Recorder, Target, group, when

LENGTH, WIDTH, THICKNESS = 1.60, 0.80, 0.04
HEIGHT = 0.68
INSET, DEPTH, SUPPORT_THICKNESS = 0.22, 0.60, 0.05  # of a support: from the end of the top, along y, along x
POST, RAIL, SPREAD = 0.09, 0.07, 0.12  # width of a post along y, height of a rail, spread legs' upper end from y = 0
FOOT_HEIGHT = 0.06
STRETCHER_HEIGHT, STRETCHER, STRETCHER_THICKNESS, STRETCHER_GAP = 0.20, 0.07, 0.035, 0.10
CROSSING, CROSSBAR = 0.5, 0.3  # heights at which crossed and spread legs are joined, as shares
SLATS, SLAT_COVER, END_SLATS, END_SLAT = 7, 0.88, 5, 0.02
BATTEN = 0.03
HALF_X, HALF_Y, HALF_DEPTH = LENGTH / 2, WIDTH / 2, DEPTH / 2
PLACE, HALF_THICK = HALF_X - INSET, SUPPORT_THICKNESS / 2  # of the supports along x
SUPPORTS = ("panel", "two posts with rails", "column on a foot", "crossed legs", "spread legs")


def build() -> ProceduralModel:
    """Model the table."""
    r = Recorder(
        "table_trestle", "table", unit_m=1.0, description="A table on two end supports, with or without a stretcher."
    )
    _declare(r)
    plain = board(r, (-HALF_X, -HALF_Y, 0.0), (HALF_X, HALF_Y, THICKNESS))[0]
    slats = [_slat(r, number) for number in range(SLATS)]
    r.scale(group(plain.whole, *(slat.whole for slat in slats), frame="world"), 1.0, "z",
            pivot=plain.bottom, size="top_thickness")  # fmt: skip
    battens = _end(r, HALF_Y * 0.95, -BATTEN, 0.0)
    heads = _end(r, HALF_DEPTH * 0.92, -BATTEN, 0.0)
    supports, joints = _supports(r)
    end_slats = [slat for number in range(END_SLATS) for slat in _end_slat(r, number)]
    stretchers = _stretchers(r)

    standing = [*heads, *battens, *end_slats, *(made for part in supports.values() for made in part)]
    r.scale([Target((made.whole,), "world") for made in standing], 1.0, "u", size="support_thickness")
    joined = [*standing, *(made for part in stretchers.values() for made in part)]
    _pull_down(r, supports, joints, end_slats, stretchers)
    apart = [*joints["columns"], *supports["spread legs"]]
    deep = [*heads, *(made for part in supports.values() for made in part if made not in apart)]
    stretch(r, deep, "y", HALF_DEPTH, "support_depth")
    stretch(r, joints["spread legs"], "y", HALF_DEPTH, "support_depth", beyond=SPREAD + POST / 2 + 0.01)
    stretch(r, joints["crossbars"], "y", (1 - CROSSBAR) * HALF_DEPTH, "support_depth")
    spread(r, end_slats, "y", HALF_DEPTH, HALF_DEPTH, "support_depth")
    stretch(r, joined, "x", -INSET, "support_inset")
    stretch(r, [plain, *slats, *joined], "x", HALF_X, "top_length")
    stretch(r, [plain, *battens], "y", HALF_Y, "top_width")
    r.scale(group(*(slat.whole for slat in slats), frame="world"), 1.0, "v", size="top_width")

    r.part("plain top", [plain], [when("top", 1)])
    r.part("slatted top", [*slats, *battens], [when("top", 2)])
    for number, name in enumerate(SUPPORTS, start=1):
        r.part(name, supports[name], [when("supports", number)])
    r.part("end slats", end_slats, [when("supports", 2), when("end_slats", 1)])
    r.part("stretcher", stretchers["single"], [when("supports", 1, 3), when("stretcher", 1)])
    r.part("two stretchers", stretchers["double"], [when("supports", 1, 2), when("stretcher", 2)])
    r.part("stretcher at the crossing", stretchers["crossing"], [when("supports", 4), when("stretcher", 1)])
    r.part("stretcher at the crossbars", stretchers["crossbars"], [when("supports", 5), when("stretcher", 1)])
    r.symmetry(mirrors=("x", "y"), axis="z", order=2)
    return r.build()


def _declare(r: Recorder) -> None:
    r.choice("top", "Top", ("plain", "slats"))
    r.parameter("top_length", "Top length", 0.5, 1.5, unit="m", base_value=LENGTH)
    r.parameter("top_width", "Top width", 0.5, 1.6, unit="m", base_value=WIDTH)
    r.parameter("top_thickness", "Top thickness", 0.3, 2.2, unit="m", base_value=THICKNESS)
    r.parameter("height", "Height of the supports", 0.45, 1.5, unit="m", base_value=HEIGHT)
    r.choice("supports", "Supports at both ends", SUPPORTS)
    r.parameter("support_inset", "Supports from the ends of the top", 0.12, 1.8, unit="m", base_value=INSET)
    r.limit("support_inset", maximum=("top_length", 0.0, 2.0))
    r.parameter("support_depth", "Support depth (across the top)", 0.5, 2.0, unit="m", base_value=DEPTH)
    r.limit("support_depth", maximum=("top_width", 0.0, 1.33))
    r.parameter(
        "support_thickness", "Support thickness (along the top)", 0.4, 3.0, unit="m", base_value=SUPPORT_THICKNESS
    )
    r.parameter("post_width", "Width of posts, columns and legs", 0.4, 2.0, unit="m", base_value=POST,
                active_when=[when("supports", 2, 5)])  # fmt: skip
    r.limit("post_width", maximum=("support_depth", 0.0, 2.2))
    r.switch("end_slats", "Slats at both ends", active_when=[when("supports", 2)])
    r.choice("stretcher", "Stretcher between the supports", ("one", "two", "none"))
    beam_there = [when("supports", 1, 3)]
    r.parameter("stretcher_height", "Height of stretcher and rails", 0.5, 2.2, unit="m", base_value=STRETCHER_HEIGHT,
                active_when=beam_there)  # fmt: skip
    r.limit("stretcher_height", maximum=("height", 0.0, 2.4))
    r.parameter(
        "stretcher_width", "Height of the stretcher's and rails' section", 0.4, 1.7, unit="m", base_value=STRETCHER
    )


def _slat(r: Recorder, number: int) -> Component:
    """One of the boards of a slatted top."""
    pitch = WIDTH / (SLATS - 1 + SLAT_COVER)
    middle, half = (number - (SLATS - 1) / 2) * pitch, pitch * SLAT_COVER / 2
    return board(r, (-HALF_X, middle - half, 0.0), (HALF_X, middle + half, THICKNESS))[0]


def _end(r: Recorder, half_depth: float, low: float, high: float, y: float = 0.0) -> list[Component]:
    """An upright board at each end, across the top."""
    return board(r, (PLACE - HALF_THICK, y - half_depth, low), (PLACE + HALF_THICK, y + half_depth, high), ACROSS["x"])


def _supports(r: Recorder) -> tuple[dict[str, list[Component]], dict[str, list[Component]]]:
    """The alternatives by name, and of all of them what moves in a way of its own."""
    post_y, top_y = HALF_DEPTH - POST / 2, SPREAD
    size = (SUPPORT_THICKNESS, POST)
    posts = strut(r, (PLACE, post_y, -HEIGHT), (PLACE, post_y, 0.0), size, QUADRANTS)
    rail_z = STRETCHER_HEIGHT - HEIGHT
    low_rails = _end(r, post_y, rail_z - RAIL / 2, rail_z + RAIL / 2)
    high_rails = _end(r, post_y, -RAIL, 0.0)
    columns = _end(r, POST / 2, -HEIGHT, 0.0)
    feet = _end(r, HALF_DEPTH, -HEIGHT, FOOT_HEIGHT - HEIGHT)
    crossed = strut(r, (PLACE, -post_y, -HEIGHT), (PLACE, post_y, 0.0), size, QUADRANTS)
    spread_legs = strut(r, (PLACE, post_y, -HEIGHT), (PLACE, top_y, 0.0), size, QUADRANTS)
    bar_y, bar_z = post_y + (top_y - post_y) * CROSSBAR, HEIGHT * (CROSSBAR - 1)
    crossbars = _end(r, bar_y, bar_z - RAIL / 2, bar_z + RAIL / 2)
    supports = {
        "panel": _end(r, HALF_DEPTH, -HEIGHT, 0.0),
        "two posts with rails": [*posts, *low_rails, *high_rails],
        "column on a foot": [*columns, *feet],
        "crossed legs": crossed,
        "spread legs": [*spread_legs, *crossbars],
    }
    ends = [Target((face,), "world") for leg in (*posts, *crossed, *spread_legs) for face in (leg.bottom, leg.top)]
    r.scale([*ends, *(Target((column.whole,), "world") for column in columns)], 1.0, "v", size="post_width")
    rails = [*low_rails, *crossbars]
    r.scale([Target((rail.whole,), "world") for rail in rails], 1.0, "z", size="stretcher_width")
    return supports, {"low rails": low_rails, "columns": columns, "spread legs": spread_legs, "crossbars": crossbars}


def _end_slat(r: Recorder, number: int) -> list[Component]:
    y = (HALF_DEPTH - POST) * (2 * (number + 1) / (END_SLATS + 1) - 1)
    return _end(r, END_SLAT / 2, STRETCHER_HEIGHT - HEIGHT, -RAIL / 2, y)


def _stretchers(r: Recorder) -> dict[str, list[Component]]:
    """Beams along x between the supports."""

    def beam(height: float, y: float = 0.0) -> Component:
        half_y, half_z = STRETCHER_THICKNESS / 2, STRETCHER / 2
        z = height - HEIGHT
        return board(r, (-PLACE, y - half_y, z - half_z), (PLACE, y + half_y, z + half_z))[0]

    made = {
        "single": [beam(STRETCHER_HEIGHT)],
        "double": [beam(STRETCHER_HEIGHT, y) for y in (STRETCHER_GAP, -STRETCHER_GAP)],
        "crossing": [beam(CROSSING * HEIGHT)],
        "crossbars": [beam(CROSSBAR * HEIGHT)],
    }
    beams = [Target((component.whole,), "world") for part in made.values() for component in part]
    r.scale(beams, 1.0, "z", size="stretcher_width")
    return made


def _pull_down(
    r: Recorder,
    supports: dict[str, list[Component]],
    joints: dict[str, list[Component]],
    end_slats: list[Component],
    stretchers: dict[str, list[Component]],
) -> None:
    """Let the height pull the floor down; what has a height above it rises again."""
    raised = [*joints["low rails"], *stretchers["single"], *stretchers["double"]]
    falling = [made for part in supports.values() for made in part if made not in joints["crossbars"]]
    falling += [*end_slats, *stretchers["single"], *stretchers["double"]]
    pull(r, falling, "z", -HEIGHT, "height", beyond=-HEIGHT / 2)
    shared = [(CROSSING, stretchers["crossing"]), (CROSSBAR, [*stretchers["crossbars"], *joints["crossbars"]])]
    for share, components in shared:
        whole = Target(tuple(made.whole for made in components), "world")
        shift(r, [whole], (0.0, 0.0, -HEIGHT * (1 - share)), "height")
    low_ends = [vertex for slat in end_slats for vertex in r.vertices_of(slat.bottom)]
    lifted = Target((*(made.whole for made in raised), *low_ends), "world")
    shift(r, [lifted], (0.0, 0.0, STRETCHER_HEIGHT), "stretcher_height")


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
