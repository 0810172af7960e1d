"""Turns a mesh the way another one stands, so that people can compare pictures of both."""

import numpy as np
from jaxtyping import Float
from scipy.spatial import cKDTree

from shapewright.distances.alignment import rotations_24
from shapewright.distances.surface import uniform_points
from shapewright.mesh import TriangleMesh

POINTS = 600
REFINEMENTS = 10
"""Principal axes of like shapes differ by some degrees; so many steps of closest points correct that."""


def rotation_like(mesh: TriangleMesh, model: TriangleMesh, rng: np.random.Generator) -> Float[np.ndarray, "3 3"]:
    """Find a rotation that turns ``mesh`` like ``model``.

    Principal axes onto principal axes, the best of 24 ways, then closest points.

    Raises:
        MeshError: one of them has no area.
    """
    points, points_frame = _principal(mesh, rng)
    wanted, wanted_frame = _principal(model, rng)
    tree = cKDTree(wanted)
    best, best_rotation = np.inf, np.eye(3)
    for turn in rotations_24():
        rotation = wanted_frame.T @ turn @ points_frame
        turned = points @ rotation.T
        away = float(np.mean(tree.query(turned)[0]) + np.mean(cKDTree(turned).query(wanted)[0]))
        if away < best:
            best, best_rotation = away, rotation
    for _ in range(REFINEMENTS):
        turned = points @ best_rotation.T
        left, _, right = np.linalg.svd(wanted[tree.query(turned)[1]].T @ turned)
        sign = np.diag([1.0, 1.0, np.linalg.det(left @ right)])
        best_rotation = left @ sign @ right @ best_rotation
    return best_rotation


def _principal(
    mesh: TriangleMesh, rng: np.random.Generator
) -> tuple[Float[np.ndarray, "N 3"], Float[np.ndarray, "3 3"]]:
    """Points on a surface, centred and of mean distance 1, and their right-handed principal axes as rows."""
    points = uniform_points(mesh, POINTS, rng=rng)
    points = points - points.mean(axis=0)
    points /= np.linalg.norm(points, axis=1).mean() or 1.0
    frame = np.linalg.eigh(points.T @ points)[1].T[::-1].copy()
    frame[2] = np.cross(frame[0], frame[1])
    return points, frame
