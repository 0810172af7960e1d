"""Dust: specks far from an object, which would decide its size and its middle if they counted (ours)."""

from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.distances.even_places import even_places
from shapewright.mesh import TriangleMesh

_SAMPLES: Final = 2000
_BULK: Final = (0.005, 0.995)
"""Shares of the area below and above which nothing belongs to the bulk of an object, along each axis."""
_ROOM: Final = 0.25
"""What reaches no farther beyond the bulk, in diagonals of it, is never dust: thin rods have little area."""
_GAP: Final = 0.1
"""How far apart things are, in the same unit, that belong together."""
_MOST_AREA: Final = 0.01
"""Share of the whole area above which what is far is an object of its own."""


def without_dust(mesh: TriangleMesh) -> TriangleMesh:
    """Return the mesh without what is far from all the rest and has hardly any area; itself if there is nothing so.

    From the bulk of the surface the object is followed outward for as long as there is no gap. Vertices that no
    triangle uses go with the dust.
    """
    if not mesh.area > 0:
        return mesh
    low, high = _bulk(mesh)
    diagonal = float(np.linalg.norm(high - low))
    low, high = low - _ROOM * diagonal, high + _ROOM * diagonal
    if ((mesh.vertices >= low) & (mesh.vertices <= high)).all():
        return mesh
    corners = mesh.triangles
    lows, highs = corners.min(axis=1), corners.max(axis=1)
    kept = np.zeros(len(mesh.faces), dtype=bool)
    while True:
        reached = ~kept & (lows <= high + _GAP * diagonal).all(axis=1) & (highs >= low - _GAP * diagonal).all(axis=1)
        if not reached.any():
            break
        kept |= reached
        low = np.minimum(low, lows[reached].min(axis=0))
        high = np.maximum(high, highs[reached].max(axis=0))
    if mesh.face_areas[~kept].sum() > _MOST_AREA * mesh.area:
        return mesh
    used, renumbered = np.unique(mesh.faces[kept], return_inverse=True)
    if len(used) == len(mesh.vertices):
        return mesh
    return TriangleMesh(mesh.vertices[used], renumbered.reshape(-1, 3))


def _bulk(mesh: TriangleMesh) -> Float[np.ndarray, "2 3"]:
    """Return the smallest and largest coordinates of most of the surface."""
    faces, weights = even_places(mesh.face_areas, _SAMPLES)
    points = np.einsum("nk,nkd->nd", weights, mesh.vertices[mesh.faces[faces]])
    return np.asarray(np.quantile(points, _BULK, axis=0))
