"""Holes: patches that are missing."""

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.training.broken.dense_points import dense_points

SHARES: Final = (0.05, 0.5)
"""Smallest and largest share of the surface that is missing."""
_RADII: Final = (0.02, 0.12)
"""Of a patch, in diagonals."""


def lose_patches(mesh: TriangleMesh | PointCloud, rng: np.random.Generator) -> PointCloud:
    """Take balls of one size away, about random points of the surface, until a random share of it is missing."""
    points = dense_points(mesh)
    diagonal = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    share = rng.uniform(*SHARES)
    radius = float(np.exp(rng.uniform(*np.log(_RADII)))) * diagonal
    tree = cKDTree(points)
    kept = np.ones(len(points), dtype=bool)
    for middle in rng.permutation(len(points)):
        if kept[middle]:
            gone = np.asarray(tree.query_ball_point(points[middle], radius))
            if kept.sum() - kept[gone].sum() < 0.4 * len(points):
                break
            kept[gone] = False
            if kept.sum() < (1.0 - share) * len(points):
                break
    return PointCloud(points[kept])
