"""Modelling aid for bars and boxes: a row of cross-sections in any direction, square or round, with chosen creases.

Unlike a loft a beam starts at its anchor and grows away from it, so what lies beyond a section can be bent about it.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal

import numpy as np

from models_store.library.aids.lathe import Ring
from models_store.library.aids.loft import ORIGIN, Loft, Section, Vector, move
from shapewright.modeling import Element, Recorder, Target
from shapewright.modeling.elements import Axis

Direction = Literal["+x", "-x", "+y", "-y", "+z", "-z"]
Crease = Literal["all", "long", "ends"]
_ACROSS: dict[Axis, tuple[str, str]] = {"x": ("v", "z"), "y": ("u", "z"), "z": ("u", "v")}
_AXES: dict[str, Axis] = {"x": "x", "y": "y", "z": "z"}
_TOLERANCE = 1e-9


def beam(
    recorder: Recorder,
    direction: Direction,
    sections: Sequence[Section],
    *,
    sides: int = 4,
    crease: Crease | None = None,
    offset: Vector = ORIGIN,
    anchors: Target | Sequence[Target] = (),
) -> Loft:
    """Model a bar through at least two sections, whose places rise along a direction.

    Of 4 sides a section is a rectangle, of 8 an octagon with vertices at both ends of both directions, which
    subdivision rounds (and draws in by a tenth).

    Args:
        crease: what stays sharp: every edge, the edges along the bar and both its ends, or its ends only. None:
            "long" for rectangles, "ends" for others.
        offset: where place 0 lies, from the anchor along the axes of the model.
        anchors: what the bar and each symmetric copy hang on, with world frames.
    """
    anchors = (anchors,) if isinstance(anchors, Target) else tuple(anchors)
    anchors = anchors or (Target((), "world"),)
    images = tuple(anchor.image for anchor in anchors)
    axis: Axis = _AXES[direction[1]]
    forward = direction[0] == "+"
    sign = 1.0 if forward else -1.0
    first, second = sections[0], sections[1]
    length = second.at - first.at
    stand = {"x": offset[0], "y": offset[1], "z": offset[2]}
    stand[axis] += sign * first.at
    shape: Literal["box", "prism"] = "box" if sides == 4 else "prism"
    place = (stand["x"], stand["y"], stand["z"] - (0.0 if forward else length))
    components = recorder.base(shape, (1.0, 1.0, length), sides=sides, offset=place, anchors=anchors)
    ends = [c.top if forward else c.bottom for c in components]
    starts = [c.bottom if forward else c.top for c in components]
    rings: list[tuple[Ring, ...]] = [tuple(_ring(recorder, starts)), tuple(_ring(recorder, ends))]
    if axis != "z":
        about, angle_deg = ("v", 90.0) if axis == "x" else ("u", -90.0)
        wholes = [
            Target((c.whole,), "world", image, ring)
            for c, image, ring in zip(components, images, rings[0], strict=True)
        ]
        recorder.rotate(wholes, angle_deg, about)
    for before, after in pairwise(sections[1:]):
        recorder.extrude([Target((face,)) for face in ends], after.at - before.at)
        rings.append(tuple(_ring(recorder, ends)))
    made = Loft(tuple(components), images, tuple(rings))
    _crease(recorder, made, [*starts, *ends], crease or ("long" if sides == 4 else "ends"))
    for number, section in enumerate(sections):
        targets = made.sections(number)
        for name, extent in zip(_ACROSS[axis], (section.width, section.height), strict=True):
            recorder.scale(targets, extent, name)
        if section.shift != (0.0, 0.0):
            across = [name for name in "xyz" if name != axis]
            by = {axis: 0.0, **dict(zip(across, section.shift, strict=True))}
            move(recorder, targets, (by["x"], by["y"], by["z"]))
    return made


def at(recorder: Recorder, body: Loft, numbers: int | Sequence[int], *directions: Vector) -> Target:
    """Return an anchor on a body: of these sections what lies farthest in each direction (none: all of them)."""
    numbers = (numbers,) if isinstance(numbers, int) else numbers
    found = [vertex for number in numbers for vertex in _farthest(recorder, body.rings[number][0], directions)]
    return Target(tuple(found), "world")


def upper(recorder: Recorder, body: Loft, *numbers: int) -> Target:
    """Return an anchor in the middle of what lies highest of some sections."""
    return at(recorder, body, numbers, (0.0, 0.0, 1.0))


def lower(recorder: Recorder, body: Loft, *numbers: int) -> Target:
    """Return an anchor in the middle of what lies lowest of some sections."""
    return at(recorder, body, numbers, (0.0, 0.0, -1.0))


def _farthest(recorder: Recorder, ring: Ring, directions: Sequence[Vector]) -> Ring:
    for direction in directions:
        reach = [float(recorder.positions(vertex)[0] @ np.array(direction)) for vertex in ring]
        ring = tuple(vertex for vertex, r in zip(ring, reach, strict=True) if r > max(reach) - _TOLERANCE)
    return ring


def _ring(recorder: Recorder, faces: Sequence[Element]) -> list[Ring]:
    return [tuple(recorder.vertices_of(face)) for face in faces]


def _crease(recorder: Recorder, body: Loft, ends: Sequence[Element], crease: Crease) -> None:
    if crease == "all":
        recorder.mark_sharp(*(face for component in body.components for face in recorder.faces_of(component)))
        return
    recorder.mark_sharp(*ends)
    if crease == "long":
        edges = []
        for copy in range(len(body.components)):
            for here, there in pairwise(rings[copy] for rings in body.rings):
                beyond = np.concatenate([recorder.positions(vertex) for vertex in there])
                for vertex in here:
                    nearest = np.linalg.norm(beyond - recorder.positions(vertex), axis=1).argmin()
                    edges.append(Element("edge", recorder.mesh.edge_between(vertex.id, there[nearest].id)))
        recorder.mark_sharp(*edges)
