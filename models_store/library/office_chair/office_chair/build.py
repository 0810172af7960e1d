"""Models an office chair: seat and high back that meet, on a star of feet; armrests and a headrest as wanted.

Seat and back are cushions through cross-sections. The back is hinged where it meets the seat.
"""

from pathlib import Path

from models_store.library.aids.boards import stretch
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
from shapewright.modeling import Element, ProceduralModel, Recorder, Target, when

SEAT_WIDTH, SEAT_DEPTH, SEAT_THICKNESS = 0.48, 0.50, 0.09
SEAT = ((-0.50, 0.80, 0.55), (-0.40, 0.95, 0.95), (0.05, 1.0, 1.0), (0.40, 0.95, 0.9), (0.52, 0.80, 0.5))
"""Sections of the seat: place along x, width and thickness, as shares."""
BACK_WIDTH, BACK_HEIGHT, BACK_THICKNESS = 0.46, 0.62, 0.08
BACK = ((0.0, 0.82, 0.6), (0.08, 0.95, 0.95), (0.35, 1.0, 1.0), (0.65, 1.0, 0.95), (0.92, 0.92, 0.8), (1.0, 0.74, 0.45))
"""Sections of the back: place along z, width and thickness, as shares."""
BACK_X, BACK_Z = -0.21, 0.47
FRONT_DROP, BACK_TILT, BACK_CURVE, LUMBAR = 0.015, 8.0, 0.02, 0.015
HEAD = ((0.0, 0.22, 0.05), (0.03, 0.28, 0.08), (0.12, 0.28, 0.08), (0.15, 0.22, 0.04))
"""Sections of the headrest: place along z, width and thickness."""
HEAD_OVERLAP = 0.03


def build() -> ProceduralModel:
    """Model the chair."""
    r = Recorder(
        "office_chair", "office_chair", unit_m=1.0, description="An office chair with a high back that meets the seat."
    )
    declare_base(r, column=(0.45, 1.3))
    _declare(r)
    declare_arms(r)
    base = swivel_base(r)
    seat = _seat(r, base.column[1].top)
    back, head = _back(r)
    arms = armrests(r, SEAT_WIDTH / 2)
    behind = [back.component, head.component]
    stretch(r, [seat.component, *arms], "y", SEAT_WIDTH / 2, "seat_width", beyond=0.05)
    stretch(r, [seat.component, *behind], "x", SEAT_DEPTH / 2, "seat_depth", beyond=0.05)
    raise_seat(r, base, [seat.component, *behind, *arms])
    r.part("headrest", [head.component], [when("headrest", 1)])
    r.symmetry(mirrors=("y",))
    return r.build()


def _declare(r: Recorder) -> None:
    r.parameter("seat_width", "Seat width", 0.8, 1.3, unit="m", base_value=SEAT_WIDTH)
    r.parameter("seat_depth", "Seat depth", 0.8, 1.25, unit="m", base_value=SEAT_DEPTH)
    r.parameter("seat_thickness", "Seat thickness", 0.5, 1.9, unit="m", base_value=SEAT_THICKNESS)
    r.parameter("seat_front", "Seat front (width, relative to the seat's)", 0.75, 1.08, base_value=0.95)
    r.parameter("corners", "Fullness of the ends of seat and back (1.25 is square)", 0.8, 1.25)
    r.parameter("back_height", "Back height", 0.6, 1.4, unit="m", base_value=BACK_HEIGHT)
    r.parameter("back_width", "Back width", 0.75, 1.25, unit="m", base_value=BACK_WIDTH)
    r.parameter("back_thickness", "Back thickness", 0.4, 2.0, unit="m", base_value=BACK_THICKNESS)
    r.parameter("back_top", "Upper back (width, relative to the back's)", 0.7, 1.12, base_value=0.92)
    r.parameter("back_bottom", "Lower back (width, relative to the back's)", 0.7, 1.12, base_value=0.95)
    r.parameter("back_tilt", "Back tilt (deg)", -0.5, 3.0, unit="deg", base_value=BACK_TILT)
    r.parameter("back_curve", "Back curve (edges forward)", -1.0, 3.0, unit="m", base_value=BACK_CURVE)
    r.parameter("lumbar", "Lumbar bulge", -1.0, 3.0, unit="m", base_value=LUMBAR)
    r.switch("headrest", "Headrest")


def _seat(r: Recorder, plate_top: Element) -> Loft:
    sections = [Section(x * SEAT_DEPTH, SEAT_WIDTH * wide, SEAT_THICKNESS * thick) for x, wide, thick in SEAT]
    seat = cushion(r, "x", sections, offset=(0.0, 0.0, PLATE_Z + PLATE_THICKNESS + SEAT_THICKNESS / 2 - 0.015))
    r.scale(Target((seat.component.whole,), "world", pivot=(plate_top,)), 1.0, "z", size="seat_thickness")
    r.scale(seat.sections(3, 4), 1.0, "v", size="seat_front")
    r.scale(seat.sections(0, 4), 1.0, "vz", size="corners")
    move(r, seat.sections(3), (0.0, 0.0, -FRONT_DROP / 2))
    move(r, seat.sections(4), (0.0, 0.0, -FRONT_DROP))
    return seat


def _back(r: Recorder) -> tuple[Loft, Loft]:
    """The back, and a headrest on its upper end that tilts with it."""
    sections = [Section(z * BACK_HEIGHT, BACK_THICKNESS * thick, BACK_WIDTH * wide) for z, wide, thick in BACK]
    back = cushion(r, "z", sections, offset=(BACK_X, 0.0, BACK_Z))
    every = [target for number in range(len(BACK)) for target in back.sections(number)]
    r.scale(every, 1.0, "u", size="back_thickness")
    r.scale(back.sections(0, 5), 1.0, "uv", size="corners")
    r.scale(back.body(), 1.0, "v", size="back_width")
    r.scale(back.sections(4, 5), 1.0, "v", size="back_top")
    r.scale(back.sections(0, 1), 1.0, "v", size="back_bottom")
    r.scale(back.body(hinge=0), 1.0, "z", size="back_height")
    for (ring,) in back.rings[1:]:
        sides = tuple(v for v in ring if abs(r.positions(v)[0, 1]) > 0.1)
        move(r, [Target(sides, "world")], (BACK_CURVE, 0.0, 0.0), length="back_curve")
    for number, share in ((1, 0.7), (2, 1.0)):
        move(r, back.sections(number), (LUMBAR * share, 0.0, 0.0), length="lumbar")
    upper_end = Target(back.rings[-1][0], "world")
    padding = [Section(z - HEAD_OVERLAP, thick, wide) for z, wide, thick in HEAD]
    head = cushion(r, "z", padding, anchor=upper_end)
    tilted = Target((back.component.whole, head.component.whole), "world", pivot=back.rings[0][0])
    r.rotate(tilted, -BACK_TILT, "v", angle="back_tilt")
    return back, head


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
