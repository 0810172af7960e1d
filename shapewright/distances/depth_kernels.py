"""Compiled kernels of the depth images and of the z-buffer distance.

They release the interpreter's lock and leave threads to :mod:`shapewright.distances.rasterize`.

They share one file on purpose: numba's cache looks at the date of the file a kernel stands in, not at those
of the kernels that it calls, so a caller elsewhere would go on running an old copy.
"""

from typing import Final, no_type_check

import numpy as np
from numba import njit

WINDOW: Final = 2.0
"""Half the side of the viewing window, in the units of the points."""

UNDERSIZE_PENALTY: Final = 2.0
"""Added for a pixel that the original covers and the generated object does not (Algorithm 1)."""

OVERSIZE_PENALTY: Final = 1.0
"""Added for a pixel that the generated object covers and the original does not (Algorithm 1)."""

_SUBPIXEL_BITS: Final = 12
_SUBPIXELS: Final = 1 << _SUBPIXEL_BITS
_FARTHEST_SNAP: Final = float(1 << 28)  # 256 windows of 256 pixels away: products stay within 64 bits
_WIDE: Final = 12  # from this many pixels on it pays to solve for the covered span of a row


@njit(cache=True, nogil=True)
@no_type_check
def project(points, frame, size, columns, rows, depths):
    """Project points into one pass; the snapped pixel coordinates are relative to the middle of the window.

    Fills ``columns``, ``rows`` (int64, subpixels) and ``depths`` (float64), returns the pixels whose centres
    can be covered: first and last column, first and last row (empty if last < first).
    """
    to_subpixels = size / (2.0 * WINDOW) * _SUBPIXELS
    low_column, high_column = np.int64(1) << 40, -(np.int64(1) << 40)
    low_row, high_row = low_column, high_column
    for v in range(points.shape[0]):
        x, y, z = points[v, 0], points[v, 1], points[v, 2]
        u = (x * frame[0, 0] + y * frame[0, 1] + z * frame[0, 2]) * to_subpixels
        w = (x * frame[1, 0] + y * frame[1, 1] + z * frame[1, 2]) * to_subpixels
        column = np.int64(np.rint(min(max(u, -_FARTHEST_SNAP), _FARTHEST_SNAP)))
        row = np.int64(np.rint(min(max(w, -_FARTHEST_SNAP), _FARTHEST_SNAP)))
        columns[v] = column
        rows[v] = row
        depths[v] = x * frame[2, 0] + y * frame[2, 1] + z * frame[2, 2]
        low_column, high_column = min(low_column, column), max(high_column, column)
        low_row, high_row = min(low_row, row), max(high_row, row)
    first_column, last_column = pixel_range(low_column, high_column, size)
    first_row, last_row = pixel_range(low_row, high_row, size)
    return first_column, last_column, first_row, last_row


@njit(cache=True, nogil=True, inline="always")
@no_type_check
def pixel_range(low, high, size):
    """First and last pixel of the image with its centre within [low, high] (subpixels about the middle)."""
    offset = (size - 1) * _SUBPIXELS
    first = (2 * low + offset + 2 * _SUBPIXELS - 1) >> (_SUBPIXEL_BITS + 1)
    last = (2 * high + offset) >> (_SUBPIXEL_BITS + 1)
    return max(first, 0), min(last, size - 1)


@njit(cache=True, nogil=True, inline="always")
@no_type_check
def _narrow(value, step, first, last):
    """Cut the steps ``first..last`` to those at which ``value + k * step >= 0`` holds."""
    if step > 0:
        if value < 0:
            first = max(first, -(value // step))
    elif step < 0:
        last = -1 if value < 0 else min(last, value // -step)
    elif value < 0:
        last = -1
    return first, last


@njit(cache=True, nogil=True)
@no_type_check
def fill(columns, rows, depths, triangles, size, front, back, owners):
    """Draw triangles: ``front`` keeps each pixel's smallest depth, ``back`` the smallest negated depth.

    ``owners`` keeps one of the triangles that cover the pixel, unless it is ``None``.
    """
    half = ((size - 1) * _SUBPIXELS) >> 1  # size * subpixels is even: exact
    for f in range(triangles.shape[0]):
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        ax, bx, cx = columns[a], columns[b], columns[c]
        first_column, last_column = pixel_range(min(ax, bx, cx), max(ax, bx, cx), size)
        if last_column < first_column:
            continue
        ay, by, cy = rows[a], rows[b], rows[c]
        first_row, last_row = pixel_range(min(ay, by, cy), max(ay, by, cy), size)
        if last_row < first_row:
            continue
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0:
            continue
        if area < 0:
            area = -area
            b, c = c, b
            bx, cx = cx, bx
            by, cy = cy, by
        inverse = 1.0 / area
        za, zb, zc = depths[a] * inverse, depths[b] * inverse, depths[c] * inverse
        px = first_column * _SUBPIXELS - half
        py = first_row * _SUBPIXELS - half
        row_a = (cx - bx) * (py - by) - (cy - by) * (px - bx)
        row_b = (ax - cx) * (py - cy) - (ay - cy) * (px - cx)
        row_c = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
        right_a, right_b, right_c = (by - cy) * _SUBPIXELS, (cy - ay) * _SUBPIXELS, (ay - by) * _SUBPIXELS
        up_a, up_b, up_c = (cx - bx) * _SUBPIXELS, (ax - cx) * _SUBPIXELS, (bx - ax) * _SUBPIXELS
        width = last_column - first_column
        for j in range(first_row, last_row + 1):
            first, last = np.int64(0), width
            if width >= _WIDE:
                first, last = _narrow(row_a, right_a, first, last)
                first, last = _narrow(row_b, right_b, first, last)
                first, last = _narrow(row_c, right_c, first, last)
            wa, wb, wc = row_a + first * right_a, row_b + first * right_b, row_c + first * right_c
            for k in range(first, last + 1):
                if (wa | wb | wc) >= 0:
                    depth = wa * za + wb * zb + wc * zc
                    if -WINDOW <= depth <= WINDOW:
                        i = first_column + k
                        single = np.float32(depth)
                        front[j, i] = min(front[j, i], single)
                        back[j, i] = min(back[j, i], -single)
                        if owners is not None:
                            owners[j, i] = f
                wa += right_a
                wb += right_b
                wc += right_c
            row_a += up_a
            row_b += up_b
            row_c += up_c


@njit(cache=True, nogil=True)
@no_type_check
def draw_passes(points, triangles, frames, first, last, views):
    """Fill ``views`` (float32, two a pass) with depths, for passes ``first`` to before ``last``."""
    for k in range(first, last):
        size = views.shape[1]
        columns = np.empty(points.shape[0], dtype=np.int64)
        rows = np.empty(points.shape[0], dtype=np.int64)
        depths = np.empty(points.shape[0], dtype=np.float64)
        views[2 * k] = np.inf
        views[2 * k + 1] = np.inf
        project(points, frames[k], size, columns, rows, depths)
        fill(columns, rows, depths, triangles, size, views[2 * k], views[2 * k + 1], None)


@njit(cache=True, nogil=True)
@no_type_check
def _compare_pass(columns, rows, depths, bounds, triangles, query_front, query_back, query_covered, owners):
    """Draw one projected pass and compare it: the raw sum over its two views, and the pixels that either covers."""
    size = query_front.shape[0]
    first_column, last_column, first_row, last_row = bounds
    front = np.empty((size, size), dtype=np.float32)
    back = np.empty((size, size), dtype=np.float32)
    for j in range(first_row, last_row + 1):
        for i in range(first_column, last_column + 1):
            front[j, i] = np.inf
            back[j, i] = np.inf
            if owners is not None:
                owners[j, i] = -1
    fill(columns, rows, depths, triangles, size, front, back, owners)
    both = 0
    only_generated = 0
    differences = 0.0
    for j in range(first_row, last_row + 1):
        for i in range(first_column, last_column + 1):
            if front[j, i] < np.inf:
                if query_front[j, i] < np.inf:
                    both += 1
                    differences += abs(np.float64(front[j, i]) - query_front[j, i])
                    differences += abs(np.float64(back[j, i]) - query_back[j, i])
                else:
                    only_generated += 1
    only_query = query_covered - both
    raw = differences + 2 * (UNDERSIZE_PENALTY * only_query + OVERSIZE_PENALTY * only_generated)
    return raw, 2.0 * (both + only_generated + only_query)


@njit(cache=True, nogil=True)
@no_type_check
def compare_passes(points, triangles, frames, query_views, query_covered, first, last, sums):
    """For passes ``first`` to before ``last``: the raw sum over its two views, and the pixels that either covers."""
    columns = np.empty(points.shape[0], dtype=np.int64)
    rows = np.empty(points.shape[0], dtype=np.int64)
    depths = np.empty(points.shape[0], dtype=np.float64)
    for k in range(first, last):
        bounds = project(points, frames[k], query_views.shape[1], columns, rows, depths)
        sums[k, 0], sums[k, 1] = _compare_pass(
            columns, rows, depths, bounds, triangles, query_views[2 * k], query_views[2 * k + 1], query_covered[k], None
        )


@njit(cache=True, nogil=True)
@no_type_check
def compare_and_trace(
    points, triangles, frames, query_views, query_covered, sums, faces, weights, views, pixels, normals
):
    """Compare all passes as :func:`compare_passes` does, and find the triangles at the outline of the drawn object.

    A covered pixel beside one that is not covered belongs to the outline. Depth does not matter: whatever covers such a
    pixel ends there.

    Args:
        points: (V, 3).
        triangles: (F, 3).
        frames: (K, 3, 3), right, up and viewing direction of each pass.
        query_views: (2 K, S, S).
        query_covered: (K,) pixels that the query covers.
        sums: (K, 2), filled.
        faces, weights, views, pixels, normals: (N,), (N, 3), (N,), (N, 2), (N, 2) filled: triangle, barycentric weights
            of the pixel's center in it, number of the pass, column and row, direction out of the outline.

    Returns:
        How many outline pixels were found; at most N.
    """
    size = query_views.shape[1]
    columns = np.empty(points.shape[0], dtype=np.int64)
    rows = np.empty(points.shape[0], dtype=np.int64)
    depths = np.empty(points.shape[0], dtype=np.float64)
    owners = np.empty((size, size), dtype=np.int32)
    found = 0
    for k in range(frames.shape[0]):
        bounds = project(points, frames[k], size, columns, rows, depths)
        sums[k, 0], sums[k, 1] = _compare_pass(
            columns,
            rows,
            depths,
            bounds,
            triangles,
            query_views[2 * k],
            query_views[2 * k + 1],
            query_covered[k],
            owners,
        )
        found = _trace_pass(columns, rows, bounds, triangles, owners, k, found, faces, weights, views, pixels, normals)
    return found


@njit(cache=True, nogil=True)
@no_type_check
def _trace_pass(columns, rows, bounds, triangles, owners, view, found, faces, weights, views, pixels, normals):
    """Append the outline of one drawn pass; return how many pixels there are by then."""
    first_column, last_column, first_row, last_row = bounds
    size = owners.shape[0]
    half = ((size - 1) * _SUBPIXELS) >> 1
    for j in range(max(first_row, 1), min(last_row + 1, size - 1)):
        for i in range(max(first_column, 1), min(last_column + 1, size - 1)):
            f = owners[j, i]
            if f < 0 or (
                first_column < i < last_column
                and first_row < j < last_row
                and owners[j, i - 1] >= 0
                and owners[j, i + 1] >= 0
                and owners[j - 1, i] >= 0
                and owners[j + 1, i] >= 0
            ):
                continue
            if found == faces.shape[0]:
                return found
            a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            x, y = i * _SUBPIXELS - half - columns[a], j * _SUBPIXELS - half - rows[a]
            bx, by = columns[b] - columns[a], rows[b] - rows[a]
            cx, cy = columns[c] - columns[a], rows[c] - rows[a]
            inverse = 1.0 / (bx * cy - by * cx)
            wb, wc = (x * cy - y * cx) * inverse, (bx * y - by * x) * inverse
            faces[found] = f
            weights[found, 0], weights[found, 1], weights[found, 2] = 1.0 - wb - wc, wb, wc
            views[found] = view
            pixels[found, 0], pixels[found, 1] = i, j
            _outward(owners, bounds, j, i, normals[found])
            found += 1
    return found


@njit(cache=True, nogil=True)
@no_type_check
def _outward(owners, bounds, j, i, out):
    """Fill ``out`` with the unit vector (columns, rows) from a covered pixel towards the uncovered ones around it.

    Pixels outside the bounds (first and last column, first and last row) are not covered.
    """
    first_column, last_column, first_row, last_row = bounds
    x, y = 0.0, 0.0
    for dj in range(-2, 3):
        for di in range(-2, 3):
            jj, ii = j + dj, i + di
            if jj < first_row or ii < first_column or jj > last_row or ii > last_column or owners[jj, ii] < 0:
                x += di
                y += dj
    length = np.sqrt(x * x + y * y)
    if length > 0.0:
        out[0], out[1] = x / length, y / length
    else:
        out[0], out[1] = 1.0, 0.0


@njit(cache=True, nogil=True)
@no_type_check
def trace_mask(owners, pixels, normals):
    """Find the covered pixels beside one that is not covered.

    Args:
        owners: (H, W) int32, negative where nothing covers the pixel.
        pixels: (N, 2) filled with column and row.
        normals: (N, 2) filled with the direction out of the mask.

    Returns:
        How many were found; at most N.
    """
    found = 0
    height, width = owners.shape
    bounds = (0, width - 1, 0, height - 1)
    for j in range(1, height - 1):
        for i in range(1, width - 1):
            if owners[j, i] < 0 or (
                owners[j, i - 1] >= 0 and owners[j, i + 1] >= 0 and owners[j - 1, i] >= 0 and owners[j + 1, i] >= 0
            ):
                continue
            if found == pixels.shape[0]:
                return found
            pixels[found, 0], pixels[found, 1] = i, j
            _outward(owners, bounds, j, i, normals[found])
            found += 1
    return found
