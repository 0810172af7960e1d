"""Models a fish with large, pointed fins like blades: shark, tuna. Forward is +x.

Body and the fins of its middle plane are sketched at rest and get their proportions together; the paired fins are
hung on the finished body.
"""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.fish.fishes import (
    BLADE,
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
    model_fin,
    model_side_fins,
    model_tail,
    shape_body,
    size_fin,
    wholes,
)
from shapewright.modeling import ProceduralModel, Recorder, when

LENGTH, HEIGHT, WIDTH, FIN_THICKNESS = 0.46, 0.105, 0.095, 0.007
TAIL_LENGTH, TAIL_HEIGHTS = 0.10, (0.030, 0.060, 0.115, 0.165)
TAIL_RISE = 0.03
PROFILE = (
    (-0.500, 0.20, 0.16),
    (-0.410, 0.26, 0.24),
    (-0.270, 0.48, 0.46),
    (-0.090, 0.80, 0.76),
    (0.080, 0.98, 0.96),
    (0.220, 1.00, 1.00),
    (0.330, 0.86, 0.92),
    (0.420, 0.60, 0.72),
    (0.475, 0.34, 0.46),
    (0.505, 0.10, 0.16),
)
DORSAL = Outline(((-0.10, 0.02), (-0.06, 0.42), (-0.03, 0.52), (0.05, 0.30), (0.15, 0.02)))
SECOND = Outline(((-0.38, 0.02), (-0.36, 0.14), (-0.34, 0.18), (-0.30, 0.10), (-0.26, 0.02)))
ANAL = Outline(((-0.40, 0.02), (-0.37, 0.14), (-0.34, 0.18), (-0.30, 0.10), (-0.26, 0.02)))
PECTORAL, PELVIC = (0.135, 0.070), (0.060, 0.045)


def build() -> ProceduralModel:
    """Model the shark."""
    recorder = Recorder(
        "fish_shark", "fish", unit_m=1.0, description="A fish with large, pointed fins: a shark, a tuna."
    )
    recorder.symmetry(mirrors=("y",))
    _declare(recorder)
    fish = model_body(recorder, LENGTH, HEIGHT, WIDTH, FIN_THICKNESS, PROFILE)
    dorsal, second = (model_fin(recorder, fish, outline) for outline in (DORSAL, SECOND))
    anal = model_fin(recorder, fish, ANAL, below=True)
    size_fin(recorder, fish, (dorsal,), "dorsal")
    size_fin(recorder, fish, (anal,), "anal", below=True)
    model_tail(recorder, fish, TAIL_LENGTH, TAIL_HEIGHTS, rise=TAIL_RISE)
    shape_body(recorder, fish)
    model_side_fins(recorder, fish, at_side(recorder, fish, 5, "low"), *PECTORAL, "pectoral", BLADE)
    pelvic = model_side_fins(recorder, fish, at_side(recorder, fish, 3, "low"), *PELVIC, "pelvic", BLADE)
    recorder.part("second dorsal fin", wholes(second), present_when=(when("second_dorsal", 1),))
    recorder.part("anal fin", wholes(anal), present_when=(when("anal", 1),))
    recorder.part("pelvic fins", wholes(pelvic), present_when=(when("pelvic", 1),))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare(
        recorder,
        body_length=(0.7, 1.3, LENGTH),
        body_height=(0.7, 1.9, HEIGHT),
        body_width=(0.6, 1.8, WIDTH),
        deepest=(-1.5, 1.5, PLACE * LENGTH),
        sag=(-1.5, 1.5, SAG * HEIGHT),
        snout_length=(0.5, 1.8, 1.0),
        snout_height=(0.6, 1.6, 1.0),
        head_tilt=(-2.0, 2.5, HEAD_TILT_DEG),
        stem_height=(0.6, 1.8, 1.0),
        tail_length=(0.6, 1.6, TAIL_LENGTH),
        tail_height=(0.6, 1.6, TAIL_HEIGHTS[-1]),
        tail_spread=(0.7, 1.5, 1.0),
        tail_fork=(0.5, 3.5, 0.2 * TAIL_LENGTH),
        tail_lobe=(-0.5, 2.5, TAIL_RISE),
        fin_thickness=(0.4, 2.2, 1.0),
        dorsal_height=(0.4, 1.7, 0.5 * HEIGHT),
        dorsal_sweep=(-0.3, 1.8, SWEEP * LENGTH),
    )
    recorder.switch("second_dorsal", "Second dorsal fin")
    recorder.switch("anal", "Anal fin")
    anal = (when("anal", 1),)
    declare(recorder, anal, anal_height=(0.4, 2.0, 0.18 * HEIGHT), anal_sweep=(-0.3, 1.5, SWEEP * LENGTH))
    declare(
        recorder,
        pectoral_length=(0.5, 1.8, PECTORAL[0]),
        pectoral_width=(0.6, 1.7, 1.0),
        pectoral_sweep=(0.2, 1.5, PECTORAL_SWEEP_DEG),
        pectoral_droop=(-1.0, 2.8, PECTORAL_DROOP_DEG),
        pectoral_pitch=(-1.0, 1.5, PECTORAL_PITCH_DEG),
    )
    recorder.switch("pelvic", "Pelvic fins")
    declare(
        recorder,
        (when("pelvic", 1),),
        pelvic_length=(0.5, 1.6, PELVIC[0]),
        pelvic_sweep=(0.3, 1.5, PELVIC_SWEEP_DEG),
        pelvic_droop=(0.3, 1.2, PELVIC_DROOP_DEG),
    )


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
