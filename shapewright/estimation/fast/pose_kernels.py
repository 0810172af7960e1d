"""Compiled kernels that find the pose of an instance: scores of rotations, closest points."""

from typing import no_type_check

import numpy as np
from numba import njit


@njit(cache=True, nogil=True, fastmath=True)
@no_type_check
def score_rotations(query, model, rotations, scores):
    """Score rotations of model points onto query points: mean distance to the nearest point, both ways.

    Args:
        query: (3, N) float32, contiguous rows.
        model: (M, 3) float32.
        rotations: (R, 3, 3) float32.
        scores: (R,) float32, filled.
    """
    n, m = query.shape[1], model.shape[0]
    qx, qy, qz = query[0], query[1], query[2]
    nearest = np.empty(n, np.float32)
    for r in range(rotations.shape[0]):
        rotation = rotations[r]
        nearest[:] = np.float32(1e30)
        total = np.float32(0.0)
        for j in range(m):
            x, y, z = model[j, 0], model[j, 1], model[j, 2]
            px = rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z
            py = rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z
            pz = rotation[2, 0] * x + rotation[2, 1] * y + rotation[2, 2] * z
            best = np.float32(1e30)
            for i in range(n):
                dx, dy, dz = qx[i] - px, qy[i] - py, qz[i] - pz
                square = dx * dx + dy * dy + dz * dz
                nearest[i] = min(nearest[i], square)
                best = min(best, square)
            total += np.sqrt(best)
        other = np.float32(0.0)
        for i in range(n):
            other += np.sqrt(nearest[i])
        scores[r] = total / np.float32(m) + other / np.float32(n)


@njit(cache=True, nogil=True)
@no_type_check
def align_by_closest_points(query, model, rotation, translation, scale, rounds, keeps_scale, keeps_rotation):
    """Refine a similarity by closest points, both ways, weighted against far pairs.

    Args:
        query: (N, 3) float64.
        model: (M, 3) float64.
        rotation, translation, scale: where to begin.
        rounds: at most.
        keeps_scale, keeps_rotation: whether the scale or the rotation stays as it is.

    Returns:
        rotation, translation, scale, mean distance of the last pairs.
    """
    n, m = query.shape[0], model.shape[0]
    placed = np.empty((m, 3))
    first = np.empty(n + m, np.int64)  # query point of each pair
    second = np.empty(n + m, np.int64)  # model point of each pair
    squares = np.empty(n + m)
    mean = 0.0
    for _ in range(rounds):
        for j in range(m):
            for d in range(3):
                placed[j, d] = translation[d] + scale * (
                    rotation[d, 0] * model[j, 0] + rotation[d, 1] * model[j, 1] + rotation[d, 2] * model[j, 2]
                )
        for i in range(n):
            squares[i] = 1e30
        for j in range(m):
            best, at = 1e30, 0
            for i in range(n):
                dx = query[i, 0] - placed[j, 0]
                dy = query[i, 1] - placed[j, 1]
                dz = query[i, 2] - placed[j, 2]
                square = dx * dx + dy * dy + dz * dz
                if square < squares[i]:
                    squares[i] = square
                    second[i] = j
                if square < best:
                    best, at = square, i
            squares[n + j], first[n + j], second[n + j] = best, at, j
        mean = 0.0
        for i in range(n):
            first[i] = i
        for k in range(n + m):
            mean += np.sqrt(squares[k])
        mean /= n + m
        inner = max(mean * mean, 1e-12)
        total = 0.0
        query_mean, model_mean = np.zeros(3), np.zeros(3)
        for k in range(n + m):
            weight = 1.0 / (1.0 + 0.25 * squares[k] / inner)
            if k < n:
                weight /= n
            else:
                weight /= m
            squares[k] = weight
            total += weight
            for d in range(3):
                query_mean[d] += weight * query[first[k], d]
                model_mean[d] += weight * model[second[k], d]
        query_mean /= total
        model_mean /= total
        cross = np.zeros((3, 3))
        spread = 0.0
        for k in range(n + m):
            for d in range(3):
                a = model[second[k], d] - model_mean[d]
                spread += squares[k] * a * a
                for e in range(3):
                    cross[e, d] += squares[k] * (query[first[k], e] - query_mean[e]) * a
        if not spread > 0.0:
            break
        if not keeps_rotation:
            left, _, right = np.linalg.svd(cross)
            if np.linalg.det(left) * np.linalg.det(right) < 0.0:
                left[:, 2] = -left[:, 2]
            rotation = np.ascontiguousarray(left) @ np.ascontiguousarray(right)
        along = (rotation * cross).sum()
        if along > 0.0 and not keeps_scale:
            scale = along / spread
        for d in range(3):
            translation[d] = query_mean[d] - scale * (
                rotation[d, 0] * model_mean[0] + rotation[d, 1] * model_mean[1] + rotation[d, 2] * model_mean[2]
            )
    return rotation, translation, scale, mean
