"""One side only: what can be seen from one direction."""

from typing import Final

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from shapewright.distances.depth_kernels import WINDOW, draw_passes
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.training.broken.dense_points import dense_points

PIXELS: Final = 256
"""Along each side of the depth picture that tells what is hidden."""
_STEEP: Final = 3.0
"""Depth, in pixels, that the surface may have within a pixel."""
_LEAST_POINTS: Final = 50


def keep_visible(mesh: TriangleMesh, rng: np.random.Generator) -> PointCloud:
    """Keep the points that lie in front, seen along a random direction; that direction becomes -z.

    An object of which hardly anything would be left stays whole.
    """
    turn = Rotation.random(rng=rng).as_matrix()
    points = dense_points(mesh) @ turn.T
    seen = _is_seen(points, mesh.vertices @ turn.T, mesh)
    return PointCloud(points[seen] if seen.sum() >= _LEAST_POINTS else points)


def _is_seen(
    points: Float[np.ndarray, "N 3"], vertices: Float[np.ndarray, "V 3"], mesh: TriangleMesh
) -> Bool[np.ndarray, " N"]:
    """Tell which points on a mesh are visible along -z; points and vertices are in the same frame."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    zoom = 2.0 * 0.99 * WINDOW / float((high - low).max())
    frame = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]])
    middle = 0.5 * (low + high)
    views = np.empty((2, PIXELS, PIXELS), dtype=np.float32)
    draw_passes(np.ascontiguousarray(zoom * (vertices - middle)), mesh.faces, frame[None], 0, 1, views)
    placed = zoom * (points - middle)
    pixel = 2.0 * WINDOW / PIXELS
    column, row = np.clip(np.floor((placed[:, :2] + WINDOW) / pixel).astype(np.int64), 0, PIXELS - 1).T
    return np.asarray(-placed[:, 2] < views[0][row, column] + _STEEP * pixel)
