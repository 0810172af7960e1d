"""Exact distances of points to triangle soup, for what people are shown of a fit.

The distances that decide (:mod:`shapewright.distances.surface`, :mod:`shapewright.distances.zbuffer`) follow the paper;
these say where a fit and its query part.
"""

import numpy as np
from jaxtyping import Float, Int

from shapewright.distances.triangle_kernel import LEAF_FACES, nearest_faces
from shapewright.mesh import TriangleMesh


class TriangleDistance:
    """The distance to the surface of one mesh, whose search tree is built once; call it with points.

    Any soup will do: sheets count from both sides, and a triangle without area is the line or point that it is.
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        corners = mesh.triangles
        points = corners.reshape(-1, 3)
        self._low, self._high = points.min(axis=0), points.max(axis=0)
        self._order = np.argsort(self._codes(corners.mean(axis=1)), kind="stable")
        self._corners = np.ascontiguousarray(corners[self._order])
        self._boxes = _tree(self._corners)

    def __call__(self, points: Float[np.ndarray, "N 3"]) -> Float[np.ndarray, " N"]:
        """Return the distance of each point to the nearest triangle."""
        return self.nearest(points)[0]

    def nearest(self, points: Float[np.ndarray, "N 3"]) -> tuple[Float[np.ndarray, " N"], Int[np.ndarray, " N"]]:
        """Return the distance of each point to the nearest triangle, and the number of that triangle."""
        order = np.argsort(self._codes(points), kind="stable")
        distances, faces = np.empty(len(points)), np.empty(len(points), dtype=np.int64)
        ordered = np.ascontiguousarray(points[order], dtype=np.float64)
        found, numbers = np.empty(len(points)), np.empty(len(points), dtype=np.int64)
        nearest_faces(ordered, self._corners, *self._boxes, found, numbers)
        distances[order], faces[order] = found, self._order[numbers]
        return distances, faces

    def _codes(self, points: Float[np.ndarray, "N 3"]) -> Int[np.ndarray, " N"]:
        """Return Morton codes of 10 bits an axis in the bounds of the mesh: near in space is mostly near in order."""
        extent = self._high - self._low
        shares = (points - self._low) / np.where(extent > 0, extent, 1.0)
        bits = (np.clip(shares, 0.0, 1.0) * 1023.0).astype(np.int64)
        for shift, mask in ((16, 0x030000FF), (8, 0x0300F00F), (4, 0x030C30C3), (2, 0x09249249)):
            bits = (bits | bits << shift) & mask
        return bits[:, 0] | bits[:, 1] << 1 | bits[:, 2] << 2


def _tree(corners: Float[np.ndarray, "F 3 3"]) -> tuple[Float[np.ndarray, "M 3"], Float[np.ndarray, "M 3"]]:
    """Return the boxes of a complete binary tree over ordered triangles, see :func:`nearest_faces`."""
    starts = np.arange(0, len(corners), LEAF_FACES)
    n_leaves = 1 << max(len(starts) - 1, 1).bit_length()
    low, high = np.full((2 * n_leaves, 3), np.inf), np.full((2 * n_leaves, 3), -np.inf)
    first, second, third = corners[:, 0], corners[:, 1], corners[:, 2]  # much faster than a reduction over three
    low[n_leaves : n_leaves + len(starts)] = np.minimum.reduceat(np.minimum(np.minimum(first, second), third), starts)
    high[n_leaves : n_leaves + len(starts)] = np.maximum.reduceat(np.maximum(np.maximum(first, second), third), starts)
    size = n_leaves
    while size > 1:
        half = size // 2
        low[half:size] = low[size : 2 * size].reshape(half, 2, 3).min(axis=1)
        high[half:size] = high[size : 2 * size].reshape(half, 2, 3).max(axis=1)
        size = half
    return low, high
