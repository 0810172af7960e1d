"""Models a perched bird: body tipped up, wings folded against its sides, two legs with feet. Forward is +x.

Body, tail and wings are modelled level and tipped up together; the legs are hung on the belly afterwards, so they
stay upright.
"""

from pathlib import Path

from models_store.library.aids.fins import Rib, plate
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.bird.birds import (
    FOLDED_DROOP_DEG,
    FOLDED_SPREAD_DEG,
    LEG_BEND_DEG,
    LEG_SWING_DEG,
    TAIL_RAISE_DEG,
    Bird,
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
from shapewright.modeling import ProceduralModel, Recorder, Target, when

TRUNK = (
    Section(-0.110, 0.040, 0.036, (0.0, 0.020)),
    Section(-0.075, 0.076, 0.076, (0.0, 0.012)),
    Section(-0.020, 0.118, 0.124),
    Section(0.040, 0.124, 0.132),
    Section(0.085, 0.096, 0.104, (0.0, 0.010)),
)
NECK = (
    Section(0.108, 0.078, 0.082, (0.0, 0.014)),
    Section(0.128, 0.072, 0.074, (0.0, 0.016)),
)
HEAD = (
    Section(0.150, 0.078, 0.080, (0.0, 0.016)),
    Section(0.186, 0.064, 0.064, (0.0, 0.015)),
    Section(0.200, 0.026, 0.028, (0.0, 0.012)),
    Section(0.234, 0.006, 0.006, (0.0, 0.006)),
)
PITCH_DEG, RAISE_DEG, CURVE_DEG, TILT_DEG = 30.0, 30.0, 15.0, 30.0
TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS = 0.15, (0.042, 0.050, 0.058, 0.062), 0.012
WING = FoldedWing(length=0.20, height=0.085, thickness=0.030, inside=0.040)
LEG = Leg(length=0.12, thigh=0.026, shank=0.008, knee=0.3, toe=0.045, inside=(0.03, 0.016))
CREST = 0.045


def build() -> ProceduralModel:
    """Model the perched bird."""
    recorder = Recorder(
        "bird_standing",
        "bird",
        unit_m=1.0,
        description="A bird that stands with folded wings: songbird, pigeon, eagle, pheasant.",
    )
    recorder.symmetry(mirrors=("y",))
    _declare(recorder)
    bird = model_body(recorder, TRUNK, NECK, HEAD)
    bend_neck(recorder, bird, RAISE_DEG, CURVE_DEG, TILT_DEG)
    crest = _crest(recorder, bird)
    tail = model_tail(recorder, bird, TAIL_LENGTH, TAIL_WIDTHS, TAIL_THICKNESS)
    wings = model_folded_wings(recorder, side_pair(recorder, bird, 3, (0.0, 1.0, 0.0)), WING)
    hold_upright(recorder, bird, PITCH_DEG, wholes(crest, tail.loft, wings))
    limbs = model_legs(recorder, side_pair(recorder, bird, 2, (0.0, 1.0, -1.0)), LEG)
    recorder.part("crest", wholes(crest), present_when=(when("crest", 1),))
    recorder.part("legs", wholes(*limbs), present_when=(when("legs", 1),))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    declare(
        recorder,
        body_length=(0.7, 1.6, 0.195),
        body_width=(0.6, 1.4, 0.124),
        body_height=(0.6, 1.35, 0.132),
        neck_length=(0.5, 4.0, 0.065),
        neck_thickness=(0.5, 1.15, 1.0),
        neck_raise=(-0.3, 2.4, RAISE_DEG),
        neck_curve=(-0.5, 4.0, CURVE_DEG),
        head_tilt=(-0.3, 2.2, TILT_DEG),
        head_size=(0.65, 1.35, 1.0),
        beak_length=(0.4, 3.0, 0.034),
        beak_thickness=(0.6, 1.8, 1.0),
        tail_length=(0.3, 2.4, TAIL_LENGTH),
        tail_width=(0.5, 2.2, TAIL_WIDTHS[-1]),
        tail_spread=(0.5, 3.5, 1.0),
        tail_fork=(-4.0, 4.0, 0.1 * TAIL_LENGTH),
        tail_raise=(-5.0, 17.0, TAIL_RAISE_DEG),
        folded_length=(0.75, 1.5, WING.length),
        folded_height=(0.7, 1.4, WING.height),
        folded_thickness=(0.5, 1.6, WING.thickness),
        folded_spread=(-0.5, 6.0, FOLDED_SPREAD_DEG),
        folded_droop=(-2.0, 5.0, FOLDED_DROOP_DEG),
    )
    recorder.switch("crest", "Crest")
    recorder.parameter(
        "crest_length", "Crest length", 0.5, 2.0, unit="m", base_value=CREST, active_when=(when("crest", 1),)
    )
    recorder.switch("legs", "Legs")
    declare(
        recorder,
        (when("legs", 1),),
        body_pitch=(0.0, 2.2, PITCH_DEG),  # without legs a turn of the whole bird
        leg_length=(0.35, 2.2, LEG.length),
        leg_thickness=(0.7, 2.0, 1.0),
        leg_swing=(-4.0, 4.0, LEG_SWING_DEG),
        leg_bend=(-3.0, 3.0, LEG_BEND_DEG),
        toe_length=(0.5, 1.7, LEG.toe),
    )


def _crest(recorder: Recorder, bird: Bird) -> Loft:
    """A comb of feathers in the middle of the head, upwards and back."""
    head = Target(bird.body.rings[bird.first_head][0], "world")
    stations = ((0.0, 0.5), (0.5, 0.6), (1.0, 0.5), (1.6, 0.3))
    ribs = [
        Rib(a * CREST, -0.5 * w * CREST - 0.4 * CREST * a, 0.5 * w * CREST - 0.4 * CREST * a, 0.010)
        for a, w in stations
    ]
    crest = plate(recorder, "z", "x", ribs, anchors=[head])
    recorder.scale(crest.beyond(1, hinge=1), 1.0, "z", size="crest_length")
    return crest


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
