"""Modelling aid for the wings of flying birds: two mirrored plates with feathers, bent, pitched, swept and raised."""

from collections.abc import Sequence
from dataclasses import dataclass

from models_store.library.aids.fins import Rib, plate, with_parts
from models_store.library.aids.loft import Loft
from models_store.library.bird.birds import Bird, side_pair, wholes
from shapewright.modeling import Element, Recorder, Target, when

HAND_SWEEP_DEG, DROOP_DEG, PITCH_DEG, SWEEP_DEG, DIHEDRAL_DEG = 12.0, 15.0, 8.0, 8.0, 8.0
FEATHER_LENGTH, FEATHER_THICKNESS = 0.15, 0.006
FEATHER_RIBS = ((-0.6, 0.5), (0.0, 0.85), (0.6, 1.0), (1.0, 0.4))
"""Places along a feather, from the edge of the wing on, and widths there, both relative."""


@dataclass(frozen=True)
class Feather:
    """Where a feather hangs: at the trailing edge, between two ribs; its angle back from the wing's own direction."""

    ribs: tuple[int, int]
    angle_deg: float
    length: float = 1.0
    width: float = 0.036


FINGERS = (
    Feather((7, 7), 4.0),
    Feather((6, 7), 17.0),
    Feather((6, 6), 28.0),
    Feather((5, 6), 39.0),
    Feather((5, 5), 50.0, 0.9),
    Feather((4, 5), 60.0, 0.8, 0.042),
)
SECONDARIES = (
    Feather((4, 4), 68.0, 0.65, 0.046),
    Feather((3, 4), 74.0, 0.55, 0.046),
    Feather((3, 3), 79.0, 0.5, 0.046),
    Feather((2, 3), 83.0, 0.45, 0.046),
    Feather((2, 2), 86.0, 0.45, 0.046),
)
LABELS = {
    "wing_span": ("Wing span", "m"),
    "wing_chord": ("Wing chord", "m"),
    "hand_chord": ("Chord of the outer wing (relative to the inner wing)", None),
    "tip_chord": ("Chord of the wing tip (relative)", None),
    "wing_thickness": ("Wing thickness (relative)", None),
    "wing_sweep": ("Wing sweep", "deg"),
    "hand_sweep": ("Sweep of the outer wing", "deg"),
    "dihedral": ("Wing raise (dihedral)", "deg"),
    "wing_droop": ("Wing curvature downwards", "deg"),
    "wing_pitch": ("Wing pitch", "deg"),
}


def declare_wings(recorder: Recorder, **ranges: tuple[float, float, float]) -> None:
    """Declare parameters of the wings, each as smallest and largest x and the base value; then those of feathers."""
    for name, (minimum, maximum, base_value) in ranges.items():
        label, unit = LABELS[name]
        recorder.parameter(name, label, minimum, maximum, unit=unit, base_value=base_value)
    recorder.choice("feathers", "Wing edge", ("smooth", "feather fingers", "feathers along the whole edge"))
    feathered = (when("feathers", 2, 3),)
    recorder.parameter(
        "feather_length", "Feather length", 0.5, 1.4, unit="m", base_value=FEATHER_LENGTH, active_when=feathered
    )


def model_wings(recorder: Recorder, bird: Bird, ribs: Sequence[Rib]) -> None:
    """Model two wings of eight ribs at the breast; uses the parameters of :func:`declare_wings`."""
    wing = plate(recorder, "y", "x", ribs, anchors=side_pair(recorder, bird, 3, (0.0, 1.0, 0.0)))
    tip = len(ribs) - 1
    recorder.scale(wing.sections(*range(len(ribs))), 1.0, "z", size="wing_thickness")
    recorder.scale(wing.body(hinge=0), 1.0, "v", size="wing_span")
    recorder.scale(wing.sections(*range(len(ribs))), 1.0, "u", size="wing_chord")
    recorder.scale(wing.sections(*range(3, len(ribs))), 1.0, "u", size="hand_chord")
    recorder.scale(wing.sections(tip - 1, tip), 1.0, "u", size="tip_chord")
    fingers = [_model_feather(recorder, wing, feather) for feather in FINGERS]
    secondaries = [_model_feather(recorder, wing, feather) for feather in SECONDARIES]
    recorder.part("feather fingers", wholes(*fingers), present_when=(when("feathers", 2, 3),))
    recorder.part("secondary feathers", wholes(*secondaries), present_when=(when("feathers", 3),))
    hanging = list(zip((*FINGERS, *SECONDARIES), (*fingers, *secondaries), strict=True))

    def beyond(joint: int) -> list[Target]:
        carried = [loft for feather, loft in hanging if feather.ribs[0] >= joint]
        return with_parts(wing.beyond(joint, hinge=joint - 1), *carried)

    for joint in (6, 5, 4):
        recorder.rotate(beyond(joint), HAND_SWEEP_DEG / 3, "z", angle="hand_sweep")
    for joint in (6, 5, 4, 3, 2):
        recorder.rotate(beyond(joint), -DROOP_DEG / 5, "u", angle="wing_droop")
    recorder.rotate(beyond(1), -PITCH_DEG, "v", angle="wing_pitch")
    recorder.rotate(beyond(1), SWEEP_DEG, "z", angle="wing_sweep")
    recorder.rotate(beyond(1), DIHEDRAL_DEG, "u", angle="dihedral")


def _model_feather(recorder: Recorder, wing: Loft, feather: Feather) -> Loft:
    """One feather and its mirror image; it begins within the wing."""
    anchors = []
    for copy, image in enumerate(wing.images):
        rings = [wing.rings[rib][copy] for rib in dict.fromkeys(feather.ribs)]
        corners: list[Element] = [min(ring, key=lambda v: float(recorder.positions(v)[0, 0])) for ring in rings]
        anchors.append(Target(tuple(corners), "world", image))
    length, half = feather.length * FEATHER_LENGTH, feather.width / 2
    ribs = [Rib(at * length, -width * half, width * half, FEATHER_THICKNESS) for at, width in FEATHER_RIBS]
    made = plate(recorder, "y", "x", ribs, anchors=anchors)
    recorder.scale(made.beyond(1, hinge=1), 1.0, "v", size="feather_length")
    recorder.rotate(made.body(hinge=1), feather.angle_deg, "z")
    return made
