"""Blocks: an object built of little cubes, or swollen by half a cube, as voxel grids leave it."""

from typing import Final

import numpy as np

from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.training.broken.dense_points import dense_points
from shapewright.training.broken.grid_turns import grid_turn

BLOCKS: Final = (20, 80)
"""Along the longest side of the object, smallest and largest number; drawn on a logarithmic scale."""


def build_of_blocks(mesh: TriangleMesh, rng: np.random.Generator) -> PointCloud:
    """Move points of the surface to the sides of the blocks that they lie in.

    Half of the objects are not built of blocks, but swollen by about as much: every point moves by half a block in a
    direction of its own.
    """
    points = dense_points(mesh)
    turn = grid_turn(rng)
    turned = points @ turn.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    side = float((high - low).max()) / float(np.exp(rng.uniform(*np.log(BLOCKS))))
    if rng.random() < 0.5:
        directions = rng.normal(size=points.shape)
        return PointCloud(points + 0.5 * side * directions / np.linalg.norm(directions, axis=1)[:, None])
    corner = low - side * rng.random(3)
    cells = np.floor((turned - corner) / side)
    places = rng.random(points.shape)
    axis = rng.integers(3, size=len(points))
    places[np.arange(len(points)), axis] = rng.integers(2, size=len(points))
    return PointCloud((corner + side * (cells + places)) @ turn)
