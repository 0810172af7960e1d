"""One side only: what can be seen from one direction."""

from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.training.broken.dense_points import dense_points

PIXELS: Final = (48, 160)
"""Along each side of the depth picture that tells what is hidden; smallest and largest."""
_STEEP: Final = 2.5
"""Depth, in pixels, that the surface may have within a pixel."""
_LEAST_POINTS: Final = 50


def keep_visible(mesh: TriangleMesh, rng: np.random.Generator) -> PointCloud:
    """Keep the points that lie in front, seen along a random direction; that direction becomes -z.

    An object of which hardly anything would be left stays whole.
    """
    points = dense_points(mesh) @ Rotation.random(rng=rng).as_matrix().T
    low, high = points.min(axis=0), points.max(axis=0)
    side = float((high - low)[:2].max()) / int(rng.integers(PIXELS[0], PIXELS[1] + 1))
    if not side > 0:
        return PointCloud(points)
    cells = np.floor((points[:, :2] - low[:2]) / side).astype(np.int64)
    cell = cells[:, 0] * (int(cells[:, 1].max()) + 1) + cells[:, 1]
    front = np.full(int(cell.max()) + 1, -np.inf)
    np.maximum.at(front, cell, points[:, 2])
    seen = points[:, 2] > front[cell] - _STEEP * side
    return PointCloud(points[seen] if seen.sum() >= _LEAST_POINTS else points)
