"""Modelling aid for birds: trunk, neck and head in one body, tails, legs with feet. Forward is +x."""

from collections.abc import Sequence
from dataclasses import dataclass

from models_store.library.aids.fins import Fan, Rib, fan, plate, with_parts
from models_store.library.aids.loft import Loft, Section, Vector, loft, move, pair
from shapewright.modeling import Condition, Element, Recorder, Target

LABELS = {
    "body_length": ("Body length (without neck and tail)", "m"),
    "body_width": ("Body width", "m"),
    "body_height": ("Body height", "m"),
    "body_pitch": ("Body pitch", "deg"),
    "neck_length": ("Neck length", "m"),
    "neck_thickness": ("Neck thickness (relative)", None),
    "neck_raise": ("Neck raise", "deg"),
    "neck_curve": ("Neck curve forwards", "deg"),
    "head_tilt": ("Head tilt downwards", "deg"),
    "head_size": ("Head size (relative)", None),
    "beak_length": ("Beak length", "m"),
    "beak_thickness": ("Beak thickness (relative)", None),
    "tail_length": ("Tail length", "m"),
    "tail_width": ("Tail width", "m"),
    "tail_spread": ("Spread of the tail's end (relative)", None),
    "tail_fork": ("Tail fork depth (below 0: rounded)", "m"),
    "tail_raise": ("Tail raise", "deg"),
    "leg_length": ("Leg length", "m"),
    "leg_thickness": ("Leg thickness (relative)", None),
    "leg_swing": ("Leg swing backwards", "deg"),
    "leg_bend": ("Knee bend", "deg"),
    "toe_length": ("Toe length", "m"),
    "folded_length": ("Folded wing length", "m"),
    "folded_height": ("Folded wing height", "m"),
    "folded_thickness": ("Folded wing thickness", "m"),
    "folded_spread": ("Folded wing spread", "deg"),
    "folded_droop": ("Folded wing droop", "deg"),
}
"""Label and unit of each parameter that this aid uses."""
TRUNK = 5
"""Sections of a trunk: tail root, rump, belly, breast, shoulders."""
HEAD = 4
"""Sections of a head: back, front, beak root, beak tip."""
TAIL_RAISE_DEG, LEG_SWING_DEG, LEG_BEND_DEG, FOLDED_SPREAD_DEG, FOLDED_DROOP_DEG = 4.0, 6.0, 12.0, 6.0, 6.0
TUCKED = 0.12
"""Share of the length of neck and beak that is there before the parameter adds the rest."""


@dataclass(frozen=True)
class Bird:
    """The body of a bird: trunk, neck and head, from the tail root to the tip of the beak."""

    body: Loft
    n_neck: int

    @property
    def first_neck(self) -> int:
        """The section at which the neck begins."""
        return TRUNK

    @property
    def first_head(self) -> int:
        """The section at the back of the head."""
        return TRUNK + self.n_neck


def declare(recorder: Recorder, active_when: Sequence[Condition] = (), /, **ranges: tuple[float, float, float]) -> None:
    """Declare parameters of this aid, each as smallest and largest x and the base value."""
    for name, (minimum, maximum, base_value) in ranges.items():
        label, unit = LABELS[name]
        recorder.parameter(
            name, label, minimum, maximum, unit=unit, base_value=base_value, active_when=tuple(active_when)
        )


def upto(body: Loft, last: int, hinge: int) -> list[Target]:
    """Return the sections of a loft up to one, as one target a copy."""
    return [
        Target(tuple(v for ring in body.rings[: last + 1] for v in ring[copy]), "world", image, body.rings[hinge][copy])
        for copy, image in enumerate(body.images)
    ]


def model_body(recorder: Recorder, trunk: Sequence[Section], neck: Sequence[Section], head: Sequence[Section]) -> Bird:
    """Model a body, straight; the last of the trunk lies where the neck begins.

    Uses the parameters body_length, body_width, body_height, neck_length, neck_thickness, head_size, beak_length and
    beak_thickness.
    """
    shoulders = trunk[-1].at
    drawn_in: list[Section] = list(trunk)
    added: list[float] = []
    before = trunk[-1].at
    for number, section in enumerate((*neck, *head)):
        grows = number <= len(neck) or number == len(neck) + HEAD - 1
        step = section.at - before
        before = section.at
        added.append(step * (1 - TUCKED) if grows else 0.0)
        shoulders += step - added[-1]
        drawn_in.append(Section(shoulders, section.width, section.height, section.shift))
    body = loft(recorder, "x", drawn_in)
    bird = Bird(body, len(neck))
    start = TRUNK - 1
    recorder.scale(upto(body, start, start), 1.0, "u", size="body_length")
    recorder.scale(upto(body, start, start), 1.0, "v", size="body_width")
    recorder.scale(upto(body, start, start), 1.0, "z", size="body_height")
    recorder.scale(body.sections(*range(bird.first_neck, bird.first_head)), 1.0, "vz", size="neck_thickness")
    recorder.scale(body.beyond(bird.first_head, hinge=bird.first_head), 1.0, "uvz", size="head_size")
    beak = (bird.first_head + HEAD - 2, bird.first_head + HEAD - 1)
    recorder.scale(body.sections(*beak), 1.0, "vz", size="beak_thickness")
    for number, by in enumerate(added, start=TRUNK):
        if by:
            grower = "beak_length" if number == beak[-1] else "neck_length"
            move(recorder, body.beyond(number), (by, 0.0, 0.0), length=grower)
    return bird


def bend_neck(recorder: Recorder, bird: Bird, raise_deg: float, curve_deg: float, head_deg: float) -> None:
    """Raise the lower half of the neck, bend its upper half forwards and the head down: from the head to the root.

    Uses the parameters neck_raise, neck_curve and head_tilt.
    """
    body, joints = bird.body, list(range(bird.first_neck, bird.first_head))
    half = (len(joints) + 1) // 2
    lower, upper = joints[:half], joints[half:]
    recorder.rotate(body.beyond(bird.first_head, hinge=bird.first_head), head_deg, "v", angle="head_tilt")
    for joint in reversed(upper):
        recorder.rotate(body.beyond(joint + 1, hinge=joint), curve_deg / len(upper), "v", angle="neck_curve")
    for joint in reversed(lower):
        recorder.rotate(body.beyond(joint, hinge=joint - 1), -raise_deg / len(lower), "v", angle="neck_raise")


def model_tail(recorder: Recorder, bird: Bird, length: float, widths: Sequence[float], thickness: float) -> Fan:
    """Model a tail at the root of the trunk.

    Uses the parameters tail_length, tail_width, tail_spread, tail_fork and tail_raise.
    """
    inside = 0.16 * length
    root = Target(bird.body.rings[0][0], "world")
    tail = fan(recorder, "y", length, widths, thickness, offset=(inside, 0.0, 0.0), anchor=root)
    recorder.scale(tail.loft.body(hinge=0), 1.0, "u", size="tail_length")
    recorder.scale(tail.loft.body(hinge=0), 1.0, "v", size="tail_width")
    recorder.scale(tail.loft.sections(len(widths) - 1), 1.0, "v", size="tail_spread")
    tail.fork(recorder, 0.1 * length, length="tail_fork")
    recorder.rotate(tail.loft.body(hinge=0), TAIL_RAISE_DEG, "v", angle="tail_raise")
    return tail


def side_pair(recorder: Recorder, bird: Bird, section: int, direction: Vector) -> list[Target]:
    """Return the vertices of a section towards a direction and its mirror image, to hang limbs on."""
    x, y, z = direction
    left = bird.body.vertex(recorder, section, (x, y, z))
    right = bird.body.vertex(recorder, section, (x, -y, z))
    return pair(left, right)


@dataclass(frozen=True)
class Leg:
    """Measures of a leg, downwards from the hip; ``knee`` is the share of it that is thigh.

    ``inside`` is how far it begins above its anchor and how far inwards of it it lies.
    """

    length: float
    thigh: float
    shank: float
    knee: float
    toe: float
    inside: tuple[float, float]


def model_legs(recorder: Recorder, anchors: Sequence[Target], leg: Leg) -> list[Loft]:
    """Model two legs with four toes each; returns the legs, then the toes.

    Uses the parameters leg_length, leg_thickness, leg_swing, leg_bend and toe_length.
    """
    knee, below = leg.knee * leg.length, leg.length * (1 - leg.knee)
    up, inwards = leg.inside
    at = tuple(up + a for a in (-up, knee * 0.5, knee, knee + 0.15 * below, knee + 0.9 * below, leg.length))
    wide = (leg.thigh, leg.thigh * 0.85, leg.thigh * 0.5, leg.shank, leg.shank, leg.shank * 1.1)
    sections = [Section(a, w * 1.4, w * 1.4) for a, w in zip(at, wide, strict=True)]
    legs = loft(recorder, "x", sections, sides=4, offset=(0.0, -inwards, up), anchors=anchors)
    recorder.rotate(legs.body(hinge=0), 90.0, "v")
    recorder.scale(legs.body(hinge=0), 1.0, "z", size="leg_length")
    recorder.scale(legs.sections(*range(1, len(at))), 1.0, "uv", size="leg_thickness")
    toes = []
    feet = [Target(ring, "world", image) for ring, image in zip(legs.rings[-1], legs.images, strict=True)]
    for yaw_deg, share in ((0.0, 1.0), (28.0, 0.9), (-28.0, 0.9), (180.0, 0.55)):
        length, width = leg.toe * share, leg.shank
        ribs = [Rib(a * length, -w * width, w * width, 1.1 * width) for a, w in ((-0.1, 0.6), (0.5, 0.55), (1.0, 0.3))]
        toe = plate(recorder, "x", "y", ribs, anchors=feet)
        move(recorder, toe.sections(2), (0.0, 0.0, -0.35 * width))
        recorder.scale(toe.body(hinge=0), 1.0, "u", size="toe_length")
        if yaw_deg:
            recorder.rotate(toe.body(hinge=0), yaw_deg, "z")
        toes.append(toe)
    recorder.rotate(with_parts(legs.beyond(3, hinge=2), *toes), LEG_BEND_DEG, "v", angle="leg_bend")
    recorder.rotate(with_parts(legs.body(hinge=0), *toes), LEG_SWING_DEG, "v", angle="leg_swing")
    return [legs, *toes]


@dataclass(frozen=True)
class FoldedWing:
    """Measures of a folded wing, backwards from the shoulder; ``inside`` is how far it begins before its anchor."""

    length: float
    height: float
    thickness: float
    inside: float


def model_folded_wings(recorder: Recorder, anchors: Sequence[Target], wing: FoldedWing) -> Loft:
    """Model two wings that lie against the body.

    Uses the parameters folded_length, folded_height, folded_thickness, folded_spread and folded_droop.
    """
    outline = (
        (0.0, -0.30, 0.25, 0.5),
        (0.10, -0.48, 0.42, 0.9),
        (0.30, -0.55, 0.47, 1.0),
        (0.55, -0.45, 0.45, 0.9),
        (0.78, -0.22, 0.40, 0.6),
        (1.0, 0.12, 0.30, 0.3),
    )
    ribs = [
        Rib(at * wing.length, low * wing.height, high * wing.height, thick * wing.thickness)
        for at, low, high, thick in outline
    ]
    wings = plate(recorder, "x", "z", ribs, offset=(wing.inside, -0.25 * wing.thickness, 0.0), anchors=anchors)
    recorder.rotate(wings.body(hinge=0), 180.0, "z")
    recorder.scale(wings.body(hinge=0), 1.0, "u", size="folded_length")
    recorder.scale(wings.body(hinge=0), 1.0, "v", size="folded_thickness")
    recorder.scale(wings.body(hinge=0), 1.0, "z", size="folded_height")
    recorder.rotate(wings.body(hinge=1), -FOLDED_SPREAD_DEG, "z", angle="folded_spread")
    recorder.rotate(wings.body(hinge=1), -FOLDED_DROOP_DEG, "v", angle="folded_droop")
    return wings


def wholes(*lofts: Loft) -> list[Element]:
    """Return the components of lofts and of their copies."""
    return [component.whole for loft in lofts for component in loft.components]


def hold_upright(recorder: Recorder, bird: Bird, pitch_deg: float, parts: Sequence[Element]) -> None:
    """Tip the body up about its belly, with what hangs on it; uses the parameter body_pitch."""
    belly = bird.body.rings[2][0]
    recorder.rotate(
        Target((bird.body.component.whole, *parts), "world", (), belly), -pitch_deg, "v", angle="body_pitch"
    )
