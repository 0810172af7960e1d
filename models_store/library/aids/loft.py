"""Modelling aid for bodies of cross-sections along an axis of the model: fuselages, hulls, limbs, wings, barrels.

A body may have symmetric copies (two wings, four legs), which are modelled together and stay symmetric. Everything
is sketched straight; sizes, shifts and bends are inserted as operations of their own, so each can be a parameter.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from models_store.library.aids.lathe import Lathe, Ring
from shapewright.errors import ModelError
from shapewright.modeling import Component, Element, Mirror, Recorder, Target
from shapewright.modeling.elements import Axis, Image

Vector = tuple[float, float, float]
ORIGIN: Vector = (0.0, 0.0, 0.0)
_WORLD_NAMES = dict(zip("xyz", "uvz", strict=True))


@dataclass(frozen=True)
class Section:
    """One cross-section of the control mesh.

    Attributes:
        at: place along the axis.
        width, height: extents across it: along y and z for an axis x, x and z for y, x and y for z.
        shift: how far its centre lies off the axis, along the same two directions.
    """

    at: float
    width: float
    height: float
    shift: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Loft:
    """A body and its symmetric copies; the methods return targets for the recorder, along the model's axes.

    Attributes:
        components: the body, then its copies. ``bottom`` is the face at the first section, ``top`` at the last.
        images: what maps the body onto each of them; empty for the body itself.
        rings: ``rings[section][copy]``, the vertices of a section.
    """

    components: tuple[Component, ...]
    images: tuple[Image, ...]
    rings: tuple[tuple[Ring, ...], ...]

    @property
    def component(self) -> Component:
        """The body itself."""
        return self.components[0]

    def body(self, *, hinge: int | None = None) -> list[Target]:
        """Return the whole body and its copies; ``hinge`` is the section about which to scale or turn them."""
        wholes = [(component.whole,) for component in self.components]
        return self._targets(wholes, hinge)

    def sections(self, *numbers: int) -> list[Target]:
        """Return sections, each a target of its own: scaling sizes each about its own centre."""
        return [target for number in numbers for target in self._targets(list(self.rings[number]), None)]

    def beyond(self, first: int, *, hinge: int | None = None) -> list[Target]:
        """Return all sections from one on, as one target a copy; ``hinge`` as in :meth:`body`."""
        return self._targets(
            [tuple(v for ring in self.rings[first:] for v in ring[copy]) for copy in range(len(self.images))], hinge
        )

    def vertex(self, recorder: Recorder, number: int, direction: Vector) -> Element:
        """Return the vertex of a section of the body itself that lies farthest in a direction."""
        along = np.array(direction)
        return max(self.rings[number][0], key=lambda vertex: float(recorder.positions(vertex)[0] @ along))

    def _targets(self, elements: Sequence[tuple[Element, ...]], hinge: int | None) -> list[Target]:
        pivots = [() for _ in self.images] if hinge is None else self.rings[hinge]
        return [
            Target(part, "world", image, pivot)
            for part, image, pivot in zip(elements, self.images, pivots, strict=True)
        ]


def loft(
    recorder: Recorder,
    axis: Axis,
    sections: Sequence[Section],
    *,
    sides: int = 8,
    offset: Vector = ORIGIN,
    anchors: Sequence[Target] = (),
) -> Loft:
    """Model a body through at least two sections whose places rise along an axis.

    Of 8 sides each section has vertices at both ends of both directions.

    Args:
        offset: where place 0 of the axis lies, from the anchor.
        anchors: what the body and each copy hang on, with world frames: ``pair(left, right)``, or one target.

    Raises:
        ModelError: an anchor with another frame.
    """
    anchors = anchors or (Target((), "world"),)
    if any(anchor.frame != "world" for anchor in anchors):
        raise ModelError("a loft hangs on anchors with world frames")
    images = tuple(anchor.image for anchor in anchors)
    first, second = sections[0], sections[1]
    across = [name for name in "xyz" if name != axis]
    place = dict(zip("xyz", offset, strict=True))
    place[axis] += first.at
    size = (1.0, 1.0, round(second.at - first.at, 9))
    components = recorder.base("prism", size, sides=sides, offset=(place["x"], place["y"], place["z"]), anchors=anchors)
    columns = [Lathe(recorder, component) for component in components]
    rings = [tuple(column.bottom for column in columns), tuple(column.top for column in columns)]
    if axis != "z":
        about, angle_deg = ("v", 90.0) if axis == "x" else ("u", -90.0)
        standing = Loft(tuple(components), images, tuple(rings))
        recorder.rotate(standing.body(hinge=0), angle_deg, about)
    tops = [component.top for component in components]
    for before, after in pairwise(sections[1:]):
        recorder.extrude([Target((top,)) for top in tops], round(after.at - before.at, 9))
        rings.append(tuple(tuple(recorder.vertices_of(top)) for top in tops))
    made = Loft(tuple(components), images, tuple(rings))
    for number, section in enumerate(sections):
        targets = made.sections(number)
        for name, extent in zip(across, (section.width, section.height), strict=True):
            recorder.scale(targets, extent, _WORLD_NAMES[name])
        if section.shift != (0.0, 0.0):
            by = {axis: 0.0, **dict(zip(across, section.shift, strict=True))}
            move(recorder, targets, (by["x"], by["y"], by["z"]))
    return made


def pair(first: Element, second: Element, mirror: Axis = "y") -> list[Target]:
    """Return anchors, or things to move, of which the second is the mirror image of the first."""
    return [Target((first,), "world"), Target((second,), "world", (Mirror(mirror),))]


def move(recorder: Recorder, targets: Sequence[Target], by: Vector, **varies: str) -> None:
    """Drag targets with world frames by a vector; modes as :meth:`Recorder.drag` (``length`` is all of it)."""
    x, y, z = by
    recorder.drag(targets, z, math.hypot(x, y), math.degrees(math.atan2(y, x)), **varies)
