"""Models a deep, flat fish with tall fins: angelfish, butterfly fish, sunfish. Forward is +x.

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

LENGTH, HEIGHT, WIDTH, FIN_THICKNESS = 0.30, 0.22, 0.050, 0.006
TAIL_LENGTH, TAIL_HEIGHTS = 0.09, (0.046, 0.070, 0.100, 0.120)
PROFILE = (
    (-0.500, 0.18, 0.20),
    (-0.420, 0.24, 0.34),
    (-0.300, 0.58, 0.60),
    (-0.120, 0.92, 0.90),
    (0.060, 1.00, 1.00),
    (0.220, 0.86, 0.98),
    (0.330, 0.62, 0.84),
    (0.420, 0.36, 0.58),
    (0.475, 0.20, 0.36),
    (0.505, 0.08, 0.14),
)
TALL_DORSAL = Outline(((-0.34, 0.10), (-0.27, 0.30), (-0.18, 0.48), (-0.05, 0.34), (0.10, 0.18), (0.28, 0.02)))
ROUND_DORSAL = Outline(((-0.40, 0.04), (-0.34, 0.18), (-0.20, 0.22), (-0.02, 0.18), (0.14, 0.14), (0.26, 0.02)))
TALL_ANAL = Outline(((-0.34, 0.10), (-0.28, 0.28), (-0.20, 0.44), (-0.09, 0.30), (0.04, 0.14), (0.18, 0.02)))
ROUND_ANAL = Outline(((-0.40, 0.04), (-0.34, 0.18), (-0.22, 0.22), (-0.10, 0.18), (0.04, 0.02)))
PECTORAL, PELVIC = (0.060, 0.046), (0.075, 0.028)
EYE = 0.016


def build() -> ProceduralModel:
    """Model the deep fish."""
    recorder = Recorder(
        "fish_disc", "fish", unit_m=1.0, description="A deep, flat fish with tall fins, like an angelfish."
    )
    recorder.symmetry(mirrors=("y",))
    _declare(recorder)
    fish = model_body(recorder, LENGTH, HEIGHT, WIDTH, FIN_THICKNESS, PROFILE)
    dorsals = [model_fin(recorder, fish, outline) for outline in (TALL_DORSAL, ROUND_DORSAL)]
    anals = [model_fin(recorder, fish, outline, below=True) for outline in (TALL_ANAL, ROUND_ANAL)]
    size_fin(recorder, fish, dorsals, "dorsal")
    size_fin(recorder, fish, anals, "anal", below=True)
    model_tail(recorder, fish, TAIL_LENGTH, TAIL_HEIGHTS)
    shape_body(recorder, fish)
    pectoral = model_side_fins(recorder, fish, at_side(recorder, fish, 6, "middle"), *PECTORAL, "pectoral")
    pelvic = model_side_fins(recorder, fish, at_side(recorder, fish, 5, "low"), *PELVIC, "pelvic")
    eyes = model_eyes(recorder, fish, EYE)
    recorder.part("tall fins", wholes(dorsals[0], anals[0]), present_when=(when("fins", 1),))
    recorder.part("round fins", wholes(dorsals[1], anals[1]), present_when=(when("fins", 2),))
    recorder.part("pectoral fins", wholes(pectoral), present_when=(when("pectoral", 1),))
    recorder.part("pelvic fins", wholes(pelvic), present_when=(when("pelvic", 1),))
    recorder.part("eyes", wholes(eyes), present_when=(when("eyes", 1),))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare(
        recorder,
        body_length=(0.8, 1.4, LENGTH),
        body_height=(0.6, 1.5, HEIGHT),
        body_width=(0.4, 1.8, WIDTH),
        deepest=(-1.2, 1.2, PLACE * LENGTH),
        sag=(-1.0, 1.5, SAG * HEIGHT),
        snout_length=(0.5, 1.8, 1.0),
        snout_height=(0.5, 1.5, 1.0),
        head_tilt=(-2.0, 2.5, HEAD_TILT_DEG),
        stem_height=(0.6, 1.8, 1.0),
        tail_length=(0.6, 1.6, TAIL_LENGTH),
        tail_height=(0.5, 1.8, TAIL_HEIGHTS[-1]),
        tail_spread=(0.7, 1.6, 1.0),
        tail_fork=(-1.2, 4.0, 0.2 * TAIL_LENGTH),
        fin_thickness=(0.5, 2.5, 1.0),
    )
    recorder.choice("fins", "Dorsal and anal fin", ("tall", "round"))
    declare(
        recorder,
        dorsal_height=(0.4, 1.8, 0.4 * HEIGHT),
        dorsal_sweep=(-0.5, 4.0, SWEEP * LENGTH),
        anal_height=(0.4, 1.8, 0.4 * HEIGHT),
        anal_sweep=(-0.5, 4.0, SWEEP * LENGTH),
    )
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
