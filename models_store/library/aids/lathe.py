"""Modelling aid for round parts: a column of rings, sketched straight first, then given its profile.

A ring's width is set by scaling its vertices about the axis after the whole column stands. So every width and every
height is a number of its own: widening the stem of a glass leaves its bowl as it is.
"""

import math

from shapewright.modeling import Component, Element, Recorder, Target, group
from shapewright.modeling.elements import Turn

Ring = tuple[Element, ...]


class Lathe:
    """Raises the top of a component ring by ring, or sinks its bottom: then ``bottom`` is the ring where it began."""

    def __init__(self, recorder: Recorder, component: Component, *, downwards: bool = False) -> None:
        first, last = component.bottom, component.top
        if downwards:
            first, last = last, first
        self._recorder = recorder
        self.face = last
        self.bottom: Ring = tuple(recorder.vertices_of(first))
        self.top: Ring = tuple(recorder.vertices_of(last))

    def rise(self, by: float, *, length: str = "") -> Ring:
        """Extrude by a distance (below 0: back down, for an inner wall) and return the new ring.

        ``length`` names the parameter that varies it, if any.
        """
        if length:
            self._recorder.extrude(self.face, by, length=length)
        else:
            self._recorder.extrude(self.face, by)
        self.top = tuple(self._recorder.vertices_of(self.face))
        return self.top


def widen(recorder: Recorder, rings: list[Ring], sigma: float, *, size: str = "") -> None:
    """Scale rings about their common axis, across the z axis of the model; ``size`` names a parameter, if any."""
    target = group(*(vertex for ring in rings for vertex in ring), frame="world")
    if size:
        recorder.scale(target, sigma, "uv", size=size)
    else:
        recorder.scale(target, sigma, "uv")


def draw_in(recorder: Recorder, rings: list[Ring], by: float, *, length: str = "") -> None:
    """Move rings towards the z axis by a distance (below 0: away from it), each vertex along its own radius.

    Unlike :func:`widen` it adds. ``length`` names the parameter that varies it, if any.
    """
    vertices = [vertex for ring in rings for vertex in ring]
    bearings = [_bearing_deg(recorder, vertex) for vertex in vertices]
    turns = [round(bearing - bearings[0], 6) for bearing in bearings]
    targets = [
        Target((vertex,), "world", (Turn("z", turn),) if index else ())
        for index, (vertex, turn) in enumerate(zip(vertices, turns, strict=True))
    ]
    if length:
        recorder.drag(targets, rho=by, phi_deg=bearings[0] + 180.0, length=length)
    else:
        recorder.drag(targets, rho=by, phi_deg=bearings[0] + 180.0)


def _bearing_deg(recorder: Recorder, vertex: Element) -> float:
    x, y, _ = recorder.positions(vertex)[0]
    return round(math.degrees(math.atan2(y, x)), 6)


def control_diameter(diameter: float, sides: int) -> float:
    """Return the diameter of the regular polygon whose subdivision ends as a circle of this diameter.

    A ring of control vertices ends on the uniform cubic B-spline curve, which lies inside by (2 + cos(2 pi / n)) / 3.
    """
    return diameter * 3 / (2 + math.cos(2 * math.pi / sides))
