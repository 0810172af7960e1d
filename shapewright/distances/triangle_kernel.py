"""Compiled search for the nearest triangle; :mod:`shapewright.distances.triangles` builds its tree."""

from typing import Final, no_type_check

import numpy as np
from numba import njit

LEAF_FACES: Final = 4
"""Triangles in a leaf of the tree."""

_MOST_PENDING: Final = 64  # two for each level of a tree of 2**31 leaves
_NEEDLE: Final = 1e-10  # squared sine below which rounding decides whether a point projects into a triangle


@njit(cache=True, nogil=True)
@no_type_check
def nearest_faces(points, corners, low, high, distances, faces):
    """Fill ``distances`` (N,) and ``faces`` (N,) with the exact distance to the nearest triangle and its number.

    ``corners`` (F, 3, 3) are the triangles in the order of the tree. ``low`` and ``high`` (2 L, 3) are the boxes of
    a complete binary tree of L leaves: node k has the children 2 k and 2 k + 1, and leaf i, which is node L + i, holds
    :data:`LEAF_FACES` triangles from ``LEAF_FACES * i`` on. Each search begins at the triangle that the last one found,
    so points that are sorted by place are found fastest.
    """
    n_faces = corners.shape[0]
    n_leaves = low.shape[0] // 2
    pending = np.empty(_MOST_PENDING, dtype=np.int64)
    pending_square = np.empty(_MOST_PENDING)
    nearest = 0
    for i in range(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        best = triangle_square(x, y, z, corners, nearest)
        pending[0], pending_square[0] = 1, 0.0
        count = 1
        while count > 0:
            count -= 1
            if pending_square[count] >= best:
                continue
            node = pending[count]
            if node >= n_leaves:
                first = (node - n_leaves) * LEAF_FACES
                for face in range(first, min(first + LEAF_FACES, n_faces)):
                    square = triangle_square(x, y, z, corners, face)
                    if square < best:
                        best, nearest = square, face
                continue
            left, right = 2 * node, 2 * node + 1
            left_square = box_square(x, y, z, low, high, left)
            right_square = box_square(x, y, z, low, high, right)
            if left_square > right_square:  # the nearer child is pushed last and searched first
                left, right = right, left
                left_square, right_square = right_square, left_square
            if right_square < best:
                pending[count], pending_square[count] = right, right_square
                count += 1
            if left_square < best:
                pending[count], pending_square[count] = left, left_square
                count += 1
        distances[i] = np.sqrt(best)
        faces[i] = nearest


@njit(cache=True, nogil=True, inline="always")
@no_type_check
def box_square(x, y, z, low, high, node):
    """Return the squared distance of a point to a box, 0 inside; an empty box (low = inf) is at infinity."""
    dx = max(low[node, 0] - x, x - high[node, 0], 0.0)
    dy = max(low[node, 1] - y, y - high[node, 1], 0.0)
    dz = max(low[node, 2] - z, z - high[node, 2], 0.0)
    return dx * dx + dy * dy + dz * dz


@njit(cache=True, nogil=True)
@no_type_check
def triangle_square(x, y, z, corners, face):
    """Return the squared distance of a point to a triangle, which may be a line or a point.

    Every candidate is the distance to a point of the triangle, so rounding never makes the answer too small.
    """
    ax, ay, az = corners[face, 0, 0], corners[face, 0, 1], corners[face, 0, 2]
    ux, uy, uz = corners[face, 1, 0] - ax, corners[face, 1, 1] - ay, corners[face, 1, 2] - az
    vx, vy, vz = corners[face, 2, 0] - ax, corners[face, 2, 1] - ay, corners[face, 2, 2] - az
    px, py, pz = x - ax, y - ay, z - az
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    pu, pv = px * ux + py * uy + pz * uz, px * vx + py * vy + pz * vz
    best = np.inf
    determinant = uu * vv - uv * uv
    if determinant > 0.0:
        s, t = (vv * pu - uv * pv) / determinant, (uu * pv - uv * pu) / determinant
        if s >= 0.0 and t >= 0.0 and s + t <= 1.0:
            dx, dy, dz = px - s * ux - t * vx, py - s * uy - t * vy, pz - s * uz - t * vz
            best = dx * dx + dy * dy + dz * dz
            if determinant > _NEEDLE * uu * vv:
                return best
    best = min(best, segment_square(px, py, pz, ux, uy, uz, uu))
    best = min(best, segment_square(px, py, pz, vx, vy, vz, vv))
    wx, wy, wz = vx - ux, vy - uy, vz - uz
    return min(best, segment_square(px - ux, py - uy, pz - uz, wx, wy, wz, wx * wx + wy * wy + wz * wz))


@njit(cache=True, nogil=True, inline="always")
@no_type_check
def segment_square(px, py, pz, ux, uy, uz, uu):
    """Return the squared distance of a point to the segment from the origin to u, whose squared length is ``uu``."""
    s = min(max((px * ux + py * uy + pz * uz) / uu, 0.0), 1.0) if uu > 0.0 else 0.0
    dx, dy, dz = px - s * ux, py - s * uy, pz - s * uz
    return dx * dx + dy * dy + dz * dz
