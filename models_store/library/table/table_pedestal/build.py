"""Models a table on one column: round or square top; disc, plate, claws or a barrel beneath.

The column stands on the floor at z = 0. Claws and arms are bars that grow out of the axis, turned copies of the first.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from models_store.library.aids.beam import beam
from models_store.library.aids.boards import board, shift
from models_store.library.aids.lathe import Lathe, Ring, control_diameter, widen
from models_store.library.aids.loft import Loft, Section, move
from models_store.library.author import publish
from shapewright.modeling import Component, ProceduralModel, Recorder, Target, Turn, group, when

SIDES, COLUMN_SIDES = 12, 8
HEIGHT = 0.70  # of the top's underside
DIAMETER, THICKNESS, UNDERSIDE = 0.90, 0.035, 0.97  # the underside's width is relative to the top's
PLATE_DIAMETER, PLATE_THICKNESS = 0.14, 0.012
COLUMN = 0.08
COLUMN_HEIGHTS = (0.0, 0.10, 0.25, 0.42, 0.58, 0.75, 0.90, 1.0)
COLUMN_PLACES = {"lower": (0, 1), "middle": (3, 4), "upper": (6, 7)}
"""The first and last ring of what has a width of its own."""
FOOT_WIDTH, FOOT_THICKNESS, CONE_HEIGHT = 0.52, 0.025, 0.03
CLAW_LENGTH, CLAW_HEIGHT, CLAW_WIDTH, CLAW_THICKNESS = 0.36, 0.06, 0.05, 0.045
CLAW = ((0.0, 1.0, 1.2), (0.12, 1.0, 1.2), (0.40, 0.75, 1.1), (0.72, 0.22, 0.9), (1.0, 0.0, 0.7))
"""Of each section of a claw the distance, the height at which it lies, and the thickness, as shares."""
CLAW_ARCH = 0.03
ARM_LENGTH, ARM_DROP, ARM_WIDTH = 0.26, 0.07, 0.03
BARREL_WIDTH = 0.42
BASES = ("disc", "square plate", "three claws", "four claws", "five claws", "barrel")


def build() -> ProceduralModel:
    """Model the table."""
    r = Recorder(
        "table_pedestal", "table", unit_m=1.0, description="A table on a column with a disc, claws or a barrel beneath."
    )
    _declare(r)
    plate = r.prism(SIDES, PLATE_DIAMETER, PLATE_THICKNESS, offset=(0.0, 0.0, HEIGHT - PLATE_THICKNESS))
    r.mark_sharp(plate.bottom, plate.top)
    tops = _tops(r)
    arms = _arms(r)
    column, rings = _column(r)
    square = _square_column(r)
    barrel = _barrel(r)
    disc, slab = _flat_feet(r)
    claws = [_claws(r, count) for count in (3, 4, 5)]

    standing = group(column.whole, square.component.whole, barrel.whole, frame="world")
    r.scale(standing, 1.0, "z", pivot=disc.bottom, size="height")
    lifted = (plate.whole, *(top.whole for top in tops), *(arm.whole for arm in arms.components))
    shift(r, [Target(lifted, "world")], (0.0, 0.0, HEIGHT), "height")
    _shape_claws(r, claws)
    for share, ring in zip(COLUMN_HEIGHTS[:-1], rings, strict=False):
        shift(r, [Target(ring, "world")], (0.0, 0.0, CLAW_HEIGHT * (1 - share)), "claw_height")
    shift(r, square.sections(0), (0.0, 0.0, CLAW_HEIGHT), "claw_height")

    r.part("round top", [tops[0]], [when("top", 1)])
    r.part("square top", [tops[1]], [when("top", 2)])
    r.part("arms", arms.components, [when("arms", 1)])
    r.part("round column", [column], [when("column", 1)])
    r.part("square column", square.components, [when("column", 2)])
    feet = [[disc], [slab], *(made.components for made in claws), [barrel]]
    for number, (name, components) in enumerate(zip(BASES, feet, strict=True), start=1):
        r.part(name, components, [when("base", number)])
    r.symmetry(mirrors=("y",))
    return r.build()


def _declare(r: Recorder) -> None:
    r.parameter("height", "Height of the top", 0.5, 1.5, unit="m", base_value=HEIGHT)
    r.choice("top", "Top", ("round", "square"))
    r.parameter("top_width", "Top width", 0.6, 1.5, unit="m", base_value=DIAMETER)
    r.parameter("top_thickness", "Top thickness", 0.25, 2.5, unit="m", base_value=THICKNESS)
    r.parameter("underside_width", "Underside (relative to the top)", 0.9, 1.03, base_value=UNDERSIDE)
    r.switch("arms", "Arms beneath the top")
    r.parameter("arm_length", "Arm length", 0.6, 1.3, unit="m", base_value=ARM_LENGTH, active_when=[when("arms", 1)])
    r.limit("arm_length", maximum=("top_width", 0.0, 1.5))
    r.choice("base", "Base", BASES)
    pole, barrel = when("base", 1, 5), [when("base", 6)]
    r.choice("column", "Column", ("round", "square"), active_when=[pole])
    r.parameter("column_width", "Column width", 0.35, 2.0, unit="m", base_value=COLUMN, active_when=[pole])
    turned = [pole, when("column", 1)]
    for place in ("lower", "middle", "upper"):
        label = f"{place.capitalize()} column (relative to its width)"
        r.parameter(f"{place}_column", label, 0.6, 2.2, base_value=1.0, active_when=turned)
    flat, claws = [when("base", 1, 2)], [when("base", 3, 5)]
    r.parameter("foot_width", "Width of the foot", 0.7, 1.5, unit="m", base_value=FOOT_WIDTH, active_when=flat)
    r.limit("foot_width", minimum=("top_width", 0.0, 0.62), maximum=("top_width", 0.0, 1.6))
    r.parameter("foot_thickness", "Foot thickness", 0.5, 2.5, unit="m", base_value=FOOT_THICKNESS, active_when=flat)
    r.parameter("cone", "Cone on the disc", 0.0, 4.0, unit="m", base_value=CONE_HEIGHT, active_when=[when("base", 1)])
    r.parameter("claw_length", "Claw length", 0.6, 1.35, unit="m", base_value=CLAW_LENGTH, active_when=claws)
    r.limit("claw_length", minimum=("top_width", 0.0, 0.62), maximum=("top_width", 0.35, 1.0))
    r.parameter("claw_height", "Height of claw roots", 1.0, 5.0, unit="m", base_value=CLAW_HEIGHT, active_when=claws)
    r.limit("claw_height", maximum=("height", 0.0, 5.0))
    r.parameter("claw_width", "Claw width", 0.4, 1.6, unit="m", base_value=CLAW_WIDTH, active_when=claws)
    r.parameter("claw_thickness", "Claw thickness", 0.5, 1.5, unit="m", base_value=CLAW_THICKNESS, active_when=claws)
    r.parameter("claw_arch", "Claw arch", -0.5, 2.5, unit="m", base_value=CLAW_ARCH, active_when=claws)
    r.parameter("barrel_width", "Barrel width", 0.5, 1.3, unit="m", base_value=BARREL_WIDTH, active_when=barrel)
    r.limit("barrel_width", minimum=("top_width", 0.0, 0.6), maximum=("top_width", 0.0, 1.55))
    r.parameter("barrel_waist", "Barrel waist (relative to its width)", 0.6, 1.25, base_value=1.0, active_when=barrel)


def _tops(r: Recorder) -> tuple[Component, Component]:
    """A round and a square top, their undersides a little smaller."""
    disc = r.prism(SIDES, control_diameter(DIAMETER, SIDES), THICKNESS, offset=(0.0, 0.0, HEIGHT))
    r.mark_sharp(disc.bottom, disc.top)
    half = DIAMETER / 2
    square = board(r, (-half, -half, HEIGHT), (half, half, HEIGHT + THICKNESS))[0]
    both = (disc, square)
    r.scale([Target((top.bottom,), "world") for top in both], UNDERSIDE, "uv", size="underside_width")
    for face in (disc.bottom, disc.top):
        r.extrude(face, 0.0)
        r.scale(face, 0.5, "uv")
    r.scale(group(disc.whole, square.whole, frame="world"), 1.0, "uv", size="top_width")
    for top in both:
        r.scale(Target((top.whole,), "world"), 1.0, "z", pivot=top.bottom, size="top_thickness")
    return both


def _arms(r: Recorder) -> Loft:
    """Four arms from the column outwards and up to the top."""
    profile = ((0.0, 1.0), (0.2, 1.0), (0.6, 0.3), (1.0, 0.0))
    low = ARM_WIDTH / 2
    sections = [
        Section(share * ARM_LENGTH, ARM_WIDTH, ARM_WIDTH, (0.0, -low - drop * (ARM_DROP - low)))
        for share, drop in profile
    ]
    arms = beam(r, "+x", sections, crease="ends", offset=(0.0, 0.0, HEIGHT), anchors=_around(4))
    r.scale(arms.body(hinge=0), 1.0, "u", size="arm_length")
    return arms


def _column(r: Recorder) -> tuple[Component, list[Ring]]:
    """A column of rings whose lower, middle and upper ones get widths of their own."""
    heights = [share * HEIGHT for share in COLUMN_HEIGHTS]
    column = r.prism(COLUMN_SIDES, control_diameter(COLUMN, COLUMN_SIDES), heights[1])
    r.mark_sharp(column.bottom)
    lathe = Lathe(r, column)
    rings = [lathe.bottom, lathe.top, *(lathe.rise(high - low) for low, high in pairwise(heights[1:]))]
    r.mark_sharp(column.top)
    widen(r, rings, 1.0, size="column_width")
    for name, (first, last) in COLUMN_PLACES.items():
        widen(r, rings[first : last + 1], 1.0, size=f"{name}_column")
    return column, rings


def _square_column(r: Recorder) -> Loft:
    made = beam(r, "+z", [Section(0.0, COLUMN, COLUMN), Section(HEIGHT, COLUMN, COLUMN)])
    r.scale(made.body(), 1.0, "uv", size="column_width")
    return made


def _barrel(r: Recorder) -> Component:
    barrel = r.prism(SIDES, control_diameter(BARREL_WIDTH, SIDES), HEIGHT / 2)
    r.mark_sharp(barrel.bottom)
    lathe = Lathe(r, barrel)
    waist, upper = lathe.top, lathe.rise(HEIGHT / 2)
    r.mark_sharp(barrel.top)
    widen(r, [lathe.bottom, waist, upper], 1.0, size="barrel_width")
    widen(r, [waist], 1.0, size="barrel_waist")
    return barrel


def _flat_feet(r: Recorder) -> tuple[Component, Component]:
    """A disc with a cone on it, and a square plate."""
    disc = r.prism(SIDES, control_diameter(FOOT_WIDTH, SIDES), FOOT_THICKNESS)
    r.mark_sharp(disc.bottom, disc.top)
    half = FOOT_WIDTH / 2
    slab = board(r, (-half, -half, 0.0), (half, half, FOOT_THICKNESS))[0]
    for made in (disc, slab):
        r.scale(Target((made.whole,), "world"), 1.0, "z", pivot=made.bottom, size="foot_thickness")
    for rise, share in ((0.0, 0.7), (0.5 * CONE_HEIGHT, 0.55), (0.5 * CONE_HEIGHT, 0.6)):
        if rise:
            r.extrude(disc.top, rise, length="cone")
        else:
            r.extrude(disc.top, rise)
        r.scale(disc.top, share, "uv")
    r.scale(group(disc.whole, slab.whole, frame="world"), 1.0, "uv", size="foot_width")
    return disc, slab


def _claws(r: Recorder, count: int) -> Loft:
    """Bars around the axis, flat on the floor."""
    sections = [Section(share * CLAW_LENGTH, CLAW_WIDTH * size, CLAW_THICKNESS * size) for share, _, size in CLAW]
    place = (0.0, 0.0, CLAW_THICKNESS * CLAW[-1][2] / 2)
    return beam(r, "+x", sections, crease="ends", offset=place, anchors=_around(count))


def _shape_claws(r: Recorder, claws: Sequence[Loft]) -> None:
    each = [target for made in claws for number in range(len(CLAW)) for target in made.sections(number)]
    r.scale(each, 1.0, "v", size="claw_width")
    r.scale(each, 1.0, "z", size="claw_thickness")
    for made in claws:
        r.scale(made.body(hinge=0), 1.0, "u", size="claw_length")
        for number, (share, height, _) in enumerate(CLAW):
            if height:
                move(r, made.sections(number), (0.0, 0.0, CLAW_HEIGHT * height), length="claw_height")
            if 0.0 < share < 1.0:
                move(r, made.sections(number), (0.0, 0.0, CLAW_ARCH * 4 * share * (1 - share)), length="claw_arch")


def _around(count: int) -> list[Target]:
    """Return anchors in the axis, turned evenly."""
    return [Target((), "world", (Turn("z", 360.0 * number / count),) if number else ()) for number in range(count)]


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
