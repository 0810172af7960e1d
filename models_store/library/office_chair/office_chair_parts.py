"""What office chairs share: a star of feet with castors beneath a column, cushions, armrests.

A chair looks along +x and stands on the floor at z = 0.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from models_store.library.aids.beam import beam
from models_store.library.aids.boards import ACROSS, TOLERANCE, board, placed, pull, shift, stretch
from models_store.library.aids.lathe import Lathe, Ring, control_diameter, widen
from models_store.library.aids.loft import ORIGIN, Loft, Section, Vector, loft, move
from shapewright.modeling import Component, Recorder, Target, Turn, when

FEET = (5, 4)
FOOT_LENGTH, HUB_Z, TIP_Z, FOOT_WIDTH = 0.30, 0.095, 0.065, 0.055
FOOT = ((0.0, 1.0), (0.35, 0.95), (0.7, 0.8), (1.0, 0.65))
"""Of each section of a foot the distance from the axis and the size, as shares."""
FOOT_HEIGHT, FOOT_ARCH, HUB_RISE = 0.045, 0.02, 0.03
CASTOR, CASTOR_WIDTH, CASTOR_SIDES = 0.055, 0.045, 8
COLUMN_SIDES = 8
HUB_LOW, HUB_HIGH, SLEEVE_HIGH = 0.055, 0.13, 0.30
HUB, SLEEVE, PISTON = 0.085, 0.06, 0.038  # diameters
PLATE_Z, PLATE_THICKNESS, PLATE_WIDTH = 0.42, 0.03, 0.22  # what carries the seat
COLUMN_LENGTH = PLATE_Z - HUB_HIGH
SQUARED = 1.36  # of an octagon's diagonal corners: pushed out to fill a rectangle
ARM_HEIGHT, ARM_LENGTH, ARM_WIDTH, ARM_THICKNESS = 0.24, 0.30, 0.05, 0.03  # height: above the plate's underside
ARM_GAP, POST, LOOP_SIDES, LOOP_SQUARED = 0.02, 0.028, 8, 1.2
CASTOR_DROP = 0.033  # of a wheel's axle below the tip of the foot
ARMS = ("pads on posts", "loops", "none")


@dataclass(frozen=True)
class SwivelBase:
    """The lower half of a chair.

    Attributes:
        column: the column and the plate on it, which are always there.
        feet: for each number of feet the star and its castors.
    """

    column: tuple[Component, Component]
    feet: tuple[tuple[Loft, Loft], ...]


def declare_base(r: Recorder, *, column: tuple[float, float]) -> None:
    """Declare the parameters of the base; ``column`` is the range of its length."""
    r.choice("foot_count", "Feet", ("five", "four"))
    r.parameter("foot_length", "Foot length", 0.75, 1.3, unit="m", base_value=FOOT_LENGTH)
    r.parameter("foot_width", "Foot width", 0.5, 1.5, unit="m", base_value=FOOT_WIDTH)
    r.parameter("foot_arch", "Foot arch", -0.5, 2.5, unit="m", base_value=FOOT_ARCH)
    r.parameter("hub_rise", "Rise of the feet towards the column", 0.0, 3.0, unit="m", base_value=HUB_RISE)
    r.switch("castors", "Castors")
    with_castors = [when("castors", 1)]
    r.parameter("castor_size", "Castor diameter", 0.6, 1.6, unit="m", base_value=CASTOR, active_when=with_castors)
    r.parameter("column_length", "Column length", *column, unit="m", base_value=COLUMN_LENGTH)
    r.parameter("column_width", "Column width", 0.5, 1.7, unit="m", base_value=SLEEVE)


def swivel_base(r: Recorder) -> SwivelBase:
    """Model the base; what stands on it is moved with it by :func:`raise_seat`."""
    column, rings = _column(r)
    half = PLATE_WIDTH / 2
    plate = board(r, (-half, -half, PLATE_Z - 0.005), (half, half, PLATE_Z + PLATE_THICKNESS))[0]
    widen(r, rings, 1.0, size="column_width")
    shift(r, [Target(rings[-3], "world"), Target(rings[-2], "world")], (0.0, 0.0, COLUMN_LENGTH / 2), "column_length")
    shift(r, [Target(rings[-1], "world")], (0.0, 0.0, COLUMN_LENGTH), "column_length")
    feet = tuple(_star(r, count) for count in FEET)
    shift(r, [Target((column.whole,), "world")], (0.0, 0.0, HUB_RISE), "hub_rise")
    return SwivelBase((column, plate), feet)


def raise_seat(r: Recorder, base: SwivelBase, seat: Sequence[Component]) -> None:
    """Let the column's length and the feet's rise lift the plate and what stands on it; declare the base's parts."""
    lifted = Target((base.column[1].whole, *(made.whole for made in seat)), "world")
    shift(r, [lifted], (0.0, 0.0, COLUMN_LENGTH), "column_length")
    shift(r, [lifted], (0.0, 0.0, HUB_RISE), "hub_rise")
    for number, (count, (star, castors)) in enumerate(zip(FEET, base.feet, strict=True), start=1):
        r.part(f"{count} feet", star.components, [when("foot_count", number)])
        r.part(f"{count} castors", castors.components, [when("foot_count", number), when("castors", 1)])


def _column(r: Recorder) -> tuple[Component, list[Ring]]:
    """Hub, sleeve and piston, each narrower than the one below."""
    column = r.prism(COLUMN_SIDES, 1.0, HUB_HIGH - HUB_LOW, offset=(0.0, 0.0, HUB_LOW))
    r.mark_sharp(column.bottom, column.top)
    lathe = Lathe(r, column)
    rings = [lathe.bottom, lathe.top]
    for rise in (0.0, SLEEVE_HIGH - HUB_HIGH, 0.0, PLATE_Z - SLEEVE_HIGH):
        rings.append(lathe.rise(rise))
        r.mark_sharp(column.top)
    for ring, width in zip(rings, (HUB, HUB, SLEEVE, SLEEVE, PISTON, PISTON), strict=True):
        widen(r, [ring], control_diameter(width, COLUMN_SIDES))
    return column, rings


def _star(r: Recorder, count: int) -> tuple[Loft, Loft]:
    """Feet around the axis, and a wheel under the tip of each."""
    images = [(Turn("z", 360.0 * number / count),) if number else () for number in range(count)]
    sections = [Section(share * FOOT_LENGTH, FOOT_WIDTH * size, FOOT_HEIGHT * size) for share, size in FOOT]
    anchors = [Target((), "world", image) for image in images]
    star = beam(r, "+x", sections, offset=(0.0, 0.0, TIP_Z), anchors=anchors)
    every = [target for number in range(len(FOOT)) for target in star.sections(number)]
    r.scale(every, 1.0, "v", size="foot_width")
    r.scale(star.body(hinge=0), 1.0, "u", size="foot_length")
    for number, (share, _) in enumerate(FOOT[:-1]):
        move(r, star.sections(number), (0.0, 0.0, HUB_RISE * (1 - share)), length="hub_rise")
        if share:
            move(r, star.sections(number), (0.0, 0.0, FOOT_ARCH * 4 * share * (1 - share)), length="foot_arch")
    tips = [Target(ring, "world", image) for ring, image in zip(star.rings[-1], images, strict=True)]
    wide = control_diameter(CASTOR, CASTOR_SIDES)
    wheel = [Section(-CASTOR_WIDTH / 2, wide, wide), Section(CASTOR_WIDTH / 2, wide, wide)]
    castors = beam(r, "+y", wheel, sides=CASTOR_SIDES, offset=(0.0, 0.0, -CASTOR_DROP), anchors=tips)
    hinged = zip(castors.components, images, star.rings[-1], strict=True)
    r.scale([Target((made.whole,), "world", image, tip) for made, image, tip in hinged], 1.0, size="castor_size")
    return star, castors


def cushion(
    r: Recorder,
    axis: Literal["x", "z"],
    sections: Sequence[Section],
    *,
    offset: Vector = ORIGIN,
    anchor: Target | None = None,
) -> Loft:
    """Model a pad of rounded sections along an axis; they fill rectangles rather than ellipses."""
    made = loft(r, axis, sections, offset=offset, anchors=(anchor,) if anchor else ())
    column = 2 if axis == "x" else 0
    corners = []
    for (ring,) in made.rings:
        places = np.array([r.positions(vertex)[0] for vertex in ring])
        away = np.abs(places - places.mean(axis=0))[:, [1, column]].min(axis=1)
        diagonal = [vertex for vertex, distance in zip(ring, away, strict=True) if distance > TOLERANCE]
        corners.append(Target(tuple(diagonal), "world"))
    r.scale(corners, SQUARED, "vz" if axis == "x" else "uv")
    return made


def declare_arms(r: Recorder) -> None:
    """Declare the parameters of the armrests."""
    r.choice("arms", "Armrests", ARMS)
    there, on_posts = [when("arms", 1, 2)], [when("arms", 1)]
    r.parameter("arm_height", "Armrest height", 0.7, 1.35, unit="m", base_value=ARM_HEIGHT, active_when=there)
    r.parameter("arm_length", "Armrest length", 0.75, 1.4, unit="m", base_value=ARM_LENGTH, active_when=there)
    r.parameter("arm_gap", "Gap between seat and armrests", 0.0, 3.0, unit="m", base_value=ARM_GAP, active_when=there)
    r.parameter("pad_width", "Armrest pad width", 0.7, 2.0, unit="m", base_value=ARM_WIDTH, active_when=on_posts)
    r.parameter("pad_thickness", "Pad thickness", 0.6, 2.5, unit="m", base_value=ARM_THICKNESS, active_when=on_posts)


def armrests(r: Recorder, half_width: float) -> list[Component]:
    """Model a bar across, pads on posts and loops, as far apart as a seat is wide; declare them as parts."""
    low, high = PLATE_Z, PLATE_Z + ARM_HEIGHT
    sides = ACROSS["y"]
    y, pad, post = half_width + ARM_GAP + POST / 2, ARM_WIDTH / 2, POST / 2
    bar = board(r, (-0.035, -y, low), (0.035, y, low + 0.02))
    posts = board(r, (-0.03, y - post, low), (0.03, y + post, high + 0.005), sides)
    long = ARM_LENGTH / 2
    pads = board(r, (-long, y - pad, high), (long, y + pad, high + ARM_THICKNESS), sides)
    size = (control_diameter(ARM_LENGTH, LOOP_SIDES), control_diameter(ARM_HEIGHT + ARM_THICKNESS, LOOP_SIDES), POST)
    loops = r.base("ring", size, sides=LOOP_SIDES, tube_sides=4, anchors=placed(sides))
    targets = [Target((made.whole,), "world", image) for made, image in zip(loops, sides, strict=True)]
    corners = []
    for made, image in zip(loops, sides, strict=True):
        diagonal = [v for v in r.vertices_of(made.whole) if min(abs(r.positions(v)[0, :2])) > 0.05]
        corners.append(Target(tuple(diagonal), "world", image))
    r.scale(corners, LOOP_SQUARED, "uv")
    r.rotate(targets, 90.0, "u")
    move(r, targets, (0.0, y, low + (ARM_HEIGHT + ARM_THICKNESS) / 2))

    thick = [Target((made.whole,), "world", image, (made.bottom,)) for made, image in zip(pads, sides, strict=True)]
    r.scale(thick, 1.0, "z", size="pad_thickness")
    r.scale(thick, 1.0, "v", size="pad_width")
    r.scale([*thick, *targets], 1.0, "u", size="arm_length")
    arms = [*bar, *posts, *pads, *loops]
    pull(r, [*posts, *pads, *loops], "z", ARM_HEIGHT, "arm_height", beyond=low + ARM_HEIGHT / 2)
    stretch(r, arms, "y", ARM_GAP, "arm_gap")
    r.part("bar of the armrests", bar, [when("arms", 1, 2)])
    r.part("pads on posts", [*posts, *pads], [when("arms", 1)])
    r.part("loops", loops, [when("arms", 2)])
    return arms
