"""Few points: a point cloud that is much thinner than a surface."""

from typing import Final

import numpy as np

from shapewright.distances.surface import uniform_points
from shapewright.mesh import PointCloud, TriangleMesh

COUNTS: Final = (700, 6000)
"""Smallest and largest number of points, drawn on a logarithmic scale."""
_NOISE: Final = 0.004
"""Largest standard deviation of the noise in half of the clouds, as a share of the diagonal."""


def keep_few_points(mesh: TriangleMesh, rng: np.random.Generator) -> PointCloud:
    """Return independent random points of the surface, half of the time with a little noise."""
    points = uniform_points(mesh, int(np.exp(rng.uniform(*np.log(COUNTS)))), rng=rng)
    diagonal = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    deviation = max(0.0, rng.uniform(-_NOISE, _NOISE)) * diagonal
    return PointCloud(points + deviation * rng.normal(size=points.shape))
