"""Models a flying bird: wings spread to +y and -y, tail behind, legs hanging or not there. Forward is +x.

The wings of this one are held nearly level, as when gliding.
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
    Section(-0.16, 0.035, 0.028, (0.0, 0.014)),
    Section(-0.11, 0.066, 0.056, (0.0, 0.008)),
    Section(-0.035, 0.105, 0.100),
    Section(0.045, 0.115, 0.112),
    Section(0.105, 0.088, 0.092, (0.0, 0.008)),
)
NECK = (
    Section(0.140, 0.066, 0.068, (0.0, 0.014)),
    Section(0.165, 0.056, 0.056, (0.0, 0.018)),
)
HEAD = (
    Section(0.190, 0.060, 0.064, (0.0, 0.020)),
    Section(0.222, 0.050, 0.050, (0.0, 0.019)),
    Section(0.238, 0.024, 0.026, (0.0, 0.014)),
    Section(0.280, 0.006, 0.007, (0.0, 0.006)),
)
TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS = 0.22, (0.045, 0.075, 0.110, 0.125), 0.010
SPAN = 1.0
CHORD = 0.17
WING = (
    Rib(-0.035, -0.095, 0.060, 0.024),
    Rib(0.030, -0.100, 0.066, 0.022),
    Rib(0.110, -0.098, 0.072, 0.019),
    Rib(0.190, -0.092, 0.078, 0.016),
    Rib(0.270, -0.084, 0.070, 0.014),
    Rib(0.345, -0.072, 0.052, 0.012),
    Rib(0.405, -0.060, 0.030, 0.010),
    Rib(0.440, -0.044, 0.004, 0.008),
)
NECK_RAISE_DEG, NECK_CURVE_DEG, HEAD_TILT_DEG = 14.0, 10.0, 8.0
LEG = Leg(length=0.13, thigh=0.030, shank=0.011, knee=0.4, toe=0.05, inside=(0.03, 0.012))


def build() -> ProceduralModel:
    """Model the flying bird."""
    recorder = Recorder(
        "bird", "bird", unit_m=1.0, description="A flying bird with its wings spread; with or without legs."
    )
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
        wing_span=(0.65, 1.35, SPAN),
        wing_chord=(0.6, 1.5, CHORD),
        hand_chord=(0.6, 1.35, 1.0),
        tip_chord=(0.2, 2.2, 1.0),
        wing_thickness=(0.5, 1.8, 1.0),
        wing_sweep=(-1.5, 3.5, SWEEP_DEG),
        hand_sweep=(-1.0, 4.5, HAND_SWEEP_DEG),
        dihedral=(-2.0, 2.5, DIHEDRAL_DEG),
        wing_droop=(-1.0, 2.5, DROOP_DEG),
        wing_pitch=(-2.0, 3.5, PITCH_DEG),
    )
    declare(
        recorder,
        body_length=(0.65, 1.5, 0.265),
        body_width=(0.4, 1.6, 0.115),
        body_height=(0.4, 1.6, 0.112),
        neck_length=(0.4, 3.0, 0.085),
        neck_thickness=(0.6, 1.2, 1.0),
        neck_raise=(-2.0, 3.0, NECK_RAISE_DEG),
        neck_curve=(-1.0, 3.0, NECK_CURVE_DEG),
        head_tilt=(-1.0, 3.0, HEAD_TILT_DEG),
        head_size=(0.7, 1.4, 1.0),
        beak_length=(0.4, 3.0, 0.042),
        beak_thickness=(0.6, 1.6, 1.0),
        tail_length=(0.35, 2.0, TAIL_LENGTH),
        tail_width=(0.5, 2.0, TAIL_WIDTHS[-1]),
        tail_spread=(0.4, 1.8, 1.0),
        tail_fork=(-4.0, 8.0, 0.1 * TAIL_LENGTH),
        tail_raise=(-6.0, 6.0, TAIL_RAISE_DEG),
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
