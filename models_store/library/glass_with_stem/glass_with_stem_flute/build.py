"""Models a champagne flute: a tall and narrow bowl on a thin stem.

The bowl is a tulip, a straight cone or a cylinder; its bottom is pointed, round, or a flat step.
"""

from pathlib import Path

from models_store.library.aids.lathe import draw_in, widen
from models_store.library.author import publish
from models_store.library.glass_with_stem import stemware
from shapewright.modeling import ProceduralModel, Recorder

FOOT_DIAMETER = 0.30
FOOT_EDGE = 0.008
FOOT_HEIGHT = 0.030
FOOT_HOLLOW = 0.012
STEM_DIAMETER = 0.036
STEM_LENGTH = 0.34
STEM_ROOT = 1.7  # diameter at the foot, relative to the stem's
STEM_TOP = 1.3  # diameter below the bowl, relative to the stem's
RIM_DIAMETER = 0.24
BOWL_DEPTH = 0.62
LIP = 0.02  # how far the rim turns outwards, relative to its diameter
UPPER = 1.04  # diameter of the upper bowl, relative to the rim's
BELLY = 1.0  # diameter in the middle of the bowl, relative to the upper bowl's
LOWER = 0.84  # diameter of the lower bowl, relative to the belly's
BOTTOM = 0.42  # diameter of the bowl's bottom, relative to the lower bowl's


def build() -> ProceduralModel:
    """Model the flute."""
    recorder = Recorder(
        "glass_with_stem_flute",
        "glass_with_stem",
        unit_m=stemware.UNIT_M,
        description="A champagne flute or another tall glass with a stem.",
    )
    recorder.parameter(
        "foot_diameter", "Foot diameter", 0.7, 1.5, base_value=stemware.centimeters(FOOT_DIAMETER), unit="cm"
    )
    recorder.parameter("foot_height", "Foot height", 0.3, 3.0, base_value=stemware.centimeters(FOOT_HEIGHT), unit="cm")
    recorder.parameter(
        "foot_hollow",
        "Foot hollow (height below its middle)",
        0.0,
        2.5,
        base_value=stemware.centimeters(FOOT_HOLLOW),
        unit="cm",
    )
    recorder.limit("foot_hollow", maximum=("foot_height", 0.25, 1.0))
    recorder.parameter("stem_length", "Stem length", 0.15, 1.6, base_value=stemware.centimeters(STEM_LENGTH), unit="cm")
    recorder.parameter(
        "stem_thickness", "Stem thickness", 0.5, 2.2, base_value=stemware.centimeters(STEM_DIAMETER), unit="cm"
    )
    recorder.parameter("stem_root", "Stem width at the foot (relative to the stem)", 0.6, 2.0, base_value=STEM_ROOT)
    recorder.limit("stem_root", maximum=("stem_thickness", 2.4, -0.6))
    recorder.parameter("stem_top", "Stem width below the bowl (relative to the stem)", 0.75, 2.2, base_value=STEM_TOP)
    recorder.parameter(
        "rim_diameter", "Rim diameter", 0.7, 1.8, base_value=stemware.centimeters(RIM_DIAMETER), unit="cm"
    )
    recorder.parameter("bowl_depth", "Bowl depth", 0.6, 1.3, base_value=stemware.centimeters(BOWL_DEPTH), unit="cm")
    recorder.parameter(
        "lip", "Lip (how far the rim turns outwards)", -1.5, 3.0, base_value=stemware.centimeters(LIP), unit="cm"
    )
    recorder.parameter("upper_width", "Upper bowl width (relative to the rim)", 0.85, 1.2, base_value=UPPER)
    recorder.parameter("belly_width", "Middle bowl width (relative to the upper bowl)", 0.7, 1.2, base_value=BELLY)
    recorder.parameter("lower_width", "Lower bowl width (relative to the middle)", 0.6, 1.15, base_value=LOWER)
    recorder.parameter("bottom_width", "Bowl bottom width (relative to the lower bowl)", 0.5, 2.1, base_value=BOTTOM)

    foot = stemware.foot(recorder, FOOT_EDGE, 0.4 * FOOT_HEIGHT, length="foot_height")
    hollow = stemware.underside(recorder, foot, 0.5, FOOT_HOLLOW, length="foot_hollow")
    column = foot.column
    root = column.rise(0.6 * FOOT_HEIGHT, length="foot_height")
    stem = [root, *(column.rise(share * STEM_LENGTH, length="stem_length") for share in (0.15, 0.45, 0.40))]
    shares = (0.03, 0.15, 0.32, 0.40, 0.10)
    bowl = stemware.bowl(
        recorder, column, [(s * BOWL_DEPTH, "bowl_depth") for s in shares], thickness=0.03 * BOWL_DEPTH
    )

    widen(recorder, [*foot.rings, hollow], FOOT_DIAMETER, size="foot_diameter")
    widen(recorder, [foot.rings[-1]], 0.48)
    widen(recorder, stem, STEM_DIAMETER, size="stem_thickness")
    widen(recorder, [root], STEM_ROOT, size="stem_root")
    widen(recorder, [stem[-1]], STEM_TOP, size="stem_top")
    draw_in(recorder, bowl.at(-1), -LIP, length="lip")
    widen(recorder, bowl.up_to(-1), RIM_DIAMETER, size="rim_diameter")
    widen(recorder, bowl.up_to(3), UPPER, size="upper_width")
    widen(recorder, bowl.up_to(2), BELLY, size="belly_width")
    widen(recorder, bowl.up_to(1), LOWER, size="lower_width")
    widen(recorder, bowl.up_to(0), BOTTOM, size="bottom_width")
    stemware.thin_wall(recorder, bowl)
    recorder.symmetry(mirrors=("x", "y"), axis="z", order=stemware.SIDES)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
