"""Models a flapping bird: wings to +y and -y, tail behind, legs hanging or not there. Forward is +x.

This one beats its broad wings: they are raised, lowered, pitched or swept back far.
"""

from pathlib import Path

from models_store.library.aids.fins import Rib
from models_store.library.aids.loft import Section
from models_store.library.author import publish
from models_store.library.bird.bird_wings import (
    DIHEDRAL_DEG,
    DROOP_DEG,
    HAND_SWEEP_DEG,
    PITCH_DEG,
    SWEEP_DEG,
    declare_wings,
    model_wings,
)
from models_store.library.bird.birds import (
    LEG_BEND_DEG,
    LEG_SWING_DEG,
    TAIL_RAISE_DEG,
    Leg,
    bend_neck,
    declare,
    model_body,
    model_legs,
    model_tail,
    side_pair,
    wholes,
)
from shapewright.modeling import ProceduralModel, Recorder, when

TRUNK = (
    Section(-0.200, 0.060, 0.050, (0.0, 0.020)),
    Section(-0.130, 0.110, 0.100, (0.0, 0.010)),
    Section(-0.040, 0.160, 0.160),
    Section(0.060, 0.170, 0.172),
    Section(0.130, 0.130, 0.136, (0.0, 0.010)),
)
NECK = (
    Section(0.170, 0.100, 0.104, (0.0, 0.018)),
    Section(0.200, 0.088, 0.090, (0.0, 0.022)),
)
HEAD = (
    Section(0.230, 0.094, 0.098, (0.0, 0.024)),
    Section(0.275, 0.076, 0.076, (0.0, 0.022)),
    Section(0.292, 0.034, 0.036, (0.0, 0.016)),
    Section(0.340, 0.008, 0.009, (0.0, 0.008)),
)
TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS = 0.26, (0.080, 0.150, 0.210, 0.210), 0.016
SPAN = 1.0
CHORD = 0.27
WING = (
    Rib(-0.050, -0.150, 0.090, 0.036),
    Rib(0.030, -0.165, 0.096, 0.032),
    Rib(0.110, -0.170, 0.100, 0.028),
    Rib(0.190, -0.165, 0.104, 0.024),
    Rib(0.260, -0.150, 0.096, 0.020),
    Rib(0.325, -0.125, 0.076, 0.016),
    Rib(0.375, -0.100, 0.050, 0.013),
    Rib(0.410, -0.074, 0.016, 0.010),
)
NECK_RAISE_DEG, NECK_CURVE_DEG, HEAD_TILT_DEG = 14.0, 10.0, 8.0
LEG = Leg(length=0.16, thigh=0.045, shank=0.014, knee=0.4, toe=0.065, inside=(0.04, 0.018))


def build() -> ProceduralModel:
    """Model the flapping bird."""
    recorder = Recorder("bird_flapping", "bird", unit_m=1.0, description="A flying bird that beats its broad wings.")
    recorder.symmetry(mirrors=("y",))
    _declare(recorder)
    bird = model_body(recorder, TRUNK, NECK, HEAD)
    bend_neck(recorder, bird, NECK_RAISE_DEG, NECK_CURVE_DEG, HEAD_TILT_DEG)
    model_tail(recorder, bird, TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS)
    model_wings(recorder, bird, WING)
    limbs = model_legs(recorder, side_pair(recorder, bird, 2, (0.0, 1.0, -1.0)), LEG)
    recorder.part("legs", wholes(*limbs), present_when=(when("legs", 1),))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare_wings(
        recorder,
        wing_span=(0.6, 1.35, SPAN),
        wing_chord=(0.55, 1.35, CHORD),
        hand_chord=(0.6, 1.35, 1.0),
        tip_chord=(0.3, 1.8, 1.0),
        wing_thickness=(0.4, 2.6, 1.0),
        wing_sweep=(-2.0, 6.5, SWEEP_DEG),
        hand_sweep=(-1.0, 4.0, HAND_SWEEP_DEG),
        dihedral=(-6.0, 7.5, DIHEDRAL_DEG),
        wing_droop=(-1.5, 3.0, DROOP_DEG),
        wing_pitch=(-3.0, 6.0, PITCH_DEG),
    )
    declare(
        recorder,
        body_length=(0.6, 1.4, 0.33),
        body_width=(0.5, 1.6, 0.17),
        body_height=(0.5, 1.6, 0.172),
        neck_length=(0.5, 2.5, 0.11),
        neck_thickness=(0.65, 1.15, 1.0),
        neck_raise=(-2.0, 4.0, NECK_RAISE_DEG),
        neck_curve=(-1.0, 4.0, NECK_CURVE_DEG),
        head_tilt=(-1.0, 4.0, HEAD_TILT_DEG),
        head_size=(0.7, 1.35, 1.0),
        beak_length=(0.4, 2.5, 0.048),
        beak_thickness=(0.6, 1.6, 1.0),
        tail_length=(0.35, 1.8, TAIL_LENGTH),
        tail_width=(0.4, 1.6, TAIL_WIDTHS[-1]),
        tail_spread=(0.4, 1.8, 1.0),
        tail_fork=(-4.0, 4.0, 0.1 * TAIL_LENGTH),
        tail_raise=(-9.0, 9.0, TAIL_RAISE_DEG),
    )
    recorder.switch("legs", "Legs")
    declare(
        recorder,
        (when("legs", 1),),
        leg_length=(0.4, 2.2, LEG.length),
        leg_thickness=(0.6, 1.8, 1.0),
        leg_swing=(-5.0, 12.0, LEG_SWING_DEG),
        leg_bend=(0.0, 5.0, LEG_BEND_DEG),
        toe_length=(0.5, 1.6, LEG.toe),
    )


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
