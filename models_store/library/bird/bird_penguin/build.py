"""Models a bird that stands upright on short legs: penguin, owl, puffin. Forward is +x.

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
    Section(-0.240, 0.090, 0.080, (0.0, 0.030)),
    Section(-0.180, 0.180, 0.165, (0.0, 0.014)),
    Section(-0.060, 0.250, 0.235),
    Section(0.090, 0.245, 0.225),
    Section(0.200, 0.180, 0.170, (0.0, 0.008)),
)
NECK = (
    Section(0.250, 0.128, 0.126, (0.0, 0.012)),
    Section(0.285, 0.118, 0.116, (0.0, 0.014)),
)
HEAD = (
    Section(0.325, 0.130, 0.130, (0.0, 0.014)),
    Section(0.390, 0.104, 0.104, (0.0, 0.012)),
    Section(0.412, 0.042, 0.046, (0.0, 0.006)),
    Section(0.480, 0.010, 0.012, (0.0, -0.004)),
)
PITCH_DEG, RAISE_DEG, CURVE_DEG, TILT_DEG = 75.0, 8.0, 15.0, 70.0
TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS = 0.14, (0.080, 0.090, 0.080, 0.050), 0.024
WING = FoldedWing(length=0.36, height=0.110, thickness=0.030, inside=0.040)
LEG = Leg(length=0.17, thigh=0.060, shank=0.030, knee=0.4, toe=0.10, inside=(0.06, 0.035))


def build() -> ProceduralModel:
    """Model the upright bird."""
    recorder = Recorder(
        "bird_penguin", "bird", unit_m=1.0, description="A bird upright on short legs: penguin, owl, puffin."
    )
    recorder.symmetry(mirrors=("y",))
    _declare(recorder)
    bird = model_body(recorder, TRUNK, NECK, HEAD)
    bend_neck(recorder, bird, RAISE_DEG, CURVE_DEG, TILT_DEG)
    tail = model_tail(recorder, bird, TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS)
    wings = model_folded_wings(recorder, side_pair(recorder, bird, 3, (0.0, 1.0, 0.0)), WING)
    hold_upright(recorder, bird, PITCH_DEG, wholes(tail.loft, wings))
    model_legs(recorder, side_pair(recorder, bird, 1, (0.0, 1.0, -1.0)), LEG)
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare(
        recorder,
        body_length=(0.65, 1.5, 0.44),
        body_width=(0.65, 1.35, 0.25),
        body_height=(0.65, 1.35, 0.235),
        body_pitch=(0.75, 1.25, PITCH_DEG),
        neck_length=(0.5, 2.0, 0.125),
        neck_thickness=(0.7, 1.3, 1.0),
        neck_raise=(-2.0, 2.0, RAISE_DEG),
        neck_curve=(-0.5, 2.0, CURVE_DEG),
        head_tilt=(0.3, 1.3, TILT_DEG),
        head_size=(0.7, 1.5, 1.0),
        beak_length=(0.3, 2.0, 0.068),
        beak_thickness=(0.6, 2.0, 1.0),
        tail_length=(0.5, 2.0, TAIL_LENGTH),
        tail_width=(0.6, 1.8, TAIL_WIDTHS[-1]),
        tail_spread=(0.5, 1.8, 1.0),
        tail_fork=(-3.0, 3.0, 0.1 * TAIL_LENGTH),
        tail_raise=(-4.0, 8.0, TAIL_RAISE_DEG),
        folded_length=(0.7, 1.4, WING.length),
        folded_height=(0.6, 1.8, WING.height),
        folded_thickness=(0.6, 2.0, WING.thickness),
        folded_spread=(-0.5, 6.0, FOLDED_SPREAD_DEG),
        folded_droop=(-3.0, 3.0, FOLDED_DROOP_DEG),
        leg_length=(0.7, 1.5, LEG.length),
        leg_thickness=(0.7, 1.5, 1.0),
        leg_swing=(-2.0, 2.0, LEG_SWING_DEG),
        leg_bend=(-1.0, 1.5, LEG_BEND_DEG),
        toe_length=(0.6, 1.4, LEG.toe),
    )


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
