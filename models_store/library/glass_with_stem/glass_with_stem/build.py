"""Models a glass with a stem: wine, water and champagne glasses.

A straight column of rings rises from the foot to the rim and goes down again inside as the inner wall of the bowl;
then the rings get their widths.
"""

from pathlib import Path

from models_store.library.aids.lathe import widen
from models_store.library.author import publish
from models_store.library.glass_with_stem import stemware
from shapewright.modeling import ProceduralModel, Recorder

FOOT_DIAMETER = 0.50
FOOT_EDGE = 0.010
FOOT_HEIGHT = 0.040
FOOT_HOLLOW = 0.016
STEM_DIAMETER = 0.046
STEM_LENGTH = 0.38
STEM_ROOT = 1.9  # diameter at the foot, relative to the stem's
KNOP_HEIGHT = 0.06
KNOP = 1.6  # diameter, relative to the stem's
RIM_DIAMETER = 0.48
BOWL_DEPTH = 0.40
BELLY = 1.10  # diameter, relative to the rim's
LOWER = 0.80  # diameter of the lower bowl, relative to the belly's
BOTTOM = 0.32  # diameter of the bowl's bottom, relative to the lower bowl's


def build() -> ProceduralModel:
    """Model the glass."""
    recorder = Recorder(
        "glass_with_stem",
        "glass_with_stem",
        unit_m=stemware.UNIT_M,
        description="A drinking glass with foot, stem and rounded bowl: wine, water or champagne glass.",
    )
    recorder.parameter(
        "foot_diameter", "Foot diameter", 0.6, 1.5, base_value=stemware.centimeters(FOOT_DIAMETER), unit="cm"
    )
    recorder.parameter("foot_height", "Foot height", 0.3, 3.5, base_value=stemware.centimeters(FOOT_HEIGHT), unit="cm")
    recorder.parameter(
        "foot_hollow",
        "Foot hollow (height below its middle)",
        0.0,
        2.5,
        base_value=stemware.centimeters(FOOT_HOLLOW),
        unit="cm",
    )
    recorder.limit("foot_hollow", maximum=("foot_height", 0.25, 1.0))
    recorder.parameter(
        "stem_length", "Stem length (without knop)", 0.1, 1.7, base_value=stemware.centimeters(STEM_LENGTH), unit="cm"
    )
    recorder.parameter(
        "stem_thickness", "Stem thickness", 0.5, 2.4, base_value=stemware.centimeters(STEM_DIAMETER), unit="cm"
    )
    recorder.parameter("stem_root", "Stem width at the foot (relative to the stem)", 0.6, 1.6, base_value=STEM_ROOT)
    recorder.limit("stem_root", maximum=("stem_thickness", 2.1, -0.5))
    recorder.parameter("knop_width", "Knop width (relative to the stem)", 0.625, 1.9, base_value=KNOP)
    recorder.parameter("bowl_depth", "Bowl depth", 0.5, 1.7, base_value=stemware.centimeters(BOWL_DEPTH), unit="cm")
    recorder.parameter(
        "rim_diameter", "Rim diameter", 0.5, 1.6, base_value=stemware.centimeters(RIM_DIAMETER), unit="cm"
    )
    recorder.parameter("belly_width", "Belly width (relative to the rim)", 0.5, 1.3, base_value=BELLY)
    recorder.parameter("lower_bowl_width", "Lower bowl width (relative to the belly)", 0.6, 1.2, base_value=LOWER)
    recorder.parameter(
        "bowl_bottom_width", "Bowl bottom width (relative to the lower bowl)", 0.5, 2.2, base_value=BOTTOM
    )

    foot = stemware.foot(recorder, FOOT_EDGE, 0.45 * FOOT_HEIGHT, length="foot_height")
    hollow = stemware.underside(recorder, foot, 0.5, FOOT_HOLLOW, length="foot_hollow")
    column = foot.column
    root = column.rise(0.55 * FOOT_HEIGHT, length="foot_height")
    stem = [root, *(column.rise(share * STEM_LENGTH, length="stem_length") for share in (0.13, 0.27, 0.30, 0.14))]
    stem += [column.rise(KNOP_HEIGHT / 2, length="stem_thickness") for _ in range(2)]  # stays as high as it is thick
    knop = stem[-2]
    stem += [column.rise(share * STEM_LENGTH, length="stem_length") for share in (0.10, 0.06)]
    rises = [(share * BOWL_DEPTH, "bowl_depth") for share in (0.04, 0.18, 0.30, 0.48)]
    bowl = stemware.bowl(recorder, column, rises, thickness=0.03 * BOWL_DEPTH)

    widen(recorder, [*foot.rings, hollow], FOOT_DIAMETER, size="foot_diameter")
    widen(recorder, [foot.rings[-1]], 0.50)
    widen(recorder, stem, STEM_DIAMETER, size="stem_thickness")
    widen(recorder, [root], STEM_ROOT, size="stem_root")
    for ring, width in zip(stem[1:], (1.25, 1.0, 0.95, 1.0, 1.0, 1.0, 0.95, 1.15), strict=True):
        if width != 1.0:
            widen(recorder, [ring], width)
    widen(recorder, [knop], KNOP, size="knop_width")
    widen(recorder, bowl.up_to(-1), RIM_DIAMETER, size="rim_diameter")
    widen(recorder, bowl.up_to(2), BELLY, size="belly_width")
    widen(recorder, bowl.up_to(1), LOWER, size="lower_bowl_width")
    widen(recorder, bowl.up_to(0), BOTTOM, size="bowl_bottom_width")
    stemware.thin_wall(recorder, bowl)
    recorder.symmetry(mirrors=("x", "y"), axis="z", order=stemware.SIDES)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
