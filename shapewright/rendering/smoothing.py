"""Normals of corners for smooth shading of any triangle soup: pictures for people, never for distances."""

import numpy as np
from jaxtyping import Float32, Int

from shapewright.mesh import TriangleMesh

CREASE_ANGLE_RAD = float(np.deg2rad(38.0))
"""Faces that meet at a sharper angle keep a visible edge."""
MAX_CORNERS_A_VERTEX = 64
"""A vertex where more corners meet (the hub of a fan) keeps flat normals: pairs grow with the square."""


def corner_normals(mesh: TriangleMesh, *, crease_angle_rad: float = CREASE_ANGLE_RAD) -> Float32[np.ndarray, "F 3 3"]:
    """Unit normals of each face's three corners.

    A corner takes the mean of the normals of the faces around its position that are within the crease angle of
    its own face, weighted by area and turned to its own side: neither shared vertices nor a consistent winding
    are needed.
    """
    normals = mesh.face_normals
    areas = mesh.face_areas
    result = np.repeat(normals[:, None, :], 3, axis=1).reshape(-1, 3).copy()
    cosine = np.cos(crease_angle_rad)
    for group in _corners_by_position(mesh):
        face = group // 3
        n = normals[face]
        alike = np.einsum("gid,gjd->gij", n, n)
        weight = np.where(np.abs(alike) >= cosine, np.sign(alike), 0.0) * areas[face][:, None, :]
        result[group] = np.einsum("gij,gjd->gid", weight, n)
    length = np.linalg.norm(result, axis=1, keepdims=True)
    result = np.where(length > 0, result / np.where(length > 0, length, 1.0), 0.0)
    return result.reshape(-1, 3, 3).astype(np.float32)


def _corners_by_position(mesh: TriangleMesh) -> list[Int[np.ndarray, "G K"]]:
    """Corner numbers (3 * face + corner) that share a position, one array for each number K of corners."""
    low, high = mesh.bounds
    reach = float((high - low).max()) or 1.0
    grid = np.round((mesh.vertices - low) * (1e6 / reach)).astype(np.int64)
    _, welded = np.unique(grid, axis=0, return_inverse=True)
    at = welded.reshape(-1)[mesh.faces.reshape(-1)]
    order = np.argsort(at, kind="stable")
    starts = np.flatnonzero(np.diff(at[order], prepend=-1))
    counts = np.diff(starts, append=len(order))
    groups = []
    for count in range(2, MAX_CORNERS_A_VERTEX + 1):
        first = starts[counts == count]
        for part in np.array_split(first, max(1, len(first) * count * count // 2_000_000)):
            groups.append(order[part[:, None] + np.arange(count)])  # noqa: PERF401
    return groups
