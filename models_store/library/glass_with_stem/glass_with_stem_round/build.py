"""Models a glass with a round bowl: coupe, balloon glass, brandy snifter.

The bowl is a part of a ball: a rounded bottom, a belly, and an opening as wide as the belly or narrower.
"""

from pathlib import Path

from models_store.library.aids.lathe import draw_in, widen
from models_store.library.author import publish
from models_store.library.glass_with_stem import stemware
from shapewright.modeling import ProceduralModel, Recorder

FOOT_DIAMETER = 0.56
FOOT_EDGE = 0.012
FOOT_HEIGHT = 0.055
FOOT_HOLLOW = 0.022
FOOT_RISE = 0.5  # diameter of the foot's middle ring, relative to the foot's
STEM_DIAMETER = 0.056
STEM_LENGTH = 0.26
STEM_ROOT = 1.7  # diameter at the foot, relative to the stem's
STEM_TOP = 1.2  # diameter below the bowl, relative to the stem's
BELLY_DIAMETER = 0.80
LOWER_DEPTH = 0.30  # of the bowl below its belly
UPPER_DEPTH = 0.24  # above it
RIM_INSET = 0.08  # from the belly, relative to its diameter
SHOULDER = 0.3  # share of that between belly and rim
LOWER = 0.80  # diameter of the lower bowl, relative to the belly's
BOTTOM = 0.42  # diameter of the bowl's bottom, relative to the lower bowl's


def build() -> ProceduralModel:
    """Model the glass."""
    recorder = Recorder(
        "glass_with_stem_round",
        "glass_with_stem",
        unit_m=stemware.UNIT_M,
        description="A glass with a round bowl on a short stem: coupe, balloon glass or brandy snifter.",
    )
    recorder.parameter(
        "foot_diameter", "Foot diameter", 0.6, 1.5, base_value=stemware.centimeters(FOOT_DIAMETER), unit="cm"
    )
    recorder.parameter("foot_height", "Foot height", 0.3, 2.5, base_value=stemware.centimeters(FOOT_HEIGHT), unit="cm")
    recorder.parameter(
        "foot_hollow",
        "Foot hollow (height below its middle)",
        0.0,
        2.0,
        base_value=stemware.centimeters(FOOT_HOLLOW),
        unit="cm",
    )
    recorder.limit("foot_hollow", maximum=("foot_height", 0.25, 1.0))
    recorder.parameter("foot_slope", "Foot slope width (relative to the foot)", 0.6, 1.4, base_value=FOOT_RISE)
    recorder.parameter("stem_length", "Stem length", 0.1, 2.0, base_value=stemware.centimeters(STEM_LENGTH), unit="cm")
    recorder.parameter(
        "stem_thickness", "Stem thickness", 0.5, 2.2, base_value=stemware.centimeters(STEM_DIAMETER), unit="cm"
    )
    recorder.parameter("stem_root", "Stem width at the foot (relative to the stem)", 0.6, 1.8, base_value=STEM_ROOT)
    recorder.limit("stem_root", maximum=("stem_thickness", 2.3, -0.6))
    recorder.parameter("stem_top", "Stem width below the bowl (relative to the stem)", 0.8, 2.0, base_value=STEM_TOP)
    recorder.parameter(
        "belly_diameter", "Bowl diameter", 0.6, 1.3, base_value=stemware.centimeters(BELLY_DIAMETER), unit="cm"
    )
    recorder.parameter(
        "lower_depth",
        "Bowl depth below its widest place",
        0.4,
        1.5,
        base_value=stemware.centimeters(LOWER_DEPTH),
        unit="cm",
    )
    recorder.parameter(
        "upper_depth",
        "Bowl depth above its widest place",
        0.2,
        1.8,
        base_value=stemware.centimeters(UPPER_DEPTH),
        unit="cm",
    )
    recorder.parameter("rim_inset", "Rim inset (relative to the bowl's diameter)", -0.3, 3.0, base_value=RIM_INSET)
    recorder.limit("rim_inset", maximum=("upper_depth", -0.3, 2.2))
    recorder.parameter("lower_width", "Lower bowl width (relative to the bowl)", 0.8, 1.15, base_value=LOWER)
    recorder.parameter("bottom_width", "Bowl bottom width (relative to the lower bowl)", 0.5, 1.5, base_value=BOTTOM)

    foot = stemware.foot(recorder, FOOT_EDGE, 0.4 * FOOT_HEIGHT, length="foot_height")
    hollow = stemware.underside(recorder, foot, 0.5, FOOT_HOLLOW, length="foot_hollow")
    column = foot.column
    root = column.rise(0.6 * FOOT_HEIGHT, length="foot_height")
    stem = [root, *(column.rise(share * STEM_LENGTH, length="stem_length") for share in (0.2, 0.4, 0.4))]
    rises = [
        *((share * LOWER_DEPTH, "lower_depth") for share in (0.08, 0.34, 0.58)),
        *((share * UPPER_DEPTH, "upper_depth") for share in (0.5, 0.5)),
    ]
    bowl = stemware.bowl(recorder, column, rises, thickness=0.05 * LOWER_DEPTH)

    widen(recorder, [*foot.rings, hollow], FOOT_DIAMETER, size="foot_diameter")
    widen(recorder, [foot.rings[-1]], FOOT_RISE, size="foot_slope")
    widen(recorder, stem, STEM_DIAMETER, size="stem_thickness")
    widen(recorder, [root], STEM_ROOT, size="stem_root")
    widen(recorder, [stem[-1]], STEM_TOP, size="stem_top")
    draw_in(recorder, bowl.at(-1), RIM_INSET, length="rim_inset")
    draw_in(recorder, bowl.at(-2), SHOULDER * RIM_INSET, length="rim_inset")
    widen(recorder, bowl.up_to(-1), BELLY_DIAMETER, size="belly_diameter")
    widen(recorder, bowl.up_to(1), LOWER, size="lower_width")
    widen(recorder, bowl.up_to(0), BOTTOM, size="bottom_width")
    stemware.thin_wall(recorder, bowl)
    recorder.symmetry(mirrors=("x", "y"), axis="z", order=stemware.SIDES)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
