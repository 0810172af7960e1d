"""Models a goblet: a trumpet-shaped foot that narrows to a thick stem and widens again into a deep bowl.

The foot may be hollow up to the waist, a bead may sit on the stem, and the rim may turn outwards as a lip.
"""

from pathlib import Path

from models_store.library.aids.lathe import draw_in, widen
from models_store.library.author import publish
from models_store.library.glass_with_stem import stemware
from shapewright.modeling import ProceduralModel, Recorder, Target, group, when

FOOT_DIAMETER = 0.50
FOOT_EDGE = 0.014
FOOT_MIDDLE = 0.52  # diameter where the trumpet bends, relative to the foot's
TRUMPET_LENGTH = 0.20  # from the foot's edge to the waist
HOLLOW = 0.72  # of the trumpet's length
WAIST_DIAMETER = 0.10
NECK_LENGTH = 0.17  # from the waist to the bowl
NECK = 1.3  # diameter below the bowl, relative to the waist's
RIM_DIAMETER = 0.48
BOWL_DEPTH = 0.50
LIP = 0.02  # how far the rim turns outwards, relative to its diameter
BELLY = 1.02  # diameter, relative to the rim's
LOWER = 0.84  # diameter of the lower bowl, relative to the belly's
BOTTOM = 0.50  # diameter of the bowl's bottom, relative to the lower bowl's
BEAD_DIAMETER = 0.19
BEAD_HEIGHT = 0.075


def build() -> ProceduralModel:
    """Model the goblet."""
    recorder = Recorder(
        "glass_with_stem_goblet",
        "glass_with_stem",
        unit_m=stemware.UNIT_M,
        description="A goblet or chalice: trumpet-shaped foot, thick stem with or without a bead, deep bowl.",
    )
    recorder.parameter(
        "foot_diameter", "Foot diameter", 0.65, 1.5, base_value=stemware.centimeters(FOOT_DIAMETER), unit="cm"
    )
    recorder.parameter(
        "foot_edge", "Height of the foot's edge", 0.5, 3.0, base_value=stemware.centimeters(FOOT_EDGE), unit="cm"
    )
    recorder.parameter("foot_middle", "Foot slope width (relative to the foot)", 0.6, 1.4, base_value=FOOT_MIDDLE)
    recorder.parameter(
        "trumpet_length",
        "Length of the foot up to the waist",
        0.25,
        1.8,
        base_value=stemware.centimeters(TRUMPET_LENGTH),
        unit="cm",
    )
    recorder.parameter("foot_hollow", "Foot hollow (relative to the length of the foot)", 0.02, 1.2, base_value=HOLLOW)
    recorder.parameter(
        "waist_width", "Waist width", 0.4, 2.0, base_value=stemware.centimeters(WAIST_DIAMETER), unit="cm"
    )
    recorder.limit("waist_width", maximum=("foot_diameter", 0.0, 1.4))
    recorder.parameter(
        "neck_length",
        "Length from the waist to the bowl",
        0.3,
        2.2,
        base_value=stemware.centimeters(NECK_LENGTH),
        unit="cm",
    )
    recorder.parameter("neck_width", "Width below the bowl (relative to the waist)", 0.8, 2.0, base_value=NECK)
    recorder.parameter(
        "rim_diameter", "Rim diameter", 0.65, 1.4, base_value=stemware.centimeters(RIM_DIAMETER), unit="cm"
    )
    recorder.parameter("bowl_depth", "Bowl depth", 0.6, 1.5, base_value=stemware.centimeters(BOWL_DEPTH), unit="cm")
    recorder.parameter(
        "lip", "Lip (how far the rim turns outwards)", -1.5, 3.5, base_value=stemware.centimeters(LIP), unit="cm"
    )
    recorder.parameter("belly_width", "Belly width (relative to the rim)", 0.75, 1.2, base_value=BELLY)
    recorder.parameter("lower_bowl_width", "Lower bowl width (relative to the belly)", 0.75, 1.15, base_value=LOWER)
    recorder.parameter(
        "bowl_bottom_width", "Bowl bottom width (relative to the lower bowl)", 0.6, 1.7, base_value=BOTTOM
    )
    recorder.switch("bead", "Bead on the stem")
    there = (when("bead", 1),)
    recorder.parameter(
        "bead_width",
        "Bead width",
        0.8,
        1.6,
        base_value=stemware.centimeters(BEAD_DIAMETER),
        active_when=there,
        unit="cm",
    )
    recorder.limit("bead_width", minimum=("waist_width", 0.2, 0.6))
    recorder.parameter(
        "bead_height",
        "Bead height",
        0.3,
        1.6,
        base_value=stemware.centimeters(BEAD_HEIGHT),
        active_when=there,
        unit="cm",
    )
    recorder.limit("bead_height", maximum=("neck_length", 0.4, 1.0))

    foot = stemware.foot(recorder, FOOT_EDGE, 0.3 * TRUMPET_LENGTH, length="trumpet_length", edge_size="foot_edge")
    column = foot.column
    calf = column.rise(0.3 * TRUMPET_LENGTH, length="trumpet_length")
    waist = column.rise(0.4 * TRUMPET_LENGTH, length="trumpet_length")
    neck = [column.rise(share * NECK_LENGTH, length="neck_length") for share in (0.55, 0.45)]
    shares = (0.06, 0.17, 0.32, 0.35, 0.10)
    bowl = stemware.bowl(
        recorder, column, [(s * BOWL_DEPTH, "bowl_depth") for s in shares], thickness=0.06 * BOWL_DEPTH
    )

    # The hollow follows the trumpet from inside: the middle ring below the slope, the upper one below the waist.
    lowest = stemware.underside(recorder, foot, 0.88, 0.0)
    middle, upper = (
        stemware.underside(recorder, foot, width, share * TRUMPET_LENGTH, length="trumpet_length")
        for width, share in ((0.9, 0.42), (1.0, 0.53))
    )
    raised = Target((*middle, *upper), "world", (), foot.rings[0])
    recorder.scale(raised, HOLLOW, "z", size="foot_hollow")
    recorder.scale(group(*upper, frame="world"), 1 / (0.9 * 0.88), "uv")

    widen(recorder, [*foot.rings, lowest, middle], FOOT_DIAMETER, size="foot_diameter")
    widen(recorder, [foot.rings[-1], middle], FOOT_MIDDLE, size="foot_middle")
    widen(recorder, [calf, waist, *neck, upper], WAIST_DIAMETER, size="waist_width")
    widen(recorder, [calf], 1.45)
    widen(recorder, [neck[-1]], NECK, size="neck_width")
    draw_in(recorder, bowl.at(-1), -LIP, length="lip")
    widen(recorder, bowl.up_to(-1), RIM_DIAMETER, size="rim_diameter")
    widen(recorder, bowl.up_to(2), BELLY, size="belly_width")
    widen(recorder, bowl.up_to(1), LOWER, size="lower_bowl_width")
    widen(recorder, bowl.up_to(0), BOTTOM, size="bowl_bottom_width")
    stemware.thin_wall(recorder, bowl)

    bead = stemware.bead(recorder, neck[0], BEAD_HEIGHT, -BEAD_HEIGHT / 2)
    recorder.scale(bead.whole(), BEAD_DIAMETER, "uv", size="bead_width")
    recorder.scale(bead.whole(), 1.0, "z", size="bead_height")
    recorder.part("bead", [bead.component], there)
    recorder.symmetry(mirrors=("x", "y"), axis="z", order=stemware.SIDES)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
