"""Points alone: a scan before anyone has made a surface of it."""

from typing import Final

import numpy as np

from shapewright.distances.surface import uniform_points
from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.point_cloud import LEAST_POINTS


def take_points(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> PointCloud:
    """Return independent random points on the surface, every piece of area alike.

    Args:
        mesh: any surface.
        strength: number of points, rounded.
        rng: source of the points.

    Raises:
        MeshError: the mesh has no area.
    """
    return PointCloud(uniform_points(mesh.cleaned(), round(strength), rng=rng))


POINTS: Final = Corruption(
    name="points",
    meaning="points that are left in place of the surface",
    strengths=(4096.0, 2048.0, 1024.0),
    default=2048.0,
    least=float(LEAST_POINTS),
    most=1_000_000.0,
    corrupt=take_points,
    has_faces=False,
)
