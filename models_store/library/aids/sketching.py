"""Modelling aid for objects that are modelled piece by piece along the axes of the model: sign by sign, leg by leg.

Each call is one operation. Copies that are modelled one after another, left and then right, are the repeated
sequences in which automatic grouping looks for related operations.
"""

import math

import numpy as np

from shapewright.modeling import Element, Recorder, Target

Vector = tuple[float, float, float]


def put(*elements: Element, pivot: tuple[Element, ...] = ()) -> Target:
    """Return elements that move as one along the model's axes; ``pivot`` is their hinge."""
    return Target(elements, "world", pivot=pivot)


def grow(recorder: Recorder, face: Element, by: Vector, **varies: str) -> None:
    """Extrude a face by a vector; modes as :meth:`Recorder.extrude`."""
    x, y, z = by
    recorder.extrude(put(face), z, math.hypot(x, y), math.degrees(math.atan2(y, x)), **varies)


def push(recorder: Recorder, elements: Element | Target | list[Element], by: Vector, **varies: str) -> None:
    """Drag elements as one by a vector; modes as :meth:`Recorder.drag`."""
    x, y, z = by
    if isinstance(elements, list):
        elements = put(*elements)
    target = put(elements) if isinstance(elements, Element) else elements
    recorder.drag(target, z, math.hypot(x, y), math.degrees(math.atan2(y, x)), **varies)


def corner(recorder: Recorder, element: Element, towards: Vector) -> Element:
    """Return the vertex of an element that lies farthest in a direction."""
    along = np.array(towards)
    return max(recorder.vertices_of(element), key=lambda vertex: float(recorder.positions(vertex)[0] @ along))


def edge_towards(recorder: Recorder, face: Element, towards: Vector) -> Element:
    """Return the edge of a face whose middle lies farthest in a direction."""
    along = np.array(towards)
    return max(recorder.edges_of(face), key=lambda edge: float(recorder.centre(edge) @ along))
