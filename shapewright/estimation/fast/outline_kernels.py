"""Compiled kernels that match the outlines of query and instance in the depth views."""

from typing import no_type_check

import numpy as np
from numba import njit


@njit(cache=True, nogil=True, fastmath=True)
@no_type_check
def match_outlines(points, starts, others, other_starts, across, chosen):
    """Match outline points with those of the other object, in the same view, whose outlines face the same way.

    Args:
        points: (4, N) column, row, and the direction out of the outline, view after view.
        starts: (K + 1,) where each view begins among the points.
        others, other_starts: (4, M) and (K + 1,), of the other object.
        across: how far a point may be for the price of outlines that face opposite ways.
        chosen: (N,) filled; -1 where the other object has no outline in the view.
    """
    x, y, u, v = others[0], others[1], others[2], others[3]
    half = 0.5 * across * across
    costs = np.empty(others.shape[1])
    for view in range(starts.shape[0] - 1):
        first, last = other_starts[view], other_starts[view + 1]
        for n in range(starts[view], starts[view + 1]):
            px, py, pu, pv = points[0, n], points[1, n], points[2, n], points[3, n]
            least = 1e300
            for m in range(first, last):
                dx, dy = px - x[m], py - y[m]
                cost = dx * dx + dy * dy - half * (pu * u[m] + pv * v[m])
                costs[m] = cost
                least = min(least, cost)
            chosen[n] = -1
            for m in range(first, last):
                if costs[m] <= least:
                    chosen[n] = m
                    break


@njit(cache=True, nogil=True)
@no_type_check
def add_outline_pairs(rows, places, own, others, views, frames, spacing, width, share, metrics, forces):
    """Add the pull of matched outline points to the samples that they belong to, within the plane of the view.

    Args:
        rows: (N,) the sample of each pair.
        places: (4, M) columns and rows of the samples.
        own: (N,) the point of the query's outline of each pair; a pair with a -1 on either side pulls nothing.
        others: (4, Q) the query's outline, and the direction out of it.
        views: (M,) number of the view of each sample.
        frames: (K, 3, 3).
        spacing: moves along the outline count beyond it only.
        width: of the robust weight.
        share: weight of every pair.
        metrics, forces: (M, 3, 3) and (M, 3), added to.
    """
    for i in range(rows.shape[0]):
        j, q = rows[i], own[i]
        if j < 0 or q < 0:
            continue
        dx, dy = places[0, j] - others[0, q], places[1, j] - others[1, q]
        nx, ny = others[2, q], others[3, q]
        out = dx * nx + dy * ny
        along = dy * nx - dx * ny
        keep = max(0.0, 1.0 - spacing / abs(along)) if along != 0.0 else 0.0
        keep2 = keep * keep
        robust = 1.0 + (out * out + keep2 * along * along) / (width * width)
        weight = share / (robust * robust)
        right, up = frames[views[j], 0], frames[views[j], 1]
        for a in range(3):
            na = nx * right[a] + ny * up[a]
            ta = -ny * right[a] + nx * up[a]
            forces[j, a] += weight * (out * na + keep2 * along * ta)
            for b in range(3):
                nb = nx * right[b] + ny * up[b]
                tb = -ny * right[b] + nx * up[b]
                metrics[j, a, b] += weight * (na * nb + keep2 * ta * tb)
