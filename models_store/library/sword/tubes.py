"""Modelling aid for bent rods: tubes along a path in a plane, such as the bows, rings and hooks of a sword's guard."""

import math
from collections.abc import Sequence
from itertools import pairwise

from models_store.library.aids.lathe import Lathe
from models_store.library.aids.loft import Loft, Vector
from shapewright.modeling import Recorder, Target
from shapewright.modeling.elements import Axis


def tube(
    recorder: Recorder,
    path: Sequence[Vector],
    widths: Sequence[float],
    *,
    normal: Axis,
    anchors: Sequence[Target],
    sides: int = 6,
    lengths: Sequence[str] = (),
) -> Loft:
    """Model a rod through the points of a path, its sections across the path.

    Args:
        path: at least two points from the anchor, in a plane with the given normal (y or z).
        widths: diameter of the control mesh at each point.
        anchors: what the rod and each symmetric copy hang on, with world frames; only the first may have no image.
        lengths: for each piece of the path but the first, the parameter that varies its length; empty: none.
    """
    images = tuple(anchor.image for anchor in anchors)
    pieces = [tuple(b - a for a, b in zip(start, end, strict=True)) for start, end in pairwise(path)]
    bearings = [math.degrees(math.atan2(x, z) if normal == "y" else math.atan2(y, x)) for x, y, z in pieces]
    first = math.hypot(*pieces[0])
    components = recorder.base("prism", (1.0, 1.0, first), sides=sides, offset=path[0], anchors=anchors)
    columns = [Lathe(recorder, component) for component in components]
    rings = [tuple(column.bottom for column in columns), tuple(column.top for column in columns)]
    standing = Loft(tuple(components), images, tuple(rings))
    if normal == "z":
        recorder.rotate(standing.body(hinge=0), 90.0, "v")
    axis = "v" if normal == "y" else "z"
    if bearings[0]:
        recorder.rotate(standing.body(hinge=0), bearings[0], axis)
    tops = [component.top for component in components]
    names = lengths or [""] * (len(pieces) - 1)
    for (before, after), (x, y, z), name in zip(pairwise(bearings), pieces[1:], names, strict=True):
        turn = (after - before + 180.0) % 360.0 - 180.0
        ends = [Target(ring, "world", image) for ring, image in zip(rings[-1], images, strict=True)]
        if turn:
            recorder.rotate(ends, turn / 2, axis)
        faces = [Target((top,), "world", image) for top, image in zip(tops, images, strict=True)]
        varies = {"length": name} if name else {}
        recorder.extrude(faces, z, math.hypot(x, y), math.degrees(math.atan2(y, x)), **varies)
        rings.append(tuple(tuple(recorder.vertices_of(top)) for top in tops))
        if turn:
            ends = [Target(ring, "world", image) for ring, image in zip(rings[-1], images, strict=True)]
            recorder.rotate(ends, turn / 2, axis)
    made = Loft(tuple(components), images, tuple(rings))
    for number, width in enumerate(widths):
        recorder.scale(made.sections(number), width)
    return made


def arc(centre: Vector, radius: float, start_deg: float, end_deg: float, pieces: int, *, normal: Axis) -> list[Vector]:
    """Return points of an arc: from x towards z where the plane's normal is y, from x towards y where it is z."""
    points: list[Vector] = []
    for i in range(pieces + 1):
        angle = math.radians(start_deg + (end_deg - start_deg) * i / pieces)
        along, across = radius * math.cos(angle), radius * math.sin(angle)
        points.append(
            (centre[0] + along, centre[1], centre[2] + across)
            if normal == "y"
            else (centre[0] + along, centre[1] + across, centre[2])
        )
    return points
