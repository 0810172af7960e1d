"""Models a table on a frame of thin rods: four posts, crossed rods between them, bars on the floor.

Each rod ends where others do and is pulled along with them. The underside of the top is z = 0.
"""

from pathlib import Path

from models_store.library.aids.boards import ACROSS, QUADRANTS, board, pull, shift, stretch, strut
from models_store.library.aids.lathe import control_diameter
from models_store.library.author import publish
from shapewright.modeling import Component, ProceduralModel, Recorder, Target, group, when

SIDES = 12
DIAMETER, THICKNESS = 1.0, 0.045
PLATE_THICKNESS, PLATE_MARGIN = 0.035, 0.02
FRAME_WIDTH, HEIGHT, ROD = 0.42, 0.45, 0.018
HALF = FRAME_WIDTH / 2
GAP = 0.05  # from the ends of the posts to the ends of the crossed rods


def build() -> ProceduralModel:
    """Model the table."""
    r = Recorder(
        "table_wire", "table", unit_m=1.0, description="A table on a square frame of thin posts and crossed rods."
    )
    _declare(r)
    tops = _tops(r)
    low, thick = -HEIGHT, ROD / 2
    plate = board(r, (-HALF - PLATE_MARGIN, -HALF - PLATE_MARGIN, -PLATE_THICKNESS),
                  (HALF + PLATE_MARGIN, HALF + PLATE_MARGIN, 0.0))[0]  # fmt: skip
    posts = strut(r, (HALF, HALF, low), (HALF, HALF, 0.0), (ROD, ROD), QUADRANTS)
    start, end = low + GAP, -GAP
    crossed = strut(r, (-HALF, HALF, start), (HALF, HALF, end), (ROD, ROD), QUADRANTS)
    crossed += strut(r, (HALF, -HALF, start), (HALF, HALF, end), (ROD, ROD), QUADRANTS)
    along = board(r, (-HALF, HALF - thick, low), (HALF, HALF + thick, low + ROD), ACROSS["y"])
    across = board(r, (HALF - thick, -HALF, low), (HALF + thick, HALF, low + ROD), ACROSS["x"])

    ends = [Target((face,), "world") for rod in (*posts, *crossed) for face in (rod.bottom, rod.top)]
    r.scale(ends, 1.0, "uv", size="rod_thickness")
    r.scale([Target((bar.whole,), "world") for bar in along], 1.0, "vz", size="rod_thickness")
    r.scale([Target((bar.whole,), "world") for bar in across], 1.0, "uz", size="rod_thickness")
    r.scale(Target((plate.bottom,), "world"), 0.94, "uv")
    r.scale(Target((plate.whole,), "world"), 1.0, "z", pivot=plate.top, size="plate_thickness")
    rods = [*posts, *crossed, *along, *across]
    starts = [v for rod in crossed for v in r.vertices_of(rod.bottom)]
    finishes = [v for rod in crossed for v in r.vertices_of(rod.top)]
    shift(r, [Target(tuple(starts), "world")], (0.0, 0.0, GAP), "gap")
    shift(r, [Target(tuple(finishes), "world")], (0.0, 0.0, -GAP), "gap")
    feet = tuple(v for rod in rods for v in r.vertices_of(rod.whole) if r.positions(v)[0, 2] < low / 2)
    r.scale(group(*feet, frame="world"), 1.0, "uv", size="foot_width")
    pull(r, rods, "z", -HEIGHT, "height", beyond=low / 2)
    stretch(r, [*rods, plate], "x", HALF, "frame_length")
    stretch(r, [*rods, plate], "y", HALF, "frame_width")

    r.part("round top", [tops[0]], [when("top", 1)])
    r.part("square top", [tops[1]], [when("top", 2)])
    r.part("bars at two sides", along, [when("bars", 1, 2)])
    r.part("bars at the other sides", across, [when("bars", 1)])
    r.symmetry(mirrors=("x", "y"), axis="z", order=2)
    return r.build()


def _declare(r: Recorder) -> None:
    r.choice("top", "Top", ("round", "square"))
    r.parameter("top_length", "Top length", 0.8, 1.5, unit="m", base_value=DIAMETER)
    r.parameter("top_width", "Top width (relative to its length)", 0.6, 1.0, base_value=1.0)
    r.parameter("top_thickness", "Top thickness", 0.25, 1.8, unit="m", base_value=THICKNESS)
    r.parameter("height", "Height of the frame", 0.5, 2.0, unit="m", base_value=HEIGHT)
    r.parameter("frame_length", "Frame length", 0.55, 1.4, unit="m", base_value=FRAME_WIDTH)
    r.limit("frame_length", maximum=("top_length", 0.0, 1.4))
    r.parameter("frame_width", "Frame width", 0.55, 1.2, unit="m", base_value=FRAME_WIDTH)
    r.limit("frame_width", maximum=("top_length", 0.0, 1.2))
    r.limit("frame_width", maximum=("top_width", 0.0, 1.25))
    r.parameter("foot_width", "Width at the floor (relative to the upper end)", 0.7, 1.3, base_value=1.0)
    r.parameter("plate_thickness", "Plate beneath the top", 0.4, 1.4, unit="m", base_value=PLATE_THICKNESS)
    r.parameter("rod_thickness", "Rod thickness", 0.5, 2.0, unit="m", base_value=ROD)
    r.parameter("gap", "Crossed rods' ends from the posts' ends", 0.4, 1.6, unit="m", base_value=GAP)
    r.choice("bars", "Bars on the floor", ("four", "two", "none"))


def _tops(r: Recorder) -> tuple[Component, Component]:
    """A round and a square top."""
    half = DIAMETER / 2
    disc = r.prism(SIDES, control_diameter(DIAMETER, SIDES), THICKNESS)
    square = board(r, (-half, -half, 0.0), (half, half, THICKNESS))[0]
    r.mark_sharp(disc.bottom, disc.top)
    for top in (disc, square):
        r.scale(Target((top.whole,), "world"), 1.0, "z", pivot=top.bottom, size="top_thickness")
    both = group(disc.whole, square.whole, frame="world")
    r.scale(both, 1.0, "uv", size="top_length")
    r.scale(both, 1.0, "v", size="top_width")
    for face in (disc.bottom, disc.top, square.bottom, square.top):
        r.extrude(face, 0.0)
        r.scale(face, 0.5, "uv")
    return disc, square


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
