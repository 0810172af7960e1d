"""Compiled kernels that sum up the normal equations of the least squares."""

from typing import no_type_check

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
@no_type_check
def add_pairs(rows, offsets, normals, spacing, width, share, metrics, forces):
    """Add the pull of matched pairs to the samples that they belong to.

    A pair pulls along its normal, and along the surface for as much as it is farther than ``spacing``. Its weight
    falls with the residual r as 1 / (1 + r^2 / width^2)^2 (Geman and McClure 1985).

    Args:
        rows: (N,) the sample of each pair.
        offsets: (N, 3) from the query to the sample.
        normals: (N, 3).
        spacing: of the points that were matched.
        width: of the robust weight.
        share: weight of every pair.
        metrics: (M, 3, 3) sums of weighted quadratic forms, added to.
        forces: (M, 3) sums of weighted gradients, added to.
    """
    for i in range(rows.shape[0]):
        j = rows[i]
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        ex, ey, ez = offsets[i, 0], offsets[i, 1], offsets[i, 2]
        out = ex * nx + ey * ny + ez * nz
        tx, ty, tz = ex - out * nx, ey - out * ny, ez - out * nz
        along = np.sqrt(tx * tx + ty * ty + tz * tz)
        keep = max(0.0, 1.0 - spacing / along) if along > 0.0 else 0.0
        keep2 = keep * keep
        robust = 1.0 + (out * out + keep2 * along * along) / (width * width)
        weight = share / (robust * robust)
        n = (nx, ny, nz)
        t = (tx, ty, tz)
        for a in range(3):
            forces[j, a] += weight * (out * n[a] + keep2 * t[a])
            for b in range(3):
                metrics[j, a, b] += weight * (1.0 - keep2) * n[a] * n[b]
            metrics[j, a, a] += weight * keep2


@njit(cache=True, nogil=True)
@no_type_check
def moved_columns(slopes):
    """List which columns move each control point.

    Args:
        slopes: (D, V, 3) derivatives of the control points.

    Returns:
        ends of each point's part of the list (V + 1,), the columns, and the derivatives (K, 3) beside them.
    """
    n_columns, n_points = slopes.shape[0], slopes.shape[1]
    starts = np.zeros(n_points + 1, np.int64)
    for c in range(n_columns):
        for v in range(n_points):
            if slopes[c, v, 0] != 0.0 or slopes[c, v, 1] != 0.0 or slopes[c, v, 2] != 0.0:
                starts[v + 1] += 1
    for v in range(n_points):
        starts[v + 1] += starts[v]
    columns, moves = np.empty(starts[n_points], np.int64), np.empty((starts[n_points], 3))
    ends = starts[:-1].copy()
    for c in range(n_columns):
        for v in range(n_points):
            if slopes[c, v, 0] != 0.0 or slopes[c, v, 1] != 0.0 or slopes[c, v, 2] != 0.0:
                at = ends[v]
                columns[at] = c
                for a in range(3):
                    moves[at, a] = slopes[c, v, a]
                ends[v] = at + 1
    return starts, columns, moves


@njit(cache=True, nogil=True, fastmath=True)
@no_type_check
def add_system(
    row_starts, row_columns, row_entries, move_starts, move_columns, moves, placed, turn, center, metrics, forces,
    curvature, gradient,
):  # fmt: skip
    """Add the pulls of samples to the normal equations of D parameters and the pose.

    The pose is 3 rotations about ``center``, 3 translations, and the logarithm of the scale about it.

    Args:
        row_starts, row_columns, row_entries: sparse matrix (N, V) that makes the samples of control points.
        move_starts, move_columns, moves: from :func:`moved_columns`, in model space.
        placed: (N, 3) samples in query space.
        turn: (3, 3) scale times rotation.
        center: (3,).
        metrics: (N, 3, 3) quadratic forms of the samples, symmetric.
        forces: (N, 3) gradients.
        curvature: (D + 7, D + 7), its lower triangle is added to.
        gradient: (D + 7,), added to.
    """
    size = gradient.shape[0]
    n_parameters = size - 7
    slopes = np.zeros((size, 3))
    met = np.zeros(size, np.bool_)
    order = np.empty(size, np.int64)
    model_moves = np.zeros((n_parameters, 3))
    for i in range(placed.shape[0]):
        if metrics[i, 0, 0] + metrics[i, 1, 1] + metrics[i, 2, 2] == 0.0:
            continue
        count = 0
        for k in range(row_starts[i], row_starts[i + 1]):
            point, weight = row_columns[k], row_entries[k]
            for m in range(move_starts[point], move_starts[point + 1]):
                c = move_columns[m]
                if not met[c]:
                    met[c] = True
                    order[count] = c
                    count += 1
                    model_moves[c, 0] = model_moves[c, 1] = model_moves[c, 2] = 0.0
                model_moves[c, 0] += weight * moves[m, 0]
                model_moves[c, 1] += weight * moves[m, 1]
                model_moves[c, 2] += weight * moves[m, 2]
        for k in range(count):
            c = order[k]
            met[c] = False
            mx, my, mz = model_moves[c, 0], model_moves[c, 1], model_moves[c, 2]
            for a in range(3):
                slopes[k, a] = turn[a, 0] * mx + turn[a, 1] * my + turn[a, 2] * mz
        x, y, z = placed[i, 0] - center[0], placed[i, 1] - center[1], placed[i, 2] - center[2]
        for k in range(7):
            order[count + k] = n_parameters + k
            for a in range(3):
                slopes[count + k, a] = 0.0
        slopes[count, 1], slopes[count, 2] = -z, y
        slopes[count + 1, 0], slopes[count + 1, 2] = z, -x
        slopes[count + 2, 0], slopes[count + 2, 1] = -y, x
        for a in range(3):
            slopes[count + 3 + a, a] = 1.0
        slopes[count + 6, 0], slopes[count + 6, 1], slopes[count + 6, 2] = x, y, z
        count += 7
        m00, m01, m02 = metrics[i, 0, 0], metrics[i, 0, 1], metrics[i, 0, 2]
        m11, m12, m22 = metrics[i, 1, 1], metrics[i, 1, 2], metrics[i, 2, 2]
        fx, fy, fz = forces[i, 0], forces[i, 1], forces[i, 2]
        for k in range(count):
            sx, sy, sz = slopes[k, 0], slopes[k, 1], slopes[k, 2]
            px, py, pz = m00 * sx + m01 * sy + m02 * sz, m01 * sx + m11 * sy + m12 * sz, m02 * sx + m12 * sy + m22 * sz
            c = order[k]
            gradient[c] += fx * sx + fy * sy + fz * sz
            for other in range(k + 1):
                d = order[other]
                add = px * slopes[other, 0] + py * slopes[other, 1] + pz * slopes[other, 2]
                if d <= c:
                    curvature[c, d] += add
                else:
                    curvature[d, c] += add
