"""One side only: what a depth camera sees from one place."""

from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from shapewright.distances.depth_kernels import WINDOW, draw_passes
from shapewright.errors import MeshError
from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.mesh import TriangleMesh

STEEPEST: Final = 6.0
"""Neighboring pixels belong to one surface if their depths differ by at most this many pixels (about 80 degrees)."""


def see_one_side(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Return the surface that one depth picture from a random direction shows, as a grid of new triangles.

    The picture is orthographic and just holds the object's bounding ball. Pixels whose depths differ too much are not
    joined. Every vertex lies on the front of the mesh; nothing of the back, and nothing that is hidden, is left.

    Args:
        mesh: any surface.
        strength: pixels along each side of the picture; rounded to an even number.
        rng: source of the direction, uniform.

    Raises:
        MeshError: the mesh is one point, or so thin in every direction that the picture shows nothing.
    """
    size = 2 * round(strength / 2)
    frame = np.ascontiguousarray(Rotation.random(rng=rng).as_matrix())
    normalization = mesh.normalized()
    low, high = normalization.mesh.bounds
    center = 0.5 * (low + high)
    radius = float(np.linalg.norm(normalization.mesh.vertices - center, axis=1).max())
    zoom = 0.999 * WINDOW / radius
    points = np.ascontiguousarray(zoom * (normalization.mesh.vertices - center))
    views = np.empty((2, size, size), dtype=np.float32)
    draw_passes(points, mesh.faces, frame[None], 0, 1, views)
    seen = _grid(views[0].astype(np.float64))
    if seen is None:
        raise MeshError("the picture from this direction shows nothing", where="vertices")
    normalized = seen.vertices @ frame / zoom + center
    return TriangleMesh((normalized - normalization.translation) / normalization.scale, seen.faces).cleaned()


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


HALF: Final = Corruption(
    name="half",
    meaning="pixels along each side of the depth picture that is all there is",
    strengths=(256.0, 128.0, 64.0),
    default=128.0,
    least=16.0,
    most=1024.0,
    corrupt=see_one_side,
)
