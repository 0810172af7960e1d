"""Models a glass as one thin wall: foot, stem and bowl are a single surface of revolution, open below and above.

So glasses are often drawn: the profile is turned once. The foot is anything from a flat disc to a trumpet, the bowl
anything from a shallow coupe to a tulip.
"""

from pathlib import Path

from models_store.library.aids.lathe import Lathe, control_diameter, draw_in, widen
from models_store.library.author import publish
from models_store.library.glass_with_stem.stemware import SIDES, UNIT_M, centimeters
from shapewright.modeling import ProceduralModel, Recorder, group

FOOT_DIAMETER = 0.56
FOOT_EDGE = 0.015
FOOT_HEIGHT = 0.07
FOOT_SLOPE = 0.56  # diameter of the foot's middle, relative to the foot's
STEM_DIAMETER = 0.060
STEM_LENGTH = 0.36
STEM_ROOT = 1.6  # diameter at the foot, relative to the stem's
STEM_TOP = 1.3  # diameter below the bowl, relative to the stem's
RIM_DIAMETER = 0.62
BOWL_DEPTH = 0.42
LIP = 0.01  # how far the rim turns outwards, relative to its diameter
UPPER = 1.03  # diameter of the upper bowl, relative to the rim's
BELLY = 0.94  # diameter in the middle of the bowl, relative to the upper bowl's
LOWER = 0.74  # diameter of the lower bowl, relative to the middle's
BOTTOM = 0.42  # diameter of the bowl's bottom, relative to the lower bowl's


def build() -> ProceduralModel:
    """Model the glass."""
    recorder = Recorder(
        "glass_with_stem_shell",
        "glass_with_stem",
        unit_m=UNIT_M,
        description="A glass with a stem as one thin wall without thickness: wine glass, coupe or goblet.",
        closed=False,
    )
    recorder.parameter("foot_diameter", "Foot diameter", 0.6, 1.5, base_value=centimeters(FOOT_DIAMETER), unit="cm")
    recorder.parameter("foot_edge", "Height of the foot's edge", 0.2, 2.5, base_value=centimeters(FOOT_EDGE), unit="cm")
    recorder.parameter("foot_height", "Foot height", 0.3, 3.0, base_value=centimeters(FOOT_HEIGHT), unit="cm")
    recorder.parameter("foot_slope", "Foot slope width (relative to the foot)", 0.6, 1.5, base_value=FOOT_SLOPE)
    recorder.parameter("stem_length", "Stem length", 0.15, 1.6, base_value=centimeters(STEM_LENGTH), unit="cm")
    recorder.parameter("stem_thickness", "Stem thickness", 0.5, 3.0, base_value=centimeters(STEM_DIAMETER), unit="cm")
    recorder.parameter("stem_root", "Stem width at the foot (relative to the stem)", 0.65, 1.8, base_value=STEM_ROOT)
    recorder.limit("stem_root", maximum=("stem_thickness", 2.1, -0.4))
    recorder.parameter("stem_top", "Stem width below the bowl (relative to the stem)", 0.7, 2.0, base_value=STEM_TOP)
    recorder.limit("stem_top", maximum=("stem_thickness", 2.15, -0.45))
    recorder.parameter("rim_diameter", "Rim diameter", 0.5, 1.6, base_value=centimeters(RIM_DIAMETER), unit="cm")
    recorder.limit("rim_diameter", minimum=("stem_thickness", -0.25, 0.6))
    recorder.parameter("bowl_depth", "Bowl depth", 0.4, 1.7, base_value=centimeters(BOWL_DEPTH), unit="cm")
    recorder.parameter("lip", "Lip (how far the rim turns outwards)", -3.0, 4.0, base_value=centimeters(LIP), unit="cm")
    recorder.parameter("upper_width", "Upper bowl width (relative to the rim)", 0.9, 1.12, base_value=UPPER)
    recorder.parameter("belly_width", "Middle bowl width (relative to the upper bowl)", 0.7, 1.1, base_value=BELLY)
    recorder.parameter("lower_width", "Lower bowl width (relative to the middle)", 0.65, 1.3, base_value=LOWER)
    recorder.parameter("bottom_width", "Bowl bottom width (relative to the lower bowl)", 0.7, 1.8, base_value=BOTTOM)

    disc = recorder.prism(SIDES, control_diameter(1.0, SIDES), FOOT_EDGE)
    recorder.scale(group(disc.whole, frame="world"), 1.0, "z", pivot=disc.bottom, size="foot_edge")
    column = Lathe(recorder, disc)
    foot = [column.bottom, column.top, column.rise(0.4 * FOOT_HEIGHT, length="foot_height")]
    root = column.rise(0.6 * FOOT_HEIGHT, length="foot_height")
    stem = [root, *(column.rise(share * STEM_LENGTH, length="stem_length") for share in (0.25, 0.4, 0.35))]
    bowl = [column.rise(share * BOWL_DEPTH, length="bowl_depth") for share in (0.05, 0.2, 0.3, 0.33, 0.12)]
    recorder.remove(disc.bottom, column.face)

    widen(recorder, foot, FOOT_DIAMETER, size="foot_diameter")
    widen(recorder, [foot[-1]], FOOT_SLOPE, size="foot_slope")
    widen(recorder, stem, STEM_DIAMETER, size="stem_thickness")
    widen(recorder, [root], STEM_ROOT, size="stem_root")
    widen(recorder, [stem[-1]], STEM_TOP, size="stem_top")
    draw_in(recorder, [bowl[-1]], -LIP, length="lip")
    widen(recorder, bowl, RIM_DIAMETER, size="rim_diameter")
    widen(recorder, bowl[:4], UPPER, size="upper_width")
    widen(recorder, bowl[:3], BELLY, size="belly_width")
    widen(recorder, bowl[:2], LOWER, size="lower_width")
    widen(recorder, bowl[:1], BOTTOM, size="bottom_width")
    recorder.symmetry(mirrors=("x", "y"), axis="z", order=SIDES)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
