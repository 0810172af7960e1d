"""Parts that the models of helicopters share: hulls, engines, pods, fins, tailplanes, stub wings."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from models_store.library.aids.beam import at, beam
from models_store.library.aids.loft import Loft, Section, loft, move
from shapewright.modeling import Component, Condition, Element, Mirror, Recorder, Target, when

Range = tuple[float, float]
PLATE_THICKNESS = 0.09


@dataclass(frozen=True)
class Hull:
    """A hull whose sections lead from the tip of the tail to the nose.

    Attributes:
        tail: the last section of the tail boom; the next is the rear of the cabin.
        nose: the section where the nose begins.
        rise, drop: by how much the tip of the boom may rise and the nose may sink, at x = 1.
    """

    sections: tuple[Section, ...]
    tail: int
    nose: int
    rise: float
    drop: float
    cabin_length: Range = (0.6, 1.5)
    cabin_width: Range = (0.65, 1.4)
    cabin_height: Range = (0.65, 1.4)
    tail_length: Range = (0.6, 1.4)
    sharp: bool = False


def hull(recorder: Recorder, shape: Hull) -> Loft:
    """Model a hull with parameters for cabin, nose and tail boom."""
    made = beam(recorder, "+x", shape.sections, crease="all") if shape.sharp else loft(recorder, "x", shape.sections)
    cabin, last = shape.tail + 1, len(shape.sections) - 1
    recorder.parameter("cabin_length", "Cabin length", *shape.cabin_length, kind="length")
    recorder.scale(made.beyond(cabin, hinge=cabin), 1.0, "u", size="cabin_length")
    for name, label, limits, axis in (
        ("cabin_width", "Cabin width", shape.cabin_width, "v"),
        ("cabin_height", "Cabin height", shape.cabin_height, "z"),
    ):
        recorder.parameter(name, label, *limits, kind="length")
        recorder.scale(made.sections(*range(cabin, last + 1)), 1.0, axis, size=name)
    recorder.parameter("nose_length", "Nose length", 0.5, 1.8, kind="length")
    recorder.scale(made.beyond(shape.nose, hinge=shape.nose), 1.0, "u", size="nose_length")
    recorder.parameter("nose_point", "Pointed or blunt nose", 0.4, 1.8)
    recorder.scale(made.sections(last), 1.0, "vz", size="nose_point")
    recorder.parameter("nose_drop", "Nose lower than the cabin", -1.0, 2.0, base_value=shape.drop, unit="m")
    for number in range(shape.nose, last + 1):
        share = (number - shape.nose + 1) / (last - shape.nose + 1)
        move(recorder, made.sections(number), (0.0, 0.0, -shape.drop * share), length="nose_drop")
    recorder.parameter("tail_length", "Tail boom length", *shape.tail_length, kind="length")
    boom = [Target(tuple(v for ring in made.rings[:cabin] for v in ring[0]), "world", (), made.rings[cabin][0])]
    recorder.scale(boom, 1.0, "u", size="tail_length")
    recorder.parameter("tail_thickness", "Tail boom thickness", 0.5, 1.6, kind="length")
    recorder.scale(made.sections(*range(cabin)), 1.0, "vz", size="tail_thickness")
    recorder.parameter("tail_rise", "Tip of the tail boom raised", -0.8, 2.0, base_value=shape.rise, unit="m")
    for number in range(shape.tail):
        move(recorder, made.sections(number), (0.0, 0.0, shape.rise * (1 - number / shape.tail)), length="tail_rise")
    return made


def engine(recorder: Recorder, sections: Sequence[Section], anchor: Target) -> Loft:
    """Model a hump on the back of the cabin; it stands half in the hull."""
    made = loft(recorder, "x", sections, anchors=[anchor])
    for what, axis, low, high in (("length", "u", 0.6, 1.6), ("width", "v", 0.5, 1.6), ("height", "z", 0.4, 2.0)):
        recorder.parameter(f"engine_{what}", f"Engine {what}", low, high, kind="length")
        recorder.scale(made.body(), 1.0, axis, size=f"engine_{what}")
    return made


@dataclass(frozen=True)
class Pods:
    """Two bodies along x at the sides of a hull or under wings; ``aside`` moves them outwards from their anchors."""

    name: str
    label: str
    sections: tuple[Section, ...]
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    length_range: Range = (0.6, 1.5)
    size_range: Range = (0.5, 1.6)


def pods(recorder: Recorder, shape: Pods, anchors: tuple[Target, Target], active_when: tuple[Condition, ...]) -> Loft:
    """Model a pair of pods and their length and thickness."""
    made = loft(recorder, "x", shape.sections, sides=6, offset=shape.offset, anchors=anchors)
    recorder.parameter(
        f"{shape.name}_length", f"{shape.label} length", *shape.length_range, active_when=active_when, kind="length"
    )
    recorder.scale(made.body(), 1.0, "u", size=f"{shape.name}_length")
    recorder.parameter(
        f"{shape.name}_size", f"{shape.label} thickness", *shape.size_range, active_when=active_when, kind="length"
    )
    recorder.scale(made.body(), 1.0, "vz", size=f"{shape.name}_size")
    return made


def flank(recorder: Recorder, body: Loft, section: int, *, height: float = 0.0) -> tuple[Target, Target]:
    """Return anchors at the left and the right of a section; ``height`` above 0 looks above the middle."""
    left, right = (at(recorder, body, section, (0.0, y, height)) for y in (1.0, -1.0))
    return left, replace(right, image=(Mirror("y"),))


@dataclass(frozen=True)
class Fin:
    """An upright plate at the tip of the tail boom.

    Attributes:
        sweep: how far its top lies behind its root at x = 1.
        forward: how far its root lies before the last section of the boom.
    """

    height: float
    chord: float
    sweep: float
    forward: float
    height_range: Range = (0.4, 1.8)


def fin(recorder: Recorder, shape: Fin, body: Loft) -> Loft:
    """Model the fin and, by choice, a smaller one below the boom."""
    root = Target(body.rings[0][0], "world")
    offset = (shape.forward, 0.0, 0.0)
    sections = [
        Section(place * shape.height, shape.chord * wide, PLATE_THICKNESS * thick)
        for place, wide, thick in ((0.0, 1.0, 1.3), (0.5, 0.85, 1.0), (1.0, 0.65, 0.8))
    ]
    made = beam(recorder, "+z", sections, crease="all", offset=offset, anchors=root)
    recorder.parameter("fin_height", "Fin height", *shape.height_range, base_value=shape.height, unit="m")
    recorder.scale(made.body(hinge=0), 1.0, "z", size="fin_height")
    recorder.parameter("fin_chord", "Fin chord", 0.5, 1.7, base_value=shape.chord, unit="m")
    recorder.scale(made.body(hinge=0), 1.0, "u", size="fin_chord")
    recorder.parameter("fin_sweep", "Fin sweep", -0.5, 2.2, base_value=shape.sweep, unit="m")
    for number in (1, 2):
        move(recorder, made.sections(number), (-shape.sweep * number / 2, 0.0, 0.0), length="fin_sweep")
    recorder.switch("lower_fin", "Fin below the tail boom")
    there = (when("lower_fin", 1),)
    lower_sections = [Section(s.at * 0.6, s.width * 0.9, s.height) for s in (sections[0], sections[2])]
    below = beam(recorder, "-z", lower_sections, crease="all", offset=offset, anchors=root)
    move(recorder, below.sections(1), (-shape.sweep * 0.5, 0.0, 0.0))
    recorder.part("lower fin", below.components, present_when=there)
    return made


@dataclass(frozen=True)
class Tailplane:
    """Level plates at both sides of the tail boom or of the fin's top, with upright plates at their tips by choice."""

    span: float
    chord: float
    endplate: float


def tailplane(recorder: Recorder, shape: Tailplane, boom: Target, fin_top: Target) -> None:
    """Model both tailplanes of which one or none is there; ``span`` is that of one side."""
    options = ("on the boom", "on the fin", "none")
    recorder.choice("tailplane", "Tailplane", options)
    there = (when("tailplane", 1, 2),)
    recorder.parameter(
        "tailplane_span", "Tailplane half span", 0.4, 1.7, base_value=shape.span, active_when=there, unit="m"
    )
    recorder.parameter(
        "tailplane_chord", "Tailplane chord", 0.5, 1.8, base_value=shape.chord, active_when=there, unit="m"
    )
    sections = [
        Section(0.0, shape.chord, PLATE_THICKNESS * 1.2),
        Section(shape.span, shape.chord * 0.8, PLATE_THICKNESS),
    ]
    for number, anchor in enumerate((boom, fin_top), 1):
        anchors = (anchor, replace(anchor, image=(Mirror("y"),)))
        planes = beam(recorder, "+y", sections, crease="all", anchors=anchors)
        recorder.scale(planes.body(hinge=0), 1.0, "v", size="tailplane_span")
        recorder.scale(planes.body(hinge=0), 1.0, "u", size="tailplane_chord")
        recorder.part(f"tailplane {options[number - 1]}", planes.components, present_when=(when("tailplane", number),))
        if number == 1:
            _endplates(recorder, shape, planes)


def _endplates(recorder: Recorder, shape: Tailplane, planes: Loft) -> None:
    on_boom = when("tailplane", 1)
    recorder.switch("endplates", "Plates at the tips of the tailplane", active_when=(on_boom,))
    there = (on_boom, when("endplates", 1))
    tips = [Target(ring, "world", image) for ring, image in zip(planes.rings[1], planes.images, strict=True)]
    chord = shape.chord * 0.8
    sections = [
        Section(-0.35 * shape.endplate, chord, PLATE_THICKNESS),
        Section(0.0, chord, PLATE_THICKNESS),
        Section(0.65 * shape.endplate, chord * 0.7, PLATE_THICKNESS, (-0.2 * chord, 0.0)),
    ]
    plates = beam(recorder, "+z", sections, crease="all", anchors=tips)
    recorder.part("endplates", plates.components, present_when=there)


def stub_wings(
    recorder: Recorder, anchors: tuple[Target, Target], span: float, chord: float, droop_deg: float, sunk: float
) -> Loft:
    """Model a pair of short wings that hang on the flanks of a hull."""
    sections = [
        Section(-sunk, chord, 0.16),
        Section(0.5 * span, chord * 0.9, 0.14),
        Section(span, chord * 0.75, 0.10),
    ]
    wings = beam(recorder, "+y", sections, crease="all", anchors=anchors)
    recorder.scale(wings.beyond(1, hinge=0), 1.0, "v", size="wing_span")
    recorder.scale(wings.body(hinge=0), 1.0, "u", size="wing_chord")
    recorder.rotate(wings.beyond(1, hinge=0), -droop_deg, "u", angle="wing_droop")
    return wings


def whole(*bodies: Loft) -> list[Component | Element]:
    """Return the components of bodies, for a part."""
    return [component for body in bodies for component in body.components]
