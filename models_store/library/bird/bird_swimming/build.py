"""Models a duck, goose or swan, swimming (without legs) or standing on short ones. Forward is +x.

Body, tail and wings are modelled level and tipped up together; the legs are hung on the belly afterwards, so they
stay upright.
"""

from pathlib import Path

from models_store.library.aids.loft import Section
from models_store.library.author import publish
from models_store.library.bird.birds import (
    FOLDED_DROOP_DEG,
    FOLDED_SPREAD_DEG,
    LEG_BEND_DEG,
    LEG_SWING_DEG,
    TAIL_RAISE_DEG,
    FoldedWing,
    Leg,
    bend_neck,
    declare,
    hold_upright,
    model_body,
    model_folded_wings,
    model_legs,
    model_tail,
    side_pair,
    wholes,
)
from shapewright.modeling import ProceduralModel, Recorder, when

TRUNK = (
    Section(-0.200, 0.070, 0.040, (0.0, 0.060)),
    Section(-0.140, 0.150, 0.120, (0.0, 0.030)),
    Section(-0.030, 0.210, 0.190),
    Section(0.080, 0.190, 0.185),
    Section(0.150, 0.110, 0.130, (0.0, 0.025)),
)
NECK = (
    Section(0.185, 0.080, 0.090, (0.0, 0.040)),
    Section(0.225, 0.064, 0.068, (0.0, 0.045)),
    Section(0.265, 0.056, 0.060, (0.0, 0.045)),
    Section(0.305, 0.056, 0.060, (0.0, 0.045)),
)
HEAD = (
    Section(0.340, 0.080, 0.088, (0.0, 0.048)),
    Section(0.395, 0.066, 0.064, (0.0, 0.042)),
    Section(0.412, 0.040, 0.034, (0.0, 0.034)),
    Section(0.480, 0.040, 0.012, (0.0, 0.020)),
)
PITCH_DEG, RAISE_DEG, CURVE_DEG, TILT_DEG = 8.0, 70.0, 20.0, 60.0
TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS = 0.10, (0.070, 0.075, 0.070, 0.050), 0.022
WING = FoldedWing(length=0.33, height=0.14, thickness=0.060, inside=0.060)
LEG = Leg(length=0.16, thigh=0.050, shank=0.018, knee=0.35, toe=0.075, inside=(0.05, 0.030))


def build() -> ProceduralModel:
    """Model the water bird."""
    recorder = Recorder(
        "bird_swimming", "bird", unit_m=1.0, description="A duck, goose or swan; swimming, or standing on short legs."
    )
    recorder.symmetry(mirrors=("y",))
    _declare(recorder)
    bird = model_body(recorder, TRUNK, NECK, HEAD)
    bend_neck(recorder, bird, RAISE_DEG, CURVE_DEG, TILT_DEG)
    tail = model_tail(recorder, bird, TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS)
    wings = model_folded_wings(recorder, side_pair(recorder, bird, 3, (0.0, 1.0, 0.0)), WING)
    hold_upright(recorder, bird, PITCH_DEG, wholes(tail.loft, wings))
    limbs = model_legs(recorder, side_pair(recorder, bird, 2, (0.0, 1.0, -1.0)), LEG)
    recorder.part("legs", wholes(*limbs), present_when=(when("legs", 1),))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare(
        recorder,
        body_length=(0.7, 1.4, 0.35),
        body_width=(0.65, 1.4, 0.21),
        body_height=(0.65, 1.4, 0.19),
        neck_length=(0.4, 3.4, 0.155),
        neck_thickness=(0.6, 1.3, 1.0),
        neck_raise=(0.3, 1.6, RAISE_DEG),
        neck_curve=(-1.5, 3.0, CURVE_DEG),
        head_tilt=(0.3, 1.8, TILT_DEG),
        head_size=(0.65, 1.4, 1.0),
        beak_length=(0.5, 1.7, 0.068),
        beak_thickness=(0.6, 1.4, 1.0),
        tail_length=(0.4, 2.0, TAIL_LENGTH),
        tail_width=(0.6, 1.6, TAIL_WIDTHS[-1]),
        tail_spread=(0.5, 2.0, 1.0),
        tail_fork=(-3.0, 3.0, 0.1 * TAIL_LENGTH),
        tail_raise=(-6.0, 9.0, TAIL_RAISE_DEG),
        folded_length=(0.75, 1.35, WING.length),
        folded_height=(0.7, 1.3, WING.height),
        folded_thickness=(0.6, 1.4, WING.thickness),
        folded_spread=(-0.5, 3.0, FOLDED_SPREAD_DEG),
        folded_droop=(-3.0, 2.0, FOLDED_DROOP_DEG),
    )
    recorder.switch("legs", "Legs")
    declare(
        recorder,
        (when("legs", 1),),
        body_pitch=(-1.0, 4.0, PITCH_DEG),  # without legs a turn of the whole bird
        leg_length=(0.5, 1.6, LEG.length),
        leg_thickness=(0.7, 1.6, 1.0),
        leg_swing=(-3.0, 4.0, LEG_SWING_DEG),
        leg_bend=(-2.0, 2.0, LEG_BEND_DEG),
        toe_length=(0.6, 1.5, LEG.toe),
    )


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
