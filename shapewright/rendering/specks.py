"""Point clouds as meshes that can be drawn: a small tetrahedron at each point."""

from typing import Final

import numpy as np

from shapewright.mesh import PointCloud, TriangleMesh

MOST_SPECKS: Final = 20_000
"""Of a larger cloud, as many points are drawn, evenly taken."""
_CORNERS: Final = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=np.float64)
_FACES: Final = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
_COVER: Final = 0.8
"""Size of a speck, as a share of the spacing that points on a sphere of this extent have."""


def specks(cloud: PointCloud) -> TriangleMesh:
    """Return a mesh that shows the points of a cloud."""
    taken = np.linspace(0, len(cloud.points) - 1, min(len(cloud.points), MOST_SPECKS)).astype(np.int64)
    points = cloud.points[taken]
    low, high = cloud.bounds
    size = _COVER * float(np.linalg.norm(high - low)) / np.sqrt(len(points))
    vertices = points[:, None] + 0.5 * size * _CORNERS
    faces = _FACES + 4 * np.arange(len(points))[:, None, None]
    return TriangleMesh(vertices.reshape(-1, 3), faces.reshape(-1, 3))
