"""Models a long, slender fish: eel, pike, barracuda, ribbonfish. Forward is +x.

Body and the fins of its middle plane are sketched straight, get their proportions and are bent together; the paired
fins are hung on the finished body.
"""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.fish.fishes import (
    BEND_DEG,
    HEAD_TILT_DEG,
    PECTORAL_DROOP_DEG,
    PECTORAL_PITCH_DEG,
    PECTORAL_SWEEP_DEG,
    PELVIC_DROOP_DEG,
    PELVIC_SWEEP_DEG,
    PLACE,
    SAG,
    SWEEP,
    Outline,
    at_side,
    bend,
    declare,
    model_body,
    model_eyes,
    model_fin,
    model_side_fins,
    model_tail,
    shape_body,
    size_fin,
    wholes,
)
from shapewright.modeling import ProceduralModel, Recorder, when

LENGTH, HEIGHT, WIDTH, FIN_THICKNESS = 0.70, 0.080, 0.060, 0.007
TAIL_LENGTH, TAIL_HEIGHTS = 0.10, (0.034, 0.046, 0.058, 0.062)
PROFILE = (
    (-0.500, 0.40, 0.22),
    (-0.420, 0.60, 0.44),
    (-0.280, 0.84, 0.70),
    (-0.080, 0.96, 0.90),
    (0.100, 1.00, 1.00),
    (0.260, 0.96, 1.00),
    (0.370, 0.84, 0.92),
    (0.440, 0.60, 0.70),
    (0.485, 0.36, 0.46),
    (0.505, 0.16, 0.20),
)
REAR_DORSAL = Outline(((-0.42, 0.04), (-0.37, 0.40), (-0.33, 0.55), (-0.28, 0.45), (-0.24, 0.02)))
LONG_DORSAL = Outline(((-0.50, 0.20), (-0.40, 0.30), (-0.20, 0.34), (0.0, 0.34), (0.16, 0.26), (0.24, 0.02)))
REAR_ANAL = Outline(((-0.42, 0.04), (-0.37, 0.40), (-0.33, 0.50), (-0.28, 0.40), (-0.24, 0.02)))
LONG_ANAL = Outline(((-0.50, 0.20), (-0.40, 0.30), (-0.24, 0.32), (-0.08, 0.30), (0.04, 0.02)))
PECTORAL, PELVIC = (0.060, 0.036), (0.045, 0.028)
EYE = 0.014


def build() -> ProceduralModel:
    """Model the slender fish."""
    recorder = Recorder("fish_eel", "fish", unit_m=1.0, description="A long, slender fish, like an eel or a pike.")
    _declare(recorder)
    fish = model_body(recorder, LENGTH, HEIGHT, WIDTH, FIN_THICKNESS, PROFILE)
    rear, long = (model_fin(recorder, fish, outline) for outline in (REAR_DORSAL, LONG_DORSAL))
    anal, long_anal = (model_fin(recorder, fish, outline, below=True) for outline in (REAR_ANAL, LONG_ANAL))
    size_fin(recorder, fish, (rear, long), "dorsal")
    size_fin(recorder, fish, (anal, long_anal), "anal", below=True)
    model_tail(recorder, fish, TAIL_LENGTH, TAIL_HEIGHTS)
    shape_body(recorder, fish)
    bend(recorder, fish)
    pectoral = model_side_fins(recorder, fish, at_side(recorder, fish, 6, "middle"), *PECTORAL, "pectoral")
    pelvic = model_side_fins(recorder, fish, at_side(recorder, fish, 5, "low"), *PELVIC, "pelvic")
    eyes = model_eyes(recorder, fish, EYE)
    recorder.part("rear dorsal fin", wholes(rear), present_when=(when("dorsal", 1),))
    recorder.part("long dorsal fin", wholes(long), present_when=(when("dorsal", 2),))
    recorder.part("anal fin", wholes(anal), present_when=(when("anal", 1),))
    recorder.part("long anal fin", wholes(long_anal), present_when=(when("anal", 2),))
    recorder.part("pectoral fins", wholes(pectoral), present_when=(when("pectoral", 1),))
    recorder.part("pelvic fins", wholes(pelvic), present_when=(when("pelvic", 1),))
    recorder.part("eyes", wholes(eyes), present_when=(when("eyes", 1),))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare(
        recorder,
        body_length=(0.8, 1.4, LENGTH),
        body_height=(0.6, 1.6, HEIGHT),
        body_width=(0.4, 1.6, WIDTH),
        deepest=(-1.5, 1.5, PLACE * LENGTH),
        sag=(-1.0, 1.0, SAG * HEIGHT),
        snout_length=(0.5, 2.2, 1.0),
        snout_height=(0.5, 1.6, 1.0),
        head_tilt=(-2.0, 2.5, HEAD_TILT_DEG),
        stem_height=(0.5, 1.6, 1.0),
        tail_length=(0.6, 1.8, TAIL_LENGTH),
        tail_height=(0.5, 2.0, TAIL_HEIGHTS[-1]),
        tail_spread=(0.7, 1.6, 1.0),
        tail_fork=(-1.5, 2.0, 0.2 * TAIL_LENGTH),
        fin_thickness=(0.5, 2.5, 1.0),
        tail_bend=(-3.0, 3.0, BEND_DEG),
        body_bend=(-4.0, 4.0, BEND_DEG),
    )
    recorder.choice("dorsal", "Dorsal fin", ("short", "long", "none"))
    dorsal = (when("dorsal", 1, 2),)
    declare(recorder, dorsal, dorsal_height=(0.4, 1.8, 0.5 * HEIGHT), dorsal_sweep=(-0.3, 1.2, SWEEP * LENGTH))
    recorder.choice("anal", "Anal fin", ("short", "long", "none"))
    anal = (when("anal", 1, 2),)
    declare(recorder, anal, anal_height=(0.4, 1.6, 0.5 * HEIGHT), anal_sweep=(-0.3, 1.2, SWEEP * LENGTH))
    recorder.switch("pectoral", "Pectoral fins")
    declare(
        recorder,
        (when("pectoral", 1),),
        pectoral_length=(0.5, 1.8, PECTORAL[0]),
        pectoral_width=(0.6, 1.5, 1.0),
        pectoral_sweep=(0.2, 1.6, PECTORAL_SWEEP_DEG),
        pectoral_droop=(-1.0, 2.5, PECTORAL_DROOP_DEG),
        pectoral_pitch=(-2.0, 3.5, PECTORAL_PITCH_DEG),
    )
    recorder.switch("pelvic", "Pelvic fins")
    declare(
        recorder,
        (when("pelvic", 1),),
        pelvic_length=(0.5, 1.6, PELVIC[0]),
        pelvic_sweep=(0.2, 1.5, PELVIC_SWEEP_DEG),
        pelvic_droop=(0.6, 1.35, PELVIC_DROOP_DEG),
    )
    recorder.switch("eyes", "Eyes that stand out")
    declare(recorder, (when("eyes", 1),), eye_size=(0.5, 1.5, 1.0))


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
