"""Models a martini glass: a conical bowl on a stem with up to three beads below the bowl."""

from pathlib import Path

from models_store.library.aids.lathe import widen
from models_store.library.author import publish
from models_store.library.glass_with_stem import stemware
from shapewright.modeling import ProceduralModel, Recorder, when

FOOT_DIAMETER = 0.56
FOOT_EDGE = 0.010
FOOT_HEIGHT = 0.045
FOOT_HOLLOW = 0.016
STEM_DIAMETER = 0.050
STEM_LENGTH = 0.45
STEM_ROOT = 1.8  # diameter at the foot, relative to the stem's
STEM_TOP = 1.2  # diameter below the bowl, relative to the stem's
RIM_DIAMETER = 0.72
BOWL_DEPTH = 0.42
MIDDLE = 0.58  # diameter halfway up the bowl, relative to the rim's
BOTTOM = 0.22  # diameter of the bowl's bottom, relative to the middle's
BEAD_DIAMETER = 0.115
BEAD_HEIGHT = 0.060
BEAD_DROP = 0.05  # below the bowl
BEADS = ("none", "one", "two", "three")


def build() -> ProceduralModel:
    """Model the glass."""
    recorder = Recorder(
        "glass_with_stem_cone",
        "glass_with_stem",
        unit_m=stemware.UNIT_M,
        description="A martini or cocktail glass with a conical bowl.",
    )
    recorder.parameter(
        "foot_diameter", "Foot diameter", 0.6, 1.4, base_value=stemware.centimeters(FOOT_DIAMETER), unit="cm"
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
    recorder.parameter("stem_length", "Stem length", 0.4, 1.6, base_value=stemware.centimeters(STEM_LENGTH), unit="cm")
    recorder.parameter(
        "stem_thickness", "Stem thickness", 0.5, 2.2, base_value=stemware.centimeters(STEM_DIAMETER), unit="cm"
    )
    recorder.parameter("stem_root", "Stem width at the foot (relative to the stem)", 0.6, 1.8, base_value=STEM_ROOT)
    recorder.limit("stem_root", maximum=("stem_thickness", 2.3, -0.6))
    recorder.parameter("stem_top", "Stem width below the bowl (relative to the stem)", 0.8, 2.2, base_value=STEM_TOP)
    recorder.parameter(
        "rim_diameter", "Rim diameter", 0.6, 1.4, base_value=stemware.centimeters(RIM_DIAMETER), unit="cm"
    )
    recorder.parameter("bowl_depth", "Bowl depth", 0.6, 1.5, base_value=stemware.centimeters(BOWL_DEPTH), unit="cm")
    recorder.parameter("middle_width", "Width halfway up the bowl (relative to the rim)", 0.85, 1.4, base_value=MIDDLE)
    recorder.parameter("bottom_width", "Bowl bottom width (relative to the middle)", 0.6, 1.9, base_value=BOTTOM)
    recorder.choice("beads", "Beads on the stem", BEADS)
    some = (when("beads", 2, 4),)
    recorder.parameter(
        "bead_width",
        "Bead width",
        0.75,
        1.5,
        base_value=stemware.centimeters(BEAD_DIAMETER),
        active_when=some,
        unit="cm",
    )
    recorder.limit("bead_width", minimum=("stem_thickness", 0.25, 0.5))
    recorder.parameter(
        "bead_height",
        "Bead height",
        0.25,
        1.4,
        base_value=stemware.centimeters(BEAD_HEIGHT),
        active_when=some,
        unit="cm",
    )
    recorder.limit("bead_height", maximum=("stem_length", 0.1, 1.1))
    recorder.parameter(
        "bead_drop",
        "Distance from bead to bowl",
        0.0,
        4.0,
        base_value=stemware.centimeters(BEAD_DROP),
        active_when=some,
        unit="cm",
    )
    recorder.limit("bead_drop", maximum=("stem_length", 0.0, 4.0))

    foot = stemware.foot(recorder, FOOT_EDGE, 0.4 * FOOT_HEIGHT, length="foot_height")
    hollow = stemware.underside(recorder, foot, 0.5, FOOT_HOLLOW, length="foot_hollow")
    column = foot.column
    root = column.rise(0.6 * FOOT_HEIGHT, length="foot_height")
    stem = [root, *(column.rise(share * STEM_LENGTH, length="stem_length") for share in (0.12, 0.30, 0.30, 0.28))]
    rises = [(share * BOWL_DEPTH, "bowl_depth") for share in (0.06, 0.44, 0.50)]
    bowl = stemware.bowl(recorder, column, rises, thickness=0.04 * BOWL_DEPTH)

    widen(recorder, [*foot.rings, hollow], FOOT_DIAMETER, size="foot_diameter")
    widen(recorder, [foot.rings[-1]], 0.50)
    widen(recorder, stem, STEM_DIAMETER, size="stem_thickness")
    widen(recorder, [root], STEM_ROOT, size="stem_root")
    widen(recorder, [stem[1]], 1.15)
    widen(recorder, [stem[-1]], STEM_TOP, size="stem_top")
    widen(recorder, bowl.up_to(-1), RIM_DIAMETER, size="rim_diameter")
    widen(recorder, bowl.up_to(1), MIDDLE, size="middle_width")
    widen(recorder, bowl.up_to(0), BOTTOM, size="bottom_width")
    stemware.thin_wall(recorder, bowl)

    beads = [stemware.bead(recorder, stem[-1], BEAD_HEIGHT, 0.9 * number * BEAD_HEIGHT) for number in range(3)]
    recorder.scale([bead.whole() for bead in beads], BEAD_DIAMETER, "uv", size="bead_width")
    recorder.scale([bead.whole(stem[-1]) for bead in beads], 1.0, "z", size="bead_height")
    recorder.drag([bead.whole() for bead in beads], -BEAD_DROP, length="bead_drop")
    for number, bead in enumerate(beads):
        recorder.part(f"bead {number + 1}", [bead.component], [when("beads", number + 2, 4)])
    recorder.symmetry(mirrors=("x", "y"), axis="z", order=stemware.SIDES)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
