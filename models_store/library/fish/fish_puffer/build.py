"""Models a plump fish with small, thick fins: pufferfish, goldfish, toys like a blimp. Forward is +x.

Body and the fins of its middle plane are sketched at rest and get their proportions together; the paired fins are
hung on the finished body.
"""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.fish.fishes import (
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

LENGTH, HEIGHT, WIDTH, FIN_THICKNESS = 0.30, 0.170, 0.165, 0.018
TAIL_LENGTH, TAIL_HEIGHTS = 0.09, (0.046, 0.064, 0.090, 0.104)
PROFILE = (
    (-0.500, 0.22, 0.14),
    (-0.430, 0.34, 0.28),
    (-0.300, 0.62, 0.56),
    (-0.120, 0.90, 0.86),
    (0.060, 1.00, 1.00),
    (0.220, 0.98, 1.00),
    (0.340, 0.86, 0.90),
    (0.430, 0.64, 0.68),
    (0.480, 0.42, 0.44),
    (0.505, 0.18, 0.20),
)
SHORT_DORSAL = Outline(((-0.16, 0.02), (-0.09, 0.24), (-0.02, 0.34), (0.06, 0.28), (0.13, 0.02)))
LONG_DORSAL = Outline(((-0.40, 0.04), (-0.32, 0.32), (-0.20, 0.40), (-0.04, 0.34), (0.10, 0.26), (0.22, 0.02)))
SHORT_ANAL = Outline(((-0.36, 0.02), (-0.30, 0.18), (-0.24, 0.26), (-0.17, 0.20), (-0.10, 0.02)))
PECTORAL, PELVIC = (0.075, 0.050), (0.050, 0.036)
EYE = 0.030


def build() -> ProceduralModel:
    """Model the plump fish."""
    recorder = Recorder(
        "fish_puffer", "fish", unit_m=1.0, description="A plump fish with small, thick fins, like a blimp."
    )
    recorder.symmetry(mirrors=("y",))
    _declare(recorder)
    fish = model_body(recorder, LENGTH, HEIGHT, WIDTH, FIN_THICKNESS, PROFILE)
    short, long = (model_fin(recorder, fish, outline) for outline in (SHORT_DORSAL, LONG_DORSAL))
    anal = model_fin(recorder, fish, SHORT_ANAL, below=True)
    size_fin(recorder, fish, (short, long), "dorsal")
    size_fin(recorder, fish, (anal,), "anal", below=True)
    model_tail(recorder, fish, TAIL_LENGTH, TAIL_HEIGHTS)
    shape_body(recorder, fish)
    pectoral = model_side_fins(recorder, fish, at_side(recorder, fish, 6, "middle"), *PECTORAL, "pectoral")
    pelvic = model_side_fins(recorder, fish, at_side(recorder, fish, 5, "low"), *PELVIC, "pelvic")
    eyes = model_eyes(recorder, fish, EYE)
    recorder.part("short dorsal fin", wholes(short), present_when=(when("dorsal", 1),))
    recorder.part("long dorsal fin", wholes(long), present_when=(when("dorsal", 2),))
    recorder.part("anal fin", wholes(anal), present_when=(when("anal", 1),))
    recorder.part("pectoral fins", wholes(pectoral), present_when=(when("pectoral", 1),))
    recorder.part("pelvic fins", wholes(pelvic), present_when=(when("pelvic", 1),))
    recorder.part("eyes", wholes(eyes), present_when=(when("eyes", 1),))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare(
        recorder,
        body_length=(0.75, 1.5, LENGTH),
        body_height=(0.65, 1.4, HEIGHT),
        body_width=(0.5, 1.4, WIDTH),
        deepest=(-1.5, 1.5, PLACE * LENGTH),
        sag=(-1.5, 1.5, SAG * HEIGHT),
        snout_length=(0.5, 1.8, 1.0),
        snout_height=(0.6, 1.6, 1.0),
        head_tilt=(-2.0, 2.5, HEAD_TILT_DEG),
        stem_height=(0.6, 1.8, 1.0),
        tail_length=(0.6, 1.6, TAIL_LENGTH),
        tail_height=(0.5, 1.8, TAIL_HEIGHTS[-1]),
        tail_spread=(0.7, 1.6, 1.0),
        tail_fork=(-1.2, 3.0, 0.2 * TAIL_LENGTH),
        fin_thickness=(0.3, 2.2, 1.0),
    )
    recorder.choice("dorsal", "Dorsal fin", ("short", "long", "none"))
    dorsal = (when("dorsal", 1, 2),)
    declare(recorder, dorsal, dorsal_height=(0.4, 1.8, 0.3 * HEIGHT), dorsal_sweep=(-0.5, 1.5, SWEEP * LENGTH))
    recorder.switch("anal", "Anal fin")
    anal = (when("anal", 1),)
    declare(recorder, anal, anal_height=(0.4, 1.6, 0.25 * HEIGHT), anal_sweep=(-0.5, 1.5, SWEEP * LENGTH))
    recorder.switch("pectoral", "Pectoral fins")
    declare(
        recorder,
        (when("pectoral", 1),),
        pectoral_length=(0.5, 1.8, PECTORAL[0]),
        pectoral_width=(0.6, 1.5, 1.0),
        pectoral_sweep=(0.2, 1.6, PECTORAL_SWEEP_DEG),
        pectoral_droop=(-1.5, 3.0, PECTORAL_DROOP_DEG),
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
