"""Modelling aid for insects and spiders: pairs of jointed legs and feelers."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from models_store.library.aids.beam import at
from models_store.library.aids.loft import ORIGIN, Loft, Section, Vector, loft, move
from shapewright.modeling import Component, Condition, Element, Mirror, Recorder, Target, when
from shapewright.modeling.units import ParameterKind

LEG_SIDES = 4
KNEE, ANKLE = 2, 4
"""Sections of a leg: root, thigh, knee, shin, ankle, tip."""
STEEPEST_SHIN_DEG = 107.0
SWEEP_DEG = 20.0
PAIR_RAISE_DEG, PAIR_TURN_DEG = 20.0, 25.0
"""How far a single pair may deviate from what the others do."""
_PLACES = (0.0, 0.21, 0.42, 0.62, 0.82, 1.0)
_THICKNESS = (1.15, 1.0, 1.0, 0.85, 0.7, 0.35)

Range = tuple[float, float]


@dataclass(frozen=True)
class LegShape:
    """What all legs of an animal have in common; ranges are relative.

    Attributes:
        raise_deg: how far thighs rise from the horizontal; knee and ankle bend down from there.
        inset: how far the root lies inside the body, from where it is anchored.
        prefix, label: what its parameters begin with, for animals with legs of two kinds.
    """

    length: float
    thickness: float
    raise_deg: float
    knee_deg: float
    ankle_deg: float
    inset: float
    length_range: Range = (0.6, 1.7)
    shin_range: Range = (0.6, 1.6)
    thickness_range: Range = (0.25, 2.4)
    raise_range: Range = (0.0, 1.8)
    knee_range: Range = (0.2, 1.5)
    ankle_range: Range = (-1.2, 2.5)
    spread_range: Range = (0.3, 1.35)
    prefix: str = ""
    label: str = ""


@dataclass(frozen=True)
class Station:
    """Where a pair of legs is: anchors on both sides, and its heading (0: sideways, above 0: towards the head)."""

    anchors: tuple[Target, Target]
    heading_deg: float


def flanks(recorder: Recorder, body: Loft, number: int, *, down: float = 0.0) -> tuple[Target, Target]:
    """Return anchors at the left and the right of a section; ``down`` above 0 looks below the middle."""
    left, right = (at(recorder, body, number, (0.0, y, -down)) for y in (1.0, -1.0))
    return left, replace(right, image=(Mirror("y"),))


def hub(body: Loft, number: int) -> Target:
    """Return the anchor in the middle of a section."""
    return Target(body.rings[number][0], "world")


def legs(
    recorder: Recorder, shape: LegShape, stations: Sequence[Station], *, middle_turn_deg: float | None = None
) -> list[Loft]:
    """Model one to four pairs of legs, the front one first, and declare their parameters.

    Args:
        middle_turn_deg: lets the second of four pairs be absent; by this angle the third turns forwards then, so that
            the middle legs point sideways.
    """
    all_there: tuple[Condition, ...] = ()
    if middle_turn_deg is not None:
        recorder.choice("leg_count", "Legs", ("eight legs", "six legs"))
        all_there = (when("leg_count", 1),)
    _declare(recorder, shape, several=len(stations) > 1)
    sections = [
        Section(place * shape.length, relative * shape.thickness, relative * shape.thickness)
        for place, relative in zip(_PLACES, _THICKNESS, strict=True)
    ]
    pairs = [
        loft(recorder, "y", sections, sides=LEG_SIDES, offset=(0.0, -shape.inset, 0.0), anchors=station.anchors)
        for station in stations
    ]
    _sharpen_knees(recorder, pairs)
    name, every = shape.prefix, range(len(sections))
    recorder.scale([t for p in pairs for t in p.sections(*every)], 1.0, "uz", size=f"{name}leg_thickness")
    recorder.scale([t for p in pairs for t in p.sections(1, 3)], 1.0, "uz", size=f"{name}leg_bulge")
    recorder.scale([t for p in pairs for t in p.body(hinge=0)], 1.0, "v", size=f"{name}leg_length")
    recorder.scale([t for p in pairs for t in p.beyond(KNEE, hinge=KNEE)], 1.0, "v", size=f"{name}shin_length")
    _size_single_pairs(recorder, shape, pairs, all_there)
    _bend(recorder, pairs, 0, shape.raise_deg, angle=f"{name}leg_raise")
    _bend(recorder, pairs, KNEE, -shape.knee_deg, angle=f"{name}knee_bend")
    _bend(recorder, pairs, ANKLE, -shape.ankle_deg, angle=f"{name}ankle_bend")
    _raise_single_pairs(recorder, shape, pairs, all_there)
    for pair, station in zip(pairs, stations, strict=True):
        if station.heading_deg:
            recorder.rotate(pair.body(hinge=0), -station.heading_deg, "z", angle=f"{name}leg_spread")
    _turn_single_pairs(recorder, shape, pairs, all_there)
    if len(pairs) > 1:
        swept = [t for p in pairs for t in p.body(hinge=0)]
        recorder.rotate(swept, -SWEEP_DEG, "z")
        recorder.rotate(swept, SWEEP_DEG, "z", angle=f"{name}leg_sweep")
    if middle_turn_deg is not None:
        recorder.part("second pair of legs", components(pairs[1]), present_when=all_there)
        third = pairs[2].body(hinge=0)
        recorder.rotate(third, middle_turn_deg, "z")
        recorder.rotate(third, -middle_turn_deg, "z", angle="leg_count")
    return pairs


def _sharpen_knees(recorder: Recorder, pairs: Sequence[Loft]) -> None:
    """Keep the edges around the knees sharp, so that thighs and shins stay straight up to them."""
    for loop in (loop for pair in pairs for loop in pair.rings[KNEE]):
        ends = zip(loop, (*loop[1:], loop[0]), strict=True)
        recorder.mark_sharp(*(Element("edge", recorder.mesh.edge_between(a.id, b.id)) for a, b in ends))


def _size_single_pairs(
    recorder: Recorder, shape: LegShape, pairs: Sequence[Loft], all_there: Sequence[Condition]
) -> None:
    """Let single pairs be longer or shorter than the others."""
    for place, pair in _single_pairs(pairs).items():
        label = f"{shape.label}Length of the {place} legs beside the others".capitalize()
        name = f"{place}_{shape.prefix}leg_length"
        recorder.parameter(name, label, 0.5, 1.6, active_when=all_there if place == "third" else ())
        recorder.scale(pair.body(hinge=0), 1.0, "v", size=name)


def _raise_single_pairs(
    recorder: Recorder, shape: LegShape, pairs: Sequence[Loft], all_there: Sequence[Condition]
) -> None:
    """Let the thighs of single pairs rise more or less than those of the others; the shins keep their directions."""
    for place, pair in _single_pairs(pairs).items():
        label = f"{shape.label}Rise of the {place} thighs beside the others (deg)".capitalize()
        name = f"{place}_{shape.prefix}leg_raise"
        needed = all_there if place == "third" else ()
        recorder.parameter(name, label, 0.0, 2.5, base_value=PAIR_RAISE_DEG, active_when=needed, kind="angle")
        _bend(recorder, (pair,), 0, -PAIR_RAISE_DEG)
        _bend(recorder, (pair,), 0, PAIR_RAISE_DEG, angle=name)
        _bend(recorder, (pair,), KNEE, PAIR_RAISE_DEG)
        _bend(recorder, (pair,), KNEE, -PAIR_RAISE_DEG, angle=name)


def _single_pairs(pairs: Sequence[Loft]) -> dict[str, Loft]:
    """Return all pairs but one, for which the parameters of all legs are enough."""
    names = ((), ("front",), ("front", "rear"), ("front", "third", "rear"))[len(pairs) - 1]
    numbers = {"front": 0, "third": 2, "rear": -1}
    return {name: pairs[numbers[name]] for name in names}


def _turn_single_pairs(
    recorder: Recorder, shape: LegShape, pairs: Sequence[Loft], all_there: Sequence[Condition]
) -> None:
    """Let the front and the rear pair have directions of their own, as far as spread and sweep do not give them."""
    single = {"front": (pairs[0], "forwards", -1.0)} if len(pairs) > 2 else {}
    if len(pairs) > 3:
        single["rear"] = (pairs[-1], "backwards", 1.0)
    for place, (pair, way, sign) in single.items():
        label = f"{shape.label}{place} legs turned {way} (deg)".capitalize()
        name = f"{place}_{shape.prefix}leg_turn"
        needed = all_there if place == "rear" else ()
        recorder.parameter(name, label, 0.0, 2.0, base_value=PAIR_TURN_DEG, active_when=needed, kind="angle")
        recorder.rotate(pair.body(hinge=0), -sign * PAIR_TURN_DEG, "z")
        recorder.rotate(pair.body(hinge=0), sign * PAIR_TURN_DEG, "z", angle=name)


def _declare(recorder: Recorder, shape: LegShape, *, several: bool) -> None:
    kinds: tuple[tuple[str, str, Range, float | None, ParameterKind | None], ...] = (
        ("leg_length", "leg length", shape.length_range, shape.length, "length"),
        ("shin_length", "length of the shins beside the thighs", shape.shin_range, None, None),
        ("leg_thickness", "leg thickness", shape.thickness_range, shape.thickness, "length"),
        ("leg_bulge", "leg thickness between the joints", (0.5, 2.0), None, None),
        ("leg_raise", "rise of the thighs (deg)", shape.raise_range, shape.raise_deg, "angle"),
        ("knee_bend", "bend of the knees (deg)", shape.knee_range, shape.knee_deg, "angle"),
        ("ankle_bend", "bend of the ankles (deg)", shape.ankle_range, shape.ankle_deg, "angle"),
        ("leg_spread", "spread of the legs forwards and backwards", shape.spread_range, None, None),
    )
    if several:
        kinds += (("leg_sweep", "legs turned backwards (deg)", (0.0, 2.0), SWEEP_DEG, "angle"),)
    for name, label, limits, base_value, kind in kinds:
        recorder.parameter(
            f"{shape.prefix}{name}",
            f"{shape.label}{label}".capitalize(),
            *limits,
            unit="cm" if kind == "length" else None,
            base_value=base_value,
            kind=kind,
        )
    _keep_feet_low(recorder, shape)


def _keep_feet_low(recorder: Recorder, shape: LegShape) -> None:
    """The higher the thighs rise the more the knees bend, or feet end up in the air; and shins never curl under."""
    per_raise = 1.35 * shape.raise_deg / shape.knee_deg
    recorder.limit(f"{shape.prefix}knee_bend", minimum=(f"{shape.prefix}leg_raise", -8.0 / shape.knee_deg, per_raise))
    as_steep = (STEEPEST_SHIN_DEG / shape.knee_deg, shape.raise_deg / shape.knee_deg)
    recorder.limit(f"{shape.prefix}knee_bend", maximum=(f"{shape.prefix}leg_raise", *as_steep))


def _bend(recorder: Recorder, pairs: Sequence[Loft], joint: int, angle_deg: float, **varies: str) -> None:
    """Bend legs at a joint, whose section turns by half the angle as a mitre does; the root turns all the way."""
    turned = [t for p in pairs for t in p.beyond(joint, hinge=joint)]
    if joint == 0:
        recorder.rotate(turned, angle_deg, "u", pivot=None, **varies)
        return
    recorder.rotate(turned, angle_deg / 2, "u", pivot=None, **varies)
    recorder.rotate(
        [t for p in pairs for t in p.beyond(joint + 1, hinge=joint)], angle_deg / 2, "u", pivot=None, **varies
    )


@dataclass(frozen=True)
class Feelers:
    """A pair of antennae, jaws or tail bristles.

    Attributes:
        name, label: what their parameters begin with.
        heading_deg: away from straight ahead, outwards.
        raise_deg: up from the horizontal.
        curve_deg: how far they turn inwards along their length.
    """

    name: str
    label: str
    length: float
    thickness: float
    heading_deg: float
    raise_deg: float = 0.0
    curve_deg: float = 0.0
    flatness: float = 1.0
    length_range: Range = (0.4, 2.0)
    spread_range: Range = (0.3, 2.0)
    curve_range: Range = (0.0, 2.0)


def feelers(
    recorder: Recorder,
    shape: Feelers,
    anchors: tuple[Target, Target],
    *,
    offset: Vector = ORIGIN,
    active_when: Sequence[Condition] = (),
) -> Loft:
    """Model a pair of feelers that start from both anchors, and declare their parameters."""
    recorder.parameter(
        f"{shape.name}_length",
        f"{shape.label} length",
        *shape.length_range,
        base_value=shape.length,
        active_when=active_when,
        unit="cm",
    )
    recorder.parameter(f"{shape.name}_spread", f"{shape.label} spread", *shape.spread_range, active_when=active_when)
    sections = [
        Section(place * shape.length, wide * shape.thickness, wide * shape.thickness * shape.flatness)
        for place, wide in ((0.0, 1.0), (0.35, 1.0), (0.7, 0.8), (1.0, 0.3))
    ]
    made = loft(recorder, "x", sections, sides=LEG_SIDES, offset=offset, anchors=anchors)
    recorder.scale(made.body(hinge=0), 1.0, "u", size=f"{shape.name}_length")
    if shape.curve_deg:
        name = f"{shape.name}_curve"
        recorder.parameter(name, f"{shape.label} curve", *shape.curve_range, active_when=active_when)
        for joint in (1, 2):
            recorder.rotate(made.beyond(joint, hinge=joint), -shape.curve_deg / 2, "z", angle=name)
    if shape.raise_deg:
        name = f"{shape.name}_raise"
        recorder.parameter(
            name,
            f"{shape.label} rise (deg)",
            -1.0,
            2.0,
            base_value=shape.raise_deg,
            active_when=active_when,
            kind="angle",
        )
        recorder.rotate(made.body(hinge=0), -shape.raise_deg, "v", angle=name)
    recorder.rotate(made.body(hinge=0), shape.heading_deg, "z", angle=f"{shape.name}_spread")
    return made


def face(
    recorder: Recorder, head: Loft, antennae: tuple[Feelers, int, Vector], jaws: tuple[Feelers, int, Vector]
) -> None:
    """Add antennae high and jaws low on a head, each a switch; given are shape, section of the head, and offset."""
    for key, label, down, (shape, number, offset) in (
        ("antennae", "Antennae", -0.6, antennae),
        ("jaws", "Jaws", 0.0, jaws),
    ):
        recorder.switch(key, label)
        there = (when(key, 1),)
        made = feelers(recorder, shape, flanks(recorder, head, number, down=down), offset=offset, active_when=there)
        recorder.part(label.lower(), components(made), present_when=there)


def components(*bodies: Loft) -> list[Component | Element]:
    """Return the components of bodies, for a part."""
    return [component for body in bodies for component in body.components]


def resize(recorder: Recorder, body: Loft, prefix: str, label: str, ranges: Sequence[Range], *, hinge: int) -> None:
    """Let the length (x), width (y) and height (z) of a body be parameters, about one of its sections."""
    names = (("length", "u"), ("width", "v"), ("height", "z"))
    for (what, axis), limits in zip(names, ranges, strict=True):
        recorder.parameter(f"{prefix}_{what}", f"{label} {what}", *limits, kind="length")
        recorder.scale(body.body(hinge=hinge), 1.0, axis, size=f"{prefix}_{what}")


def tilt(recorder: Recorder, body: Loft, name: str, label: str, angle_deg: float, *, hinge: int, up: float) -> None:
    """Let a body turn about the y axis: ``angle_deg`` down to ``up`` times as far upwards of what lies behind."""
    recorder.parameter(name, label, 0.0, 1.0 + up, base_value=angle_deg, kind="angle")
    recorder.rotate(body.body(hinge=hinge), -angle_deg, "v")
    recorder.rotate(body.body(hinge=hinge), angle_deg, "v", angle=name)


def lift(recorder: Recorder, body: Loft, name: str, label: str, by: float) -> None:
    """Let a body move up and down by at most a distance."""
    recorder.parameter(name, label, 0.0, 2.0, base_value=by, unit="cm")
    move(recorder, body.body(), (0.0, 0.0, -by))
    move(recorder, body.body(), (0.0, 0.0, by), length=name)
