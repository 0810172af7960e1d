"""Modelling aid for glasses on a foot: the foot, a hollow bowl of two walls, and beads around a stem.

Everything is sketched straight, as columns of rings (``lathe``); the widths come afterwards. The widths of a bowl hang
on each other, so that every combination is a bowl: widening a level takes all levels below it along.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from models_store.library.aids.lathe import Lathe, Ring, control_diameter, widen
from shapewright.modeling import Component, Recorder, Target, group

SIDES = 12
UNIT_M = 0.2
"""Meters in a unit of the coordinates: a glass with a foot of half a unit is 18 cm high, and its bowl 10 cm wide."""
WALL = 0.955
"""Width of an inner wall, relative to the outer one."""


def centimeters(length: float) -> float:
    """Return a length of the model in centimeters."""
    return round(100.0 * UNIT_M * length, 6)


@dataclass(frozen=True)
class Foot:
    """A disc whose upper side rises towards the stem.

    Attributes:
        disc: the component of the whole glass, whose bottom is the middle of the underside.
        column: where the stem goes on.
        rings: bottom edge, upper edge, and one on the slope.
    """

    disc: Component
    column: Lathe
    rings: tuple[Ring, Ring, Ring]


def foot(recorder: Recorder, edge: float, slope: float, *, length: str, edge_size: str = "") -> Foot:
    """Start a glass of diameter 1 with its foot.

    Args:
        edge: height of the disc's edge; ``edge_size`` names the parameter that varies it, if any.
        slope: how far the ring on the slope lies above it; ``length`` names the parameter that varies it.
    """
    disc = recorder.prism(SIDES, control_diameter(1.0, SIDES), edge)
    recorder.mark_sharp(disc.bottom, disc.top)
    if edge_size:
        recorder.scale(group(disc.whole, frame="world"), 1.0, "z", pivot=disc.bottom, size=edge_size)
    column = Lathe(recorder, disc)
    return Foot(disc, column, (column.bottom, column.top, column.rise(slope, length=length)))


def underside(recorder: Recorder, made: Foot, width: float, height: float, *, length: str = "") -> Ring:
    """Draw a further ring inwards on the underside of a foot, to a width relative to the ring before it.

    Args:
        height: how far it lies above that ring; ``length`` names the parameter that varies it, if any.
    """
    recorder.extrude(made.disc.bottom, 0.0)
    recorder.scale(made.disc.bottom, width)
    if length:
        recorder.drag(made.disc.bottom, -height, length=length)
    return tuple(recorder.vertices_of(made.disc.bottom))


@dataclass(frozen=True)
class Bowl:
    """Two walls from the bottom to the rim, level by level."""

    outer: tuple[Ring, ...]
    inner: tuple[Ring, ...]
    floor: Ring

    def up_to(self, level: int) -> list[Ring]:
        """Return both walls from the bottom up to a level (-1: the rim)."""
        end = level % len(self.outer) + 1
        return [*self.outer[:end], *self.inner[:end], self.floor]

    def at(self, level: int) -> list[Ring]:
        """Return both walls at one level."""
        return [self.outer[level], self.inner[level]]


def bowl(recorder: Recorder, column: Lathe, rises: Sequence[tuple[float, str]], *, thickness: float) -> Bowl:
    """Raise a bowl of diameter 1 upon the end of a stem, up to a sharp rim and down again inside.

    Args:
        rises: heights of the levels, one above another, the lowest above the end of the stem; and the names of the
            parameters that vary them.
        thickness: of the bottom, at its lowest level.
    """
    outer = [column.rise(by, length=name) for by, name in rises]
    recorder.mark_sharp(column.face)
    inner = [column.rise(0.0)]
    recorder.mark_sharp(column.face)
    inner += [column.rise(-by, length=name) for by, name in reversed(rises[2:])]
    lowest, name = rises[1]
    inner.append(column.rise(thickness - lowest, length=name))
    return Bowl(tuple(outer), tuple(reversed(inner)), column.rise(0.0))


def thin_wall(recorder: Recorder, made: Bowl) -> None:
    """Set the inner wall off from the outer one, after all widths, and draw the middle of the floor together."""
    widen(recorder, [*made.inner, made.floor], WALL)
    widen(recorder, [made.floor], 0.5)


@dataclass(frozen=True)
class Bead:
    """A bulge around a stem, of four rings."""

    component: Component
    rings: tuple[Ring, ...]

    def whole(self, around: Ring = ()) -> Target:
        """Return it as a target along the model's axes, to be scaled about a ring of the stem or its own centre."""
        return Target((self.component.whole,), "world", (), around)


def bead(recorder: Recorder, around: Ring, height: float, drop: float, *, core: float = 0.35) -> Bead:
    """Put a bead of diameter 1 around a stem.

    Args:
        around: the ring of the stem that it hangs on.
        drop: how far its upper end lies below that ring.
        core: diameter of its ends, relative to its own.
    """
    step = height / 3
    offset = (0.0, 0.0, -drop - height)
    made = recorder.prism(
        SIDES, control_diameter(1.0, SIDES), step, offset=offset, anchor=group(*around, frame="world")
    )
    column = Lathe(recorder, made)
    rings = (column.bottom, column.top, column.rise(step), column.rise(step))
    widen(recorder, [rings[0], rings[-1]], core)
    return Bead(made, rings)
