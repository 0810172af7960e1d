"""Modelling aid for furniture: sharp-edged boards between two corners, and sizes that stretch many components at once.

Furniture is modelled at its base size. A size is then inserted by pulling everything on one side of a plane away from
it: legs move, boards and rails that cross the plane grow, so all stay joined. A pull is two drags, back by the base
size and out again by x times the base size, and so nothing at x = 1.
"""

import math
from collections.abc import Iterable, Sequence

from models_store.library.aids.loft import Vector, move
from shapewright.modeling import Component, Element, Mirror, Recorder, Target
from shapewright.modeling.elements import AXES, Axis, Image

ALONE: tuple[Image, ...] = ((),)
ACROSS: dict[Axis, tuple[Image, ...]] = {axis: ((), (Mirror(axis),)) for axis in AXES}
"""Something and its mirror image."""
QUADRANTS: tuple[Image, ...] = ((), (Mirror("x"),), (Mirror("x"), Mirror("y")), (Mirror("y"),))
"""What is modelled at +x, +y, and its images over the four corners."""
TOLERANCE = 1e-9


def board(recorder: Recorder, low: Vector, high: Vector, images: Sequence[Image] = ALONE) -> list[Component]:
    """Model a sharp-edged box between two opposite corners, and its images."""
    size = (high[0] - low[0], high[1] - low[1], high[2] - low[2])
    offset = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2])
    boards = recorder.base("box", size, offset=offset, anchors=placed(images))
    recorder.mark_sharp(*(face for made in boards for face in made.faces))
    return boards


def strut(
    recorder: Recorder, low: Vector, high: Vector, size: tuple[float, float], images: Sequence[Image] = ALONE
) -> list[Component]:
    """Model a slanting bar between the middles of its level ends, and its images; ``size`` is its extent in x and y."""
    x, y = size[0] / 2, size[1] / 2
    bars = board(recorder, (low[0] - x, low[1] - y, low[2]), (low[0] + x, low[1] + y, high[2]), images)
    tops = [Target((bar.top,), "world", image) for bar, image in zip(bars, images, strict=True)]
    move(recorder, tops, (high[0] - low[0], high[1] - low[1], 0.0))
    return bars


def placed(images: Iterable[Image]) -> list[Target]:
    """Return anchors at the origin of the model, one an image."""
    return [Target((), "world", image) for image in images]


def stretch(
    recorder: Recorder, components: Iterable[Component], axis: Axis, half: float, name: str, *, beyond: float = 0.0
) -> None:
    """Let a parameter move what lies beyond +-``beyond`` along an axis outwards, by ``half`` times x - 1."""
    column = AXES.index(axis)
    chosen = list(components)
    targets = [
        Target(tuple(_beyond(recorder, chosen, column, sign, beyond)), "world", image)
        for sign, image in zip((1.0, -1.0), ACROSS[axis], strict=True)
    ]
    along = tuple(half if other == axis else 0.0 for other in AXES)
    shift(recorder, targets, (along[0], along[1], along[2]), name)


def spread(
    recorder: Recorder, components: Iterable[Component], axis: Axis, half: float, edge: float, name: str
) -> None:
    """Let a parameter move components outwards, those at ``edge`` like :meth:`stretch`, those within in proportion."""
    column = AXES.index(axis)
    distances: dict[float, tuple[list[Component], list[Component]]] = {}
    for component in components:
        at = float(recorder.centre(component.whole)[column])
        if abs(at) > TOLERANCE:
            distances.setdefault(round(abs(at), 6), ([], []))[int(at < 0)].append(component)
    for distance, sides in distances.items():
        stretch(recorder, [*sides[0], *sides[1]], axis, half * distance / edge, name)


def pull(
    recorder: Recorder, components: Iterable[Component], axis: Axis, by: float, name: str, *, beyond: float
) -> None:
    """Let a parameter move what lies beyond a place along an axis by ``by`` times x - 1.

    ``by`` above 0 moves what lies above the place, upwards; below 0 what lies below it, downwards.
    """
    found = _beyond(
        recorder, list(components), AXES.index(axis), math.copysign(1.0, by), math.copysign(1.0, by) * beyond
    )
    along = tuple(by if other == axis else 0.0 for other in AXES)
    shift(recorder, [Target(tuple(found), "world")], (along[0], along[1], along[2]), name)


def shift(recorder: Recorder, targets: Sequence[Target], by: Vector, name: str) -> None:
    """Let a parameter move targets with world frames by x - 1 times a vector."""
    move(recorder, targets, (-by[0], -by[1], -by[2]))
    move(recorder, targets, by, length=name)


def _beyond(
    recorder: Recorder, components: Sequence[Component], column: int, sign: float, place: float
) -> list[Element]:
    """Return what lies beyond a place on one side: components as a whole where all of them does, else vertices."""
    found: list[Element] = []
    for component in components:
        vertices = recorder.vertices_of(component.whole)
        moved = [v for v in vertices if sign * recorder.positions(v)[0, column] > place + TOLERANCE]
        found += [component.whole] if len(moved) == len(vertices) else moved
    return found
