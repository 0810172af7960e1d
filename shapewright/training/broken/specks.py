"""Specks: little pieces that float so near to an object that nothing tells them from it."""

from typing import Final

import numpy as np

from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.training.broken.dense_points import dense_points

COUNTS: Final = (8, 200)
"""Smallest and largest number, drawn on a logarithmic scale."""
FARTHEST: Final = 0.06
"""Distance from the surface, in diagonals, that no speck exceeds; what floats farther away is left out of queries."""
SIZES: Final = (0.003, 0.015)
"""Smallest and largest side of the cube that holds a speck, in diagonals."""
_POINTS: Final = 6
"""Of one speck at most."""


def add_specks(mesh: TriangleMesh | PointCloud, rng: np.random.Generator) -> PointCloud:
    """Add small groups of points at random places about the surface."""
    points = dense_points(mesh)
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    count = int(np.exp(rng.uniform(*np.log(COUNTS))))
    directions = rng.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    away = FARTHEST * rng.random((count, 1))
    middles = points[rng.integers(len(points), size=count)] + diagonal * away * directions
    sizes = diagonal * rng.uniform(*SIZES, size=count)
    of_point = np.repeat(np.arange(count), rng.integers(1, _POINTS + 1, size=count))
    shifts = rng.uniform(-0.5, 0.5, (len(of_point), 3)) * sizes[of_point, None]
    return PointCloud(np.concatenate([points, middles[of_point] + shifts]))
