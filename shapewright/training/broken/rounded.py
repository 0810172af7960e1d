"""Rounded vertices: positions on a coarse grid."""

from typing import Final

import numpy as np

from shapewright.mesh import TriangleMesh
from shapewright.training.broken.grid_turns import grid_turn

CELLS: Final = (12, 64)
"""Along the longest side of the object, smallest and largest number."""


def round_vertices(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Move every vertex to the nearest point of a grid; what has collapsed stays in place.

    A mesh that would lose all its area is returned as it was.
    """
    turn = grid_turn(rng)
    turned = mesh.vertices @ turn.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    side = float((high - low).max()) / float(np.exp(rng.uniform(*np.log(CELLS))))
    corner = low - side * rng.random(3)
    rounded = TriangleMesh((corner + side * np.round((turned - corner) / side)) @ turn, mesh.faces)
    return rounded if rounded.area > 0.1 * mesh.area else mesh
