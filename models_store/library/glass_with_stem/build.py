"""Models a glass with a stem: wine, martini and champagne glasses, goblets.

A straight column of rings rises from the foot to the rim and goes down again inside as the inner wall of the bowl;
then the rings get their widths. The bowl's widths hang on each other (bottom on lower part, on belly, on rim), so
that every combination is a bowl.
"""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.lathe import Lathe, control_diameter, widen
from shapewright.modeling import ProceduralModel, Recorder

SIDES = 12
FOOT_DIAMETER = 0.50
FOOT_EDGE = 0.010
FOOT_HEIGHT = 0.040
STEM_DIAMETER = 0.046
STEM_LENGTH = 0.38
KNOP_HEIGHT = 0.06
KNOP = 1.6  # diameter, relative to the stem's
RIM_DIAMETER = 0.48
BOWL_DEPTH = 0.40
BELLY = 1.10  # diameter, relative to the rim's
LOWER = 0.80  # diameter of the lower bowl, relative to the belly's
BOTTOM = 0.32  # diameter of the bowl's bottom, relative to the lower bowl's
WALL = 0.955  # inner width, relative to the outer one


def build() -> ProceduralModel:
    """Model the glass."""
    recorder = Recorder(
        "glass_with_stem",
        "glass_with_stem",
        description="A drinking glass with foot, stem and bowl: wine, martini or champagne glass, goblet.",
    )
    recorder.parameter("foot_diameter", "Foot diameter", 0.6, 1.5, base_value=FOOT_DIAMETER)
    recorder.parameter("foot_height", "Foot height", 0.3, 3.5, base_value=FOOT_HEIGHT)
    recorder.parameter("stem_length", "Stem length (without knop)", 0.1, 1.7, base_value=STEM_LENGTH)
    recorder.parameter("stem_thickness", "Stem thickness", 0.5, 2.4, base_value=STEM_DIAMETER)
    recorder.parameter("knop_width", "Knop width (relative to the stem)", 0.625, 1.7, base_value=KNOP)
    recorder.parameter("bowl_depth", "Bowl depth", 0.5, 1.7, base_value=BOWL_DEPTH)
    recorder.parameter("rim_diameter", "Rim diameter", 0.5, 1.6, base_value=RIM_DIAMETER)
    recorder.parameter("belly_width", "Belly width (relative to the rim)", 0.5, 1.3, base_value=BELLY)
    recorder.parameter("lower_bowl_width", "Lower bowl width (relative to the belly)", 0.6, 1.2, base_value=LOWER)
    recorder.parameter(
        "bowl_bottom_width", "Bowl bottom width (relative to the lower bowl)", 0.5, 2.2, base_value=BOTTOM
    )

    disc = recorder.prism(SIDES, control_diameter(1.0, SIDES), FOOT_EDGE)
    column = Lathe(recorder, disc)
    recorder.mark_sharp(disc.bottom, disc.top)
    foot = [column.bottom, column.top]

    # Foot and stem.
    slope = column.rise(0.45 * FOOT_HEIGHT, length="foot_height")
    stem_foot = column.rise(0.55 * FOOT_HEIGHT, length="foot_height")
    stem = [stem_foot, *(column.rise(share * STEM_LENGTH, length="stem_length") for share in (0.13, 0.27, 0.30, 0.14))]
    stem += [column.rise(KNOP_HEIGHT / 2, length="stem_thickness") for _ in range(2)]  # stays as high as it is thick
    knop = stem[-2]
    stem += [column.rise(share * STEM_LENGTH, length="stem_length") for share in (0.10, 0.06)]

    # Bowl: outer wall, rim, inner wall.
    bottom = column.rise(0.04 * BOWL_DEPTH, length="bowl_depth")
    lower = column.rise(0.18 * BOWL_DEPTH, length="bowl_depth")
    belly = column.rise(0.30 * BOWL_DEPTH, length="bowl_depth")
    rim = column.rise(0.48 * BOWL_DEPTH, length="bowl_depth")
    recorder.mark_sharp(column.face)
    inner_rim = column.rise(0.0)
    recorder.mark_sharp(column.face)
    inner_belly = column.rise(-0.47 * BOWL_DEPTH, length="bowl_depth")
    inner_lower = column.rise(-0.29 * BOWL_DEPTH, length="bowl_depth")
    inner_bottom = column.rise(-0.15 * BOWL_DEPTH, length="bowl_depth")
    floor = column.rise(0.0)

    # Underside of the foot, so that its vertices spread over the disc.
    recorder.extrude(disc.bottom, 0.0)
    recorder.scale(disc.bottom, 0.5)
    hollow = tuple(recorder.vertices_of(disc.bottom))

    # Widths.
    widen(recorder, [*foot, slope, hollow], FOOT_DIAMETER, size="foot_diameter")
    widen(recorder, [slope], 0.50)
    widen(recorder, stem, STEM_DIAMETER, size="stem_thickness")
    for ring, width in zip(stem, (1.9, 1.25, 1.0, 0.95, 1.0, 1.0, 1.0, 0.95, 1.15), strict=True):
        if width != 1.0:
            widen(recorder, [ring], width)
    widen(recorder, [knop], KNOP, size="knop_width")
    wall = [inner_rim, inner_belly, inner_lower, inner_bottom, floor]
    widen(recorder, [bottom, lower, belly, rim, *wall], RIM_DIAMETER, size="rim_diameter")
    lowest = [bottom, inner_bottom, floor]
    widen(recorder, [belly, inner_belly, lower, inner_lower, *lowest], BELLY, size="belly_width")
    widen(recorder, [lower, inner_lower, *lowest], LOWER, size="lower_bowl_width")
    widen(recorder, lowest, BOTTOM, size="bowl_bottom_width")
    widen(recorder, wall, WALL)
    widen(recorder, [floor], 0.5)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
