"""Models a bird with a long neck and long legs: heron, stork, flamingo, crane, ostrich. Forward is +x.

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
from shapewright.modeling import ProceduralModel, Recorder

TRUNK = (
    Section(-0.200, 0.060, 0.056, (0.0, 0.020)),
    Section(-0.145, 0.130, 0.130, (0.0, 0.012)),
    Section(-0.040, 0.200, 0.220),
    Section(0.070, 0.200, 0.220),
    Section(0.150, 0.130, 0.150, (0.0, 0.020)),
)
NECK = (
    Section(0.190, 0.080, 0.090, (0.0, 0.030)),
    Section(0.250, 0.056, 0.060, (0.0, 0.030)),
    Section(0.320, 0.046, 0.050, (0.0, 0.030)),
    Section(0.390, 0.042, 0.044, (0.0, 0.030)),
    Section(0.460, 0.042, 0.044, (0.0, 0.030)),
    Section(0.520, 0.044, 0.046, (0.0, 0.030)),
)
HEAD = (
    Section(0.550, 0.062, 0.066, (0.0, 0.032)),
    Section(0.605, 0.052, 0.052, (0.0, 0.030)),
    Section(0.622, 0.028, 0.030, (0.0, 0.026)),
    Section(0.740, 0.008, 0.008, (0.0, 0.018)),
)
PITCH_DEG, RAISE_DEG, CURVE_DEG, TILT_DEG = 15.0, 60.0, 30.0, 45.0
TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS = 0.13, (0.060, 0.075, 0.090, 0.095), 0.020
WING = FoldedWing(length=0.34, height=0.16, thickness=0.055, inside=0.050)
LEG = Leg(length=0.52, thigh=0.055, shank=0.018, knee=0.42, toe=0.10, inside=(0.06, 0.030))


def build() -> ProceduralModel:
    """Model the long-legged bird."""
    recorder = Recorder("bird_wader", "bird", unit_m=1.0, description="A standing bird with a long neck and long legs.")
    recorder.symmetry(mirrors=("y",))
    _declare(recorder)
    bird = model_body(recorder, TRUNK, NECK, HEAD)
    bend_neck(recorder, bird, RAISE_DEG, CURVE_DEG, TILT_DEG)
    tail = model_tail(recorder, bird, TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS)
    wings = model_folded_wings(recorder, side_pair(recorder, bird, 3, (0.0, 1.0, 0.0)), WING)
    hold_upright(recorder, bird, PITCH_DEG, wholes(tail.loft, wings))
    model_legs(recorder, side_pair(recorder, bird, 2, (0.0, 1.0, -1.0)), LEG)
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare(
        recorder,
        body_length=(0.7, 1.5, 0.35),
        body_width=(0.6, 1.4, 0.20),
        body_height=(0.65, 1.4, 0.22),
        body_pitch=(-0.5, 3.0, PITCH_DEG),
        neck_length=(0.5, 1.7, 0.40),
        neck_thickness=(0.6, 1.7, 1.0),
        neck_raise=(0.2, 1.9, RAISE_DEG),
        neck_curve=(-1.0, 3.0, CURVE_DEG),
        head_tilt=(-0.3, 2.4, TILT_DEG),
        head_size=(0.7, 1.5, 1.0),
        beak_length=(0.3, 2.2, 0.118),
        beak_thickness=(0.6, 1.8, 1.0),
        tail_length=(0.4, 2.2, TAIL_LENGTH),
        tail_width=(0.6, 1.6, TAIL_WIDTHS[-1]),
        tail_spread=(0.4, 1.8, 1.0),
        tail_fork=(-3.0, 3.0, 0.1 * TAIL_LENGTH),
        tail_raise=(-10.0, 6.0, TAIL_RAISE_DEG),
        folded_length=(0.8, 1.5, WING.length),
        folded_height=(0.7, 1.35, WING.height),
        folded_thickness=(0.6, 1.5, WING.thickness),
        folded_spread=(-0.5, 3.0, FOLDED_SPREAD_DEG),
        folded_droop=(-2.0, 5.0, FOLDED_DROOP_DEG),
        leg_length=(0.45, 1.6, LEG.length),
        leg_thickness=(0.6, 1.9, 1.0),
        leg_swing=(-3.0, 3.0, LEG_SWING_DEG),
        leg_bend=(-1.5, 2.0, LEG_BEND_DEG),
        toe_length=(0.5, 1.5, LEG.toe),
    )


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
