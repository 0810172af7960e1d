"""Surfels: a point cloud as many small triangles, for what needs a surface (Pfister et al. 2000)."""

from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.spatial import cKDTree

from shapewright.mesh.triangle_mesh import TriangleMesh

MOST: Final = 2_500
"""Surfels at most; of more points, every k-th gets a surfel, and the others only help to fit the planes."""
_NEIGHBORS: Final = 48
"""Points that span the plane of a surfel, itself among them."""
_SIZE: Final = 1.35
"""Distance of a corner from the middle, in spacings. A surfel is 2.4 times as large as the square that its point has to
itself: surfels at random places then cover about nine tenths of the surface."""


def surfels(points: Float[np.ndarray, "N 3"], spacing: float) -> TriangleMesh:
    """Return a triangle for each point, in the plane that fits the point's neighbors best.

    A triangle lies in this plane, not at the point itself, which takes some noise away.

    Args:
        points: on a surface, at random or spread evenly; at least one.
        spacing: side of the square that each point has to itself on the surface.
    """
    chosen = points[:: max(1, -(-len(points) // MOST))]
    near = points[cKDTree(points).query(chosen, k=min(_NEIGHBORS, len(points)))[1].reshape(len(chosen), -1)]
    middles = near.mean(axis=1)
    offsets = near - middles[:, None]
    _, axes = np.linalg.eigh(np.einsum("nki,nkj->nij", offsets, offsets))  # the normal comes first
    normals, first, second = axes[:, :, 0], axes[:, :, 1], axes[:, :, 2]
    centers = chosen - np.einsum("ni,ni->n", chosen - middles, normals)[:, None] * normals
    reach = _SIZE * spacing * np.sqrt(len(points) / len(chosen))
    angles_rad = 2.0 * np.pi / 3.0 * np.arange(3)
    corners = centers[:, None] + reach * (
        np.cos(angles_rad)[:, None] * second[:, None] + np.sin(angles_rad)[:, None] * first[:, None]
    )
    return TriangleMesh(corners.reshape(-1, 3), np.arange(3 * len(chosen)).reshape(-1, 3))
