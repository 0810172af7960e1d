"""Compiled kernel that finds where the outline of an instance lies in each depth view."""

from typing import no_type_check

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
@no_type_check
def _outward(covered, j, i, out):
    """Direction from a covered pixel to what is not covered around it, as a unit vector (columns, rows)."""
    x, y = 0.0, 0.0
    for dj in range(-2, 3):
        for di in range(-2, 3):
            jj, ii = j + dj, i + di
            if jj < 0 or ii < 0 or jj >= covered.shape[0] or ii >= covered.shape[1] or not covered[jj, ii]:
                x += di
                y += dj
    length = np.sqrt(x * x + y * y)
    if length > 0.0:
        out[0], out[1] = x / length, y / length
    else:
        out[0], out[1] = 1.0, 0.0


@njit(cache=True, nogil=True)
@no_type_check
def mask_outline(covered, pixels, normals):
    """Find the covered pixels beside one that is not covered.

    Args:
        covered: (H, W) bool.
        pixels: (N, 2) filled with column and row.
        normals: (N, 2) filled with the direction out of the mask.

    Returns:
        How many were found; at most N.
    """
    found = 0
    height, width = covered.shape
    for j in range(1, height - 1):
        for i in range(1, width - 1):
            if not covered[j, i]:
                continue
            if covered[j, i - 1] and covered[j, i + 1] and covered[j - 1, i] and covered[j + 1, i]:
                continue
            if found == pixels.shape[0]:
                return found
            pixels[found, 0], pixels[found, 1] = i, j
            _outward(covered, j, i, normals[found])
            found += 1
    return found


@njit(cache=True, nogil=True)
@no_type_check
def match_outlines(points, normals, others, other_normals, near, across, chosen):
    """Match outline points with near ones of the other object whose outlines face the same way.

    Args:
        points, normals: (N, 2) and (N, 2).
        others, other_normals: (M, 2) and (M, 2).
        near: (N, K) candidates.
        across: how far a point may be for the price of outlines that face opposite ways.
        chosen: (N,) filled.
    """
    for n in range(points.shape[0]):
        best = 1e300
        for k in range(near.shape[1]):
            m = near[n, k]
            x, y = points[n, 0] - others[m, 0], points[n, 1] - others[m, 1]
            cosine = normals[n, 0] * other_normals[m, 0] + normals[n, 1] * other_normals[m, 1]
            cost = x * x + y * y + 0.5 * across * across * (1.0 - cosine)
            if cost < best:
                best = cost
                chosen[n] = m


@njit(cache=True, nogil=True)
@no_type_check
def add_outline_pairs(rows, offsets, normals, views, frames, spacing, width, share, metrics, forces):
    """Add the pull of matched outline points to the samples that they belong to, within the plane of the view.

    Args:
        rows: (N,) the sample of each pair.
        offsets, normals: (N, 2) from the query to the sample, and out of the query's outline.
        views: (N,) number of the view.
        frames: (K, 3, 3).
        spacing: moves along the outline count beyond it only.
        width: of the robust weight.
        share: weight of every pair.
        metrics, forces: (M, 3, 3) and (M, 3), added to.
    """
    for i in range(rows.shape[0]):
        j = rows[i]
        out = offsets[i, 0] * normals[i, 0] + offsets[i, 1] * normals[i, 1]
        along = -offsets[i, 0] * normals[i, 1] + offsets[i, 1] * normals[i, 0]
        keep = max(0.0, 1.0 - spacing / abs(along)) if along != 0.0 else 0.0
        keep2 = keep * keep
        robust = 1.0 + (out * out + keep2 * along * along) / (width * width)
        weight = share / (robust * robust)
        right, up = frames[views[i], 0], frames[views[i], 1]
        for a in range(3):
            na = normals[i, 0] * right[a] + normals[i, 1] * up[a]
            ta = -normals[i, 1] * right[a] + normals[i, 0] * up[a]
            forces[j, a] += weight * (out * na + keep2 * along * ta)
            for b in range(3):
                nb = normals[i, 0] * right[b] + normals[i, 1] * up[b]
                tb = -normals[i, 1] * right[b] + normals[i, 0] * up[b]
                metrics[j, a, b] += weight * (na * nb + keep2 * ta * tb)


@njit(cache=True, nogil=True)
@no_type_check
def outline_points(points, triangles, frames, size, window, faces, weights, views, pixels, normals):
    """Find the triangles at the outline of a surface, seen along each direction.

    The surface is drawn into ``size`` x ``size`` pixels; a covered pixel beside one that is not covered belongs to the
    outline. Depth does not matter: whatever covers such a pixel ends there.

    Args:
        points: (V, 3).
        triangles: (F, 3).
        frames: (K, 3, 3), right, up and viewing direction of each view.
        size: pixels along each side.
        window: half the side of the viewing window.
        faces, weights, views, pixels, normals: (N,), (N, 3), (N,), (N, 2), (N, 2) filled: triangle, barycentric weights
            of the pixel's center in it, number of the view, column and row, direction out of the outline.

    Returns:
        How many were found; at most N.
    """
    found = 0
    most = faces.shape[0]
    to_pixels = size / (2.0 * window)
    middle = 0.5 * (size - 1)
    n_points = points.shape[0]
    columns, rows = np.empty(n_points), np.empty(n_points)
    owner = np.empty((size, size), np.int32)
    for view in range(frames.shape[0]):
        frame = frames[view]
        for v in range(n_points):
            x, y, z = points[v, 0], points[v, 1], points[v, 2]
            columns[v] = (x * frame[0, 0] + y * frame[0, 1] + z * frame[0, 2]) * to_pixels + middle
            rows[v] = (x * frame[1, 0] + y * frame[1, 1] + z * frame[1, 2]) * to_pixels + middle
        owner[:] = -1
        low_row, high_row = size, -1
        for f in range(triangles.shape[0]):
            a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            ax, bx, cx = columns[a], columns[b], columns[c]
            first_column, last_column = max(0, int(np.ceil(min(ax, bx, cx)))), min(size - 1, int(max(ax, bx, cx)))
            if first_column > last_column:
                continue
            ay, by, cy = rows[a], rows[b], rows[c]
            first_row, last_row = max(0, int(np.ceil(min(ay, by, cy)))), min(size - 1, int(max(ay, by, cy)))
            if first_row > last_row:
                continue
            area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            if area == 0.0:
                continue
            low_row, high_row = min(low_row, first_row), max(high_row, last_row)
            inverse = 1.0 / area
            step_b, step_c = (cy - ay) * inverse, -(by - ay) * inverse
            for j in range(first_row, last_row + 1):
                wb = ((first_column - ax) * (cy - ay) - (j - ay) * (cx - ax)) * inverse
                wc = ((bx - ax) * (j - ay) - (by - ay) * (first_column - ax)) * inverse
                for i in range(first_column, last_column + 1):
                    if wb >= 0.0 and wc >= 0.0 and wb + wc <= 1.0:
                        owner[j, i] = f
                    wb += step_b
                    wc += step_c
        covered = owner >= 0
        for j in range(max(low_row, 1), min(high_row + 1, size - 1)):
            for i in range(1, size - 1):
                f = owner[j, i]
                if f < 0:
                    continue
                if owner[j, i - 1] >= 0 and owner[j, i + 1] >= 0 and owner[j - 1, i] >= 0 and owner[j + 1, i] >= 0:
                    continue
                if found == most:
                    return found
                a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
                ax, ay = columns[a], rows[a]
                bx, by = columns[b] - ax, rows[b] - ay
                cx, cy = columns[c] - ax, rows[c] - ay
                inverse = 1.0 / (bx * cy - by * cx)
                wb = ((i - ax) * cy - (j - ay) * cx) * inverse
                wc = (bx * (j - ay) - by * (i - ax)) * inverse
                faces[found] = f
                weights[found, 0], weights[found, 1], weights[found, 2] = 1.0 - wb - wc, wb, wc
                views[found] = view
                pixels[found, 0], pixels[found, 1] = i, j
                _outward(covered, j, i, normals[found])
                found += 1
    return found
