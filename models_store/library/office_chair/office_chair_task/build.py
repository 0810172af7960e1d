"""Models a task chair: a seat and a smaller back on an upright of its own, on a star of feet; low or tall like a stool.

The upright is hinged behind the seat and carries the back, so both tilt together.
"""

from pathlib import Path

from models_store.library.aids.boards import ACROSS, board, pull, shift, stretch
from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.loft import Loft, Section, move
from models_store.library.author import publish
from models_store.library.office_chair.office_chair_parts import (
    PLATE_THICKNESS,
    PLATE_Z,
    armrests,
    cushion,
    declare_arms,
    declare_base,
    raise_seat,
    swivel_base,
)
from shapewright.modeling import Component, Element, ProceduralModel, Recorder, Target, when

SEAT_WIDTH, SEAT_DEPTH, SEAT_THICKNESS = 0.46, 0.44, 0.07
SEAT = ((-0.50, 0.70, 0.55), (-0.40, 0.92, 0.95), (0.05, 1.0, 1.0), (0.40, 0.92, 0.9), (0.52, 0.70, 0.5))
"""Sections of the seat: place along x, width and thickness, as shares."""
DISC_SIDES = 12
BACK_WIDTH, BACK_HEIGHT, BACK_THICKNESS = 0.40, 0.34, 0.055
BACK = ((0.0, 0.74, 0.5), (0.12, 0.95, 0.95), (0.5, 1.0, 1.0), (0.86, 0.92, 0.9), (1.0, 0.68, 0.5))
"""Sections of the back: place along z, width and thickness, as shares."""
BACK_X, BACK_LIFT = -0.22, 0.14  # lift: of the back's lower edge above the plate
BACK_TILT, BACK_CURVE = 6.0, 0.02
BAR_WIDTH, BAR_THICKNESS = 0.05, 0.02
BAR_X = BACK_X - BACK_THICKNESS / 2 - BAR_THICKNESS / 2 + 0.011  # of the upright, which runs into the back
BAR_SHARE = 0.55  # how far up the back it reaches
ROD_Y, ROD = 0.06, 0.016
ROD_X = BAR_X + 0.012


def build() -> ProceduralModel:
    """Model the chair."""
    r = Recorder(
        "office_chair_task",
        "office_chair",
        unit_m=1.0,
        description="A task chair or swivel stool with a separate back.",
    )
    declare_base(r, column=(0.5, 2.4))
    _declare(r)
    declare_arms(r)
    base = swivel_base(r)
    plate_top = base.column[1].top
    seat, disc = _seats(r, plate_top)
    back, arms_of_back, uprights = _back(r)
    arms = armrests(r, SEAT_WIDTH / 2)
    behind = [back.component, *uprights]
    stretch(r, [seat.component, *arms], "y", SEAT_WIDTH / 2, "seat_width", beyond=0.05)
    r.scale(Target((disc.whole,), "world"), 1.0, "v", size="seat_width")
    r.scale(Target((disc.whole,), "world"), 1.0, "u", size="seat_depth")
    stretch(r, [seat.component], "x", SEAT_DEPTH / 2, "seat_depth", beyond=0.05)
    pull(r, [*behind, *arms_of_back], "x", -SEAT_DEPTH / 2, "seat_depth", beyond=-0.1)
    raise_seat(r, base, [seat.component, disc, *behind, *arms_of_back, *arms])
    r.part("cushion", [seat.component], [when("seat", 1)])
    r.part("round seat", [disc], [when("seat", 2)])
    r.part("bar", [arms_of_back[0], uprights[0]], [when("upright", 1)])
    r.part("two rods", [*arms_of_back[1:], *uprights[1:]], [when("upright", 2)])
    r.symmetry(mirrors=("y",))
    return r.build()


def _declare(r: Recorder) -> None:
    r.choice("seat", "Seat", ("cushion", "round"))
    r.parameter("seat_width", "Seat width", 0.75, 1.25, unit="m", base_value=SEAT_WIDTH)
    r.parameter("seat_depth", "Seat depth", 0.8, 1.25, unit="m", base_value=SEAT_DEPTH)
    r.parameter("seat_thickness", "Seat thickness", 0.5, 2.2, unit="m", base_value=SEAT_THICKNESS)
    r.parameter("seat_corners", "Seat ends (width, relative to the seat's)", 0.75, 1.3, base_value=0.7,
                active_when=[when("seat", 1)])  # fmt: skip
    r.choice("upright", "Upright of the back", ("bar", "two rods"))
    r.parameter("upright_width", "Width of bar or rods", 0.5, 2.0, unit="m", base_value=BAR_WIDTH)
    r.parameter("back_lift", "Gap between seat and back", 0.3, 1.7, unit="m", base_value=BACK_LIFT)
    r.parameter("back_height", "Back height", 0.6, 1.7, unit="m", base_value=BACK_HEIGHT)
    r.parameter("back_width", "Back width", 0.7, 1.25, unit="m", base_value=BACK_WIDTH)
    r.parameter("back_thickness", "Back thickness", 0.4, 2.0, unit="m", base_value=BACK_THICKNESS)
    r.parameter("back_top", "Upper back (width, relative to the back's)", 0.6, 1.12, base_value=0.92)
    r.parameter("back_bottom", "Lower back (width, relative to the back's)", 0.6, 1.12, base_value=0.95)
    r.parameter("back_tilt", "Back tilt", -0.5, 3.0, unit="deg", base_value=BACK_TILT)
    r.parameter("back_curve", "Back curve (edges forward)", -0.2, 2.2, unit="m", base_value=BACK_CURVE)


def _seats(r: Recorder, plate_top: Element) -> tuple[Loft, Component]:
    """A cushion and a round seat, on the plate."""
    middle = PLATE_Z + PLATE_THICKNESS + SEAT_THICKNESS / 2 - 0.012
    sections = [Section(x * SEAT_DEPTH, SEAT_WIDTH * wide, SEAT_THICKNESS * thick) for x, wide, thick in SEAT]
    seat = cushion(r, "x", sections, offset=(0.0, 0.0, middle))
    r.scale(seat.sections(0, 4), 1.0, "v", size="seat_corners")
    wide = control_diameter(SEAT_DEPTH, DISC_SIDES)
    disc = r.prism(DISC_SIDES, wide, SEAT_THICKNESS, offset=(0.0, 0.0, middle - SEAT_THICKNESS / 2))
    for face in (disc.bottom, disc.top):
        r.extrude(face, 0.0)
        r.scale(face, 0.85, "uv")
    both = [Target((made.whole,), "world", pivot=(plate_top,)) for made in (seat.component, disc)]
    r.scale(both, 1.0, "z", size="seat_thickness")
    return seat, disc


def _back(r: Recorder) -> tuple[Loft, list[Component], list[Component]]:
    """The back; what leads to it below the seat, and upwards: a bar, then two rods."""
    low, lift = PLATE_Z, BACK_LIFT + PLATE_Z
    half, thick, rod = BAR_WIDTH / 2, BAR_THICKNESS / 2, ROD / 2
    high = lift + BAR_SHARE * BACK_HEIGHT
    under = board(r, (BAR_X - thick, -half, low), (0.0, half, low + BAR_THICKNESS))
    rods_under = board(r, (ROD_X - rod, ROD_Y - rod, low), (0.0, ROD_Y + rod, low + ROD), ACROSS["y"])
    bar = board(r, (BAR_X - thick, -half, low), (BAR_X + thick, half, high))
    rods = board(r, (ROD_X - rod, ROD_Y - rod, low), (ROD_X + rod, ROD_Y + rod, high), ACROSS["y"])
    r.scale([Target((made.whole,), "world") for made in (*under, *bar)], 1.0, "v", size="upright_width")
    r.scale([Target((made.whole,), "world") for made in (*rods_under, *rods)], 1.0, "v", size="upright_width")

    sections = [Section(z * BACK_HEIGHT, BACK_THICKNESS * size, BACK_WIDTH * wide) for z, wide, size in BACK]
    back = cushion(r, "z", sections, offset=(BACK_X, 0.0, lift))
    behind = min(back.rings[2][0], key=lambda vertex: float(r.positions(vertex)[0, 0]))
    for number in range(len(BACK)):
        section = Target(back.rings[number][0], "world", pivot=(behind,))
        r.scale(section, 1.0, "u", size="back_thickness")
    r.scale(back.body(), 1.0, "v", size="back_width")
    r.scale(back.sections(3, 4), 1.0, "v", size="back_top")
    r.scale(back.sections(0, 1), 1.0, "v", size="back_bottom")
    r.scale(back.body(hinge=0), 1.0, "z", size="back_height")
    for (ring,) in back.rings:
        sides = tuple(v for v in ring if abs(r.positions(v)[0, 1]) > 0.1)
        move(r, [Target(sides, "world")], (BACK_CURVE, 0.0, 0.0), length="back_curve")
    uprights = [*bar, *rods]
    shift(r, [Target((back.component.whole,), "world")], (0.0, 0.0, BACK_LIFT), "back_lift")
    pull(r, uprights, "z", BACK_LIFT, "back_lift", beyond=lift)
    pull(r, uprights, "z", BAR_SHARE * BACK_HEIGHT, "back_height", beyond=lift)
    tilted = Target((back.component.whole, *(made.whole for made in uprights)), "world", pivot=(bar[0].bottom,))
    r.rotate(tilted, -BACK_TILT, "v", angle="back_tilt")
    return back, [*under, *rods_under], uprights


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
