"""Depth pictures as surfaces: what a scanner sees of an object from one side."""

from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.distances.depth_kernels import WINDOW, draw_passes
from shapewright.mesh import Normalization, TriangleMesh

STEEPEST: Final = 6.0
"""Neighboring pixels belong to one surface if their depths differ by at most this many pixels (about 80 degrees)."""


def scan_front_and_back(
    mesh: TriangleMesh, frame: Float[np.ndarray, "3 3"], size: int
) -> tuple[TriangleMesh | None, TriangleMesh | None]:
    """Return what two depth pictures show, one from the front and one from the back, as grids of new triangles.

    The pictures are orthographic and just hold the object's bounding ball. Pixels whose depths differ too much are not
    joined. The surfaces are in the coordinates of the mesh; one that shows nothing is ``None``.

    Args:
        mesh: any surface.
        frame: right, up and viewing direction of the picture from the front, C-contiguous.
        size: pixels along each side of a picture, even.

    Raises:
        MeshError: the mesh is one point.
    """
    normalization = mesh.normalized()
    low, high = normalization.mesh.bounds
    center = 0.5 * (low + high)
    radius = float(np.linalg.norm(normalization.mesh.vertices - center, axis=1).max())
    zoom = 0.999 * WINDOW / radius
    points = np.ascontiguousarray(zoom * (normalization.mesh.vertices - center))
    views = np.empty((2, size, size), dtype=np.float32)
    draw_passes(points, mesh.faces, frame[None], 0, 1, views)
    front, back = _grid(views[0].astype(np.float64)), _grid(-views[1].astype(np.float64))
    turned = None if back is None else TriangleMesh(back.vertices, back.faces[:, ::-1])  # to face its camera

    def original(seen: TriangleMesh | None) -> TriangleMesh | None:
        return None if seen is None else _placed_back(seen, frame, zoom, center, normalization)

    return original(front), original(turned)


def _placed_back(
    seen: TriangleMesh,
    frame: Float[np.ndarray, "3 3"],
    zoom: float,
    center: Float[np.ndarray, " 3"],
    normalization: Normalization,
) -> TriangleMesh:
    """Return a surface in the coordinates of the mesh, given in those of the picture."""
    normalized = seen.vertices @ frame / zoom + center
    return TriangleMesh((normalized - normalization.translation) / normalization.scale, seen.faces)


def _grid(depths: Float[np.ndarray, "S S"]) -> TriangleMesh | None:
    """Join the pixels of a depth picture to triangles, in the frame of the picture; ``None`` if there are none."""
    size = len(depths)
    pixel = 2.0 * WINDOW / size
    row, column = np.meshgrid(np.arange(size), np.arange(size), indexing="ij")
    number = np.arange(size * size).reshape(size, size)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    corners = depths.ravel()[faces]
    covered = np.isfinite(corners).all(axis=1)
    faces, corners = faces[covered], corners[covered]
    faces = faces[np.ptp(corners, axis=1) <= STEEPEST * pixel]
    if len(faces) == 0:
        return None
    across = (np.stack([column, row], -1).reshape(-1, 2) + 0.5) * pixel - WINDOW
    used, renumbered = np.unique(faces, return_inverse=True)
    vertices = np.concatenate([across, depths.reshape(-1, 1)], axis=1)[used]
    return TriangleMesh(vertices, renumbered.reshape(-1, 3))
