"""Rounded vertices: positions on a coarse grid."""

from typing import Final

import numpy as np

from shapewright.mesh import TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges
from shapewright.training.broken.grid_turns import grid_turn

CELLS: Final = (12, 64)
"""Along the longest side of the object, smallest and largest number."""
LONGEST_EDGES: Final = (0.015, 0.12)
"""Smallest and largest length, in diagonals, that edges are cut to first; drawn on a logarithmic scale."""
_CUT: Final = 2.0 / 3.0
"""Share of the objects whose edges are cut: a rounded flat face stays flat, while one of many vertices gets steps."""


def round_vertices(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Move every vertex to the nearest point of a grid; what has collapsed stays in place.

    The edges of most objects are cut before, to a random length. A mesh that would lose all its area is returned as
    it was.
    """
    turn = grid_turn(rng)
    fine = mesh
    if rng.random() < _CUT:
        low, high = mesh.bounds
        fine = cut_edges(mesh, float(np.exp(rng.uniform(*np.log(LONGEST_EDGES))) * np.linalg.norm(high - low)), rng)
    turned = fine.vertices @ turn.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    side = float((high - low).max()) / float(np.exp(rng.uniform(*np.log(CELLS))))
    corner = low - side * rng.random(3)
    rounded = TriangleMesh((corner + side * np.round((turned - corner) / side)) @ turn, fine.faces)
    return rounded if rounded.area > 0.1 * mesh.area else mesh
