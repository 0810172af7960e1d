"""Models a swimming fish, bent sideways. Forward is +x.

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

LENGTH, HEIGHT, WIDTH, FIN_THICKNESS = 0.40, 0.125, 0.075, 0.006
TAIL_LENGTH, TAIL_HEIGHTS = 0.12, (0.034, 0.064, 0.104, 0.128)
SHORT_DORSAL = Outline(((-0.10, 0.02), (-0.03, 0.20), (0.03, 0.32), (0.09, 0.30), (0.15, 0.02)))
REAR_DORSAL = Outline(((-0.36, 0.02), (-0.30, 0.16), (-0.26, 0.24), (-0.21, 0.20), (-0.16, 0.02)))
LONG_DORSAL = Outline(((-0.34, 0.02), (-0.25, 0.22), (-0.10, 0.24), (0.06, 0.28), (0.15, 0.24), (0.22, 0.02)))
SHORT_ANAL = Outline(((-0.34, 0.02), (-0.29, 0.14), (-0.24, 0.26), (-0.19, 0.20), (-0.14, 0.02)))
LONG_ANAL = Outline(((-0.38, 0.02), (-0.30, 0.16), (-0.18, 0.20), (-0.06, 0.24), (0.0, 0.02)))
PECTORAL, PELVIC = (0.080, 0.052), (0.055, 0.034)
EYE = 0.016


def build() -> ProceduralModel:
    """Model the swimming fish."""
    recorder = Recorder(
        "fish_swimming", "fish", unit_m=1.0, description="A fish like a spindle, bent sideways as it swims."
    )
    _declare(recorder)
    fish = model_body(recorder, LENGTH, HEIGHT, WIDTH, FIN_THICKNESS)
    short, rear, long = (model_fin(recorder, fish, outline) for outline in (SHORT_DORSAL, REAR_DORSAL, LONG_DORSAL))
    anal, long_anal = (model_fin(recorder, fish, outline, below=True) for outline in (SHORT_ANAL, LONG_ANAL))
    size_fin(recorder, fish, (short, rear, long), "dorsal")
    size_fin(recorder, fish, (anal, long_anal), "anal", below=True)
    model_tail(recorder, fish, TAIL_LENGTH, TAIL_HEIGHTS)
    shape_body(recorder, fish)
    bend(recorder, fish)
    pectoral = model_side_fins(recorder, fish, at_side(recorder, fish, 6, "low"), *PECTORAL, "pectoral")
    pelvic = model_side_fins(recorder, fish, at_side(recorder, fish, 5, "low"), *PELVIC, "pelvic")
    eyes = model_eyes(recorder, fish, EYE)
    recorder.part("front dorsal fin", wholes(short), present_when=(when("dorsal", 1, 2),))
    recorder.part("rear dorsal fin", wholes(rear), present_when=(when("dorsal", 2),))
    recorder.part("long dorsal fin", wholes(long), present_when=(when("dorsal", 3),))
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
        body_height=(0.55, 2.1, HEIGHT),
        body_width=(0.35, 1.6, WIDTH),
        deepest=(-1.5, 1.5, PLACE * LENGTH),
        sag=(-1.5, 2.0, SAG * HEIGHT),
        snout_length=(0.5, 1.8, 1.0),
        snout_height=(0.5, 1.5, 1.0),
        head_tilt=(-2.0, 2.5, HEAD_TILT_DEG),
        stem_height=(0.5, 1.6, 1.0),
        tail_length=(0.6, 1.6, TAIL_LENGTH),
        tail_height=(0.6, 1.6, TAIL_HEIGHTS[-1]),
        tail_spread=(0.7, 1.6, 1.0),
        tail_fork=(-1.2, 3.0, 0.2 * TAIL_LENGTH),
        fin_thickness=(0.5, 2.5, 1.0),
        tail_bend=(-2.0, 2.0, BEND_DEG),
        body_bend=(-1.5, 1.5, BEND_DEG),
    )
    recorder.choice("dorsal", "Dorsal fins", ("one short fin", "two fins", "a long fin", "none"))
    dorsal = (when("dorsal", 1, 3),)
    declare(recorder, dorsal, dorsal_height=(0.4, 1.8, 0.3 * HEIGHT), dorsal_sweep=(-0.5, 1.5, SWEEP * LENGTH))
    recorder.choice("anal", "Anal fin", ("short", "long", "none"))
    anal = (when("anal", 1, 2),)
    declare(recorder, anal, anal_height=(0.4, 1.6, 0.25 * HEIGHT), anal_sweep=(-0.5, 1.5, SWEEP * LENGTH))
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
