"""Parts that the models of helicopters share: main rotors on a mast, tail rotors, and the choice of their blades.

A rotor is modelled with all blades that any choice has; a choice leaves those at its own angles.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from models_store.library.aids.beam import beam
from models_store.library.aids.loft import Loft, Section, loft
from shapewright.errors import ModelError
from shapewright.modeling import Component, Condition, Element, Recorder, Target, Turn, when

Solid = Literal["disc", "plate", "none"]
Range = tuple[float, float]

NUMBERS = {2: "two", 3: "three", 4: "four", 5: "five", 6: "six", 7: "seven"}
DISC_SIDES = 16
PLATE_SHARE = 0.8
"""Side of a square plate, as a share of the diameter."""
ROUND_SIDES = 6


@dataclass(frozen=True)
class Rotor:
    """A rotor and what it may be.

    Attributes:
        counts: numbers of blades to choose from; the choices that share a blade must lie beside each other.
        solids: further choices: a disc or a plate for a turning rotor; none, always the last.
        prefix, label: what its parameters begin with.
    """

    counts: tuple[int, ...]
    solids: tuple[Solid, ...]
    diameter: float
    blade_width: float
    diameter_range: Range
    prefix: str = "rotor"
    label: str = "Rotor"

    @property
    def there(self) -> tuple[Condition, ...]:
        """What holds unless the choice is none."""
        return (when(self.prefix, 1, len(self.counts) + len(self.solids) - ("none" in self.solids)),)

    @property
    def bladed(self) -> tuple[Condition, ...]:
        """What holds where it has blades."""
        return (when(self.prefix, 1, len(self.counts)),)

    def declare(self, recorder: Recorder) -> None:
        """Declare the choice and the diameter."""
        names = [f"{NUMBERS[count]} blades" for count in self.counts]
        recorder.choice(self.prefix, self.label, (*names, *self.solids))
        recorder.parameter(
            f"{self.prefix}_diameter",
            f"{self.label} diameter",
            *self.diameter_range,
            base_value=self.diameter,
            active_when=self.there,
            unit="m",
        )


@dataclass(frozen=True)
class Blades:
    """All blades of a rotor, and its disc and plate, about one ring of vertices."""

    centre: tuple[Element, ...]
    blades: Loft
    angles_deg: tuple[float, ...]
    solids: dict[Solid, Component]

    @property
    def components(self) -> list[Element]:
        """Everything that turns."""
        return [component.whole for component in (*self.blades.components, *self.solids.values())]

    def each(self, elements: Sequence[Element] | None = None) -> list[Target]:
        """Return targets that turn or grow about the centre along the model's axes."""
        return [Target((whole,), "world", (), self.centre) for whole in elements or self.components]


@dataclass(frozen=True)
class Mast:
    """What bears a main rotor: its height, its width, and how far it reaches into the body."""

    height: float
    width: float
    sunk: float
    height_range: Range = (0.4, 2.2)


def main_rotor(recorder: Recorder, rotor: Rotor, mast: Mast, *anchors: Target) -> list[Element]:
    """Model a rotor on a mast on each anchor, all alike; return what turns, which need not be symmetric."""
    rotor.declare(recorder)
    name = f"{rotor.prefix}_mast"
    recorder.parameter(name, f"{rotor.label} mast height", *mast.height_range, base_value=mast.height, unit="m")
    profile = ((-mast.sunk, 1.6), (0.0, 1.6), (0.55 * mast.height, 0.9), (0.9 * mast.height, 2.4), (mast.height, 1.8))
    sections = [Section(place, wide * mast.width, wide * mast.width) for place, wide in profile]
    columns = [loft(recorder, "z", sections, sides=ROUND_SIDES, anchors=[anchor]) for anchor in anchors]
    recorder.scale([t for column in columns for t in column.beyond(1, hinge=1)], 1.0, "z", size=name)
    turning = [_blades(recorder, rotor, column.rings[-1][0], flat=True) for column in columns]
    name = f"{rotor.prefix}_blade_width"
    recorder.parameter(
        name, f"{rotor.label} blade width", 0.4, 1.8, base_value=rotor.blade_width, active_when=rotor.bladed, unit="m"
    )
    for each in turning:
        recorder.scale(each.blades.body(hinge=0), 1.0, "u", size=f"{rotor.prefix}_diameter")
        recorder.scale(each.blades.body(hinge=0), 1.0, "v", size=name)
        if each.solids:
            solids = each.each([solid.whole for solid in each.solids.values()])
            recorder.scale(solids, 1.0, "uv", size=f"{rotor.prefix}_diameter")
    _pose(recorder, rotor, turning)
    _declare_parts(recorder, rotor, turning)
    return [component for each in turning for component in each.components]


def tail_rotor(recorder: Recorder, rotor: Rotor, anchor: Target, *, aside: float, moves: float) -> list[Element]:
    """Model a rotor on an axle to the left of an anchor; return its components, which are not symmetric.

    Args:
        aside: how far from the anchor it turns.
        moves: how far a parameter moves it up and down; 0: no parameter.
    """
    rotor.declare(recorder)
    profile = ((-0.3, 0.35), (1.1, 0.3))
    axle = loft(
        recorder,
        "y",
        [Section(at * aside, wide * aside, wide * aside) for at, wide in profile],
        sides=ROUND_SIDES,
        anchors=[anchor],
    )
    turning = _blades(recorder, rotor, axle.rings[-1][0], flat=False)
    recorder.scale(turning.blades.body(hinge=0), 1.0, "z", size=f"{rotor.prefix}_diameter")
    if turning.solids:
        solids = turning.each([solid.whole for solid in turning.solids.values()])
        recorder.scale(solids, 1.0, "uz", size=f"{rotor.prefix}_diameter")
    recorder.rotate(turning.each(), 30.0, "v")
    components = [axle.component.whole, *turning.components]
    if moves:
        name = f"{rotor.prefix}_height"
        recorder.parameter(name, f"{rotor.label} place", 0.0, 2.0, base_value=moves, active_when=rotor.there, unit="m")
        recorder.drag(Target(tuple(components), "world"), -moves)
        recorder.drag(Target(tuple(components), "world"), moves, height=name)
    recorder.part(f"{rotor.label}: axle", [axle.component], present_when=rotor.there)
    _declare_parts(recorder, rotor, [turning])
    return components


def _pose(recorder: Recorder, rotor: Rotor, turning: Sequence[Blades]) -> None:
    """Blades droop more towards their tips; a rotor turns about its mast and tilts at its top."""
    name = f"{rotor.prefix}_droop"
    recorder.parameter(
        name, f"{rotor.label} blade droop (deg)", -1.0, 2.5, base_value=3.0, active_when=rotor.bladed, kind="angle"
    )
    for each in turning:
        for joint in (0, 1):
            recorder.rotate(each.blades.beyond(joint + 1, hinge=joint), 1.5, "v", angle=name)
    everything = [target for each in turning for target in each.each()]
    name = f"{rotor.prefix}_turn"
    recorder.parameter(
        name, f"{rotor.label} turned (deg)", -2.0, 2.0, base_value=45.0, active_when=rotor.bladed, kind="angle"
    )
    recorder.rotate(everything, 45.0, "z", angle=name)
    name = f"{rotor.prefix}_tilt"
    recorder.parameter(
        name, f"{rotor.label} tilted forwards (deg)", -2.0, 2.5, base_value=3.0, active_when=rotor.there, kind="angle"
    )
    recorder.rotate(everything, 3.0, "v", angle=name)


def _declare_parts(recorder: Recorder, rotor: Rotor, turning: Sequence[Blades]) -> None:
    """Make a part of all blades that are there under the same choices, and one of each solid."""
    shared: dict[tuple[int, ...], list[Component]] = {}
    for each in turning:
        for angle, blade in zip(each.angles_deg, each.blades.components, strict=True):
            choices = tuple(n for n, count in enumerate(rotor.counts, 1) if _has_blade(count, angle))
            if choices[-1] - choices[0] >= len(choices):
                raise ModelError(f"the choices of the blade at {angle:g} deg do not lie beside each other")
            shared.setdefault(choices, []).append(blade)
    for choices, blades in shared.items():
        numbers = " or ".join(NUMBERS[rotor.counts[n - 1]] for n in choices)
        there = (when(rotor.prefix, choices[0], choices[-1]),)
        recorder.part(f"{rotor.label}: blades of {numbers}", blades, present_when=there)
    for number, solid in enumerate(rotor.solids, len(rotor.counts) + 1):
        if solid != "none":
            there = (when(rotor.prefix, number),)
            recorder.part(f"{rotor.label}: {solid}", [each.solids[solid] for each in turning], present_when=there)


def _blades(recorder: Recorder, rotor: Rotor, ring: tuple[Element, ...], *, flat: bool) -> Blades:
    """Blades at every angle that any of the counts has, about z if they lie flat, else about y."""
    angles = tuple(sorted({360.0 * i / count for count in rotor.counts for i in range(count)}))
    axle: Literal["y", "z"] = "z" if flat else "y"
    anchors = [Target(ring, "world", (Turn(axle, angle),) if angle else ()) for angle in angles]
    radius, thickness = rotor.diameter / 2, rotor.blade_width * 0.15
    shape = ((0.0, 0.6), (0.4, 1.0), (1.0, 0.9)) if flat else ((0.0, 0.8), (1.0, 1.0))
    across = [(wide * rotor.blade_width, thickness) for _, wide in shape]
    sections = [Section(place * radius, *extents) for (place, _), extents in zip(shape, across, strict=True)]
    blades = beam(recorder, "+x" if flat else "+z", sections, crease="all", anchors=anchors)
    solids: dict[Solid, Component] = {}
    for solid in rotor.solids:
        if solid != "none":
            solids[solid] = _solid(recorder, solid, rotor.diameter, thickness, Target(ring, "world"))
            if not flat:
                recorder.rotate(Target((solids[solid].whole,), "world", (), ring), -90.0, "u")
    return Blades(ring, blades, angles, solids)


def _solid(recorder: Recorder, solid: Solid, diameter: float, thickness: float, centre: Target) -> Component:
    offset = (0.0, 0.0, -thickness / 2)
    if solid == "disc":
        made = recorder.prism(DISC_SIDES, diameter, thickness, offset=offset, anchor=centre)
    else:
        made = recorder.box(diameter * PLATE_SHARE, diameter * PLATE_SHARE, thickness, offset=offset, anchor=centre)
    recorder.mark_sharp(*made.faces)
    return made


def _has_blade(count: int, angle_deg: float) -> bool:
    """Whether one of this many blades is at an angle."""
    share = angle_deg * count / 360.0
    return abs(share - round(share)) < 1e-9
