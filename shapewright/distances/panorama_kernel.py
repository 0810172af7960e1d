"""Compiled kernels of the PANORAMA descriptor; :mod:`shapewright.distances.panorama` is the way in.

All kernels live in this one file on purpose: numba's cache notices a change of the file a kernel is in, but not
of kernels that it calls elsewhere. ``no_type_check`` keeps run-time type checkers out of compiled functions.
"""

import math
from typing import Any, no_type_check

import numba
import numpy as np

ROWS = 64
"""B: heights of a map, equally spaced on the cylinder; each is sampled at the middle of its band."""
COLUMNS = 2 * ROWS
"""Directions of a map, equally spaced around the axis, sampled at the middle of their sectors."""
MOST_TURNS = 8
"""Fourier coefficients are kept for 0..MOST_TURNS periods around the axis, ..."""
MOST_WAVES = 4
"""... and -MOST_WAVES..MOST_WAVES periods along it."""
LEVELS = 6
"""Wavelet levels, log2(B): down to sub-bands of 1 x 2."""
FOURIER_SIZE = (MOST_WAVES + 1) + MOST_TURNS * (2 * MOST_WAVES + 1)
"""Features of one map; without turns, n and -n waves have the same magnitude and are kept once."""
SUB_BANDS = 3 * LEVELS + 1
WAVELET_SIZE = 2 * 3 * SUB_BANDS
"""Features of one map: Haar, then Coiflet; mean absolute value, standard deviation, |skewness| of each sub-band."""
AXIS_FOURIER = 2 * FOURIER_SIZE
AXIS_SIZE = 2 * (FOURIER_SIZE + WAVELET_SIZE)
"""Features of one axis: Fourier of SDM and NDM, then wavelets of SDM and NDM."""

ON_AXIS = 1e-3
"""Surface nearer to the axis than this part of R lies on it and is no hit (a sheet through the axis would
otherwise be hit on a side that rounding chooses)."""
FLAT = 1e-3
"""Standard deviations well below this have no skewness (of what is rounding)."""

_PARTS = np.arange(COLUMNS)
_RAY_COS = np.cos((_PARTS + 0.5) * (2.0 * np.pi / COLUMNS))
_RAY_SIN = np.sin((_PARTS + 0.5) * (2.0 * np.pi / COLUMNS))
_COS = np.cos(_PARTS * (2.0 * np.pi / COLUMNS))  # of k / COLUMNS of a turn
_SIN = np.sin(_PARTS * (2.0 * np.pi / COLUMNS))
_WAVE_PARTS = np.outer(np.arange(MOST_TURNS + 1), _PARTS) % COLUMNS
_WAVE_COS = _COS[_WAVE_PARTS].astype(np.float32)
_WAVE_SIN = _SIN[_WAVE_PARTS].astype(np.float32)


def _compiled(**options: Any) -> Any:
    return numba.njit(cache=True, error_model="numpy", **options)


@_compiled(parallel=True)
@no_type_check
def pose_moments(vertices, triangles, centroids, mean_distances, covariances):
    """Area-weighted centroid, mean distance to it, and covariance of positions and of normals of each mesh.

    ``vertices`` (N, V, 3), ``triangles`` (F, 3) -> ``centroids`` (N, 3), ``mean_distances`` (N,),
    ``covariances`` (N, 2, 3, 3): exact integrals over the triangles (CPCA), area-weighted normals (NPCA). The
    mean distance is by a rule of degree 5 on each triangle, so it hardly depends on how a surface is cut.
    """
    for item in numba.prange(vertices.shape[0]):
        points = vertices[item]
        total = 0.0
        sums = np.zeros(3)
        for f in range(triangles.shape[0]):
            a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            area = _normal(points, a, b, c)[3]
            total += area
            for k in range(3):
                sums[k] += area * (points[a, k] + points[b, k] + points[c, k]) / 3.0
        if not total > 0.0:
            mean_distances[item] = 0.0
            continue
        for k in range(3):
            centroids[item, k] = sums[k] / total
        positions = np.zeros((3, 3))
        normals = np.zeros((3, 3))
        corner = np.empty((3, 3))
        distance = 0.0
        for f in range(triangles.shape[0]):
            a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            nx, ny, nz, area = _normal(points, a, b, c)
            normal = (nx, ny, nz)
            for k in range(3):
                corner[0, k] = points[a, k] - centroids[item, k]
                corner[1, k] = points[b, k] - centroids[item, k]
                corner[2, k] = points[c, k] - centroids[item, k]
            distance += area * _mean_norm(corner)
            for i in range(3):
                for j in range(i + 1):
                    middle = (corner[0, i] + corner[1, i] + corner[2, i]) * (corner[0, j] + corner[1, j] + corner[2, j])
                    squares = corner[0, i] * corner[0, j] + corner[1, i] * corner[1, j] + corner[2, i] * corner[2, j]
                    positions[i, j] += area * (squares + middle) / 12.0
                    normals[i, j] += area * normal[i] * normal[j]
        mean_distances[item] = distance / total
        for i in range(3):
            for j in range(i + 1):
                covariances[item, 0, i, j] = positions[i, j] / total
                covariances[item, 0, j, i] = positions[i, j] / total
                covariances[item, 1, i, j] = normals[i, j] / total
                covariances[item, 1, j, i] = normals[i, j] / total


@_compiled()
@no_type_check
def _normal(points, a, b, c):
    ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
    vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    length = math.sqrt(nx * nx + ny * ny + nz * nz)
    if length == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    return nx / length, ny / length, nz / length, 0.5 * length


@_compiled()
@no_type_check
def _mean_norm(corner):
    """Mean of |p| over a triangle: Radon's rule of seven points."""
    mean = 0.225 * _norm_at(corner, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0)
    root = math.sqrt(15.0)
    for sign in (-1.0, 1.0):
        near = (6.0 + sign * root) / 21.0
        far = 1.0 - 2.0 * near
        weight = (155.0 + sign * root) / 1200.0
        mean += weight * _norm_at(corner, far, near, near)
        mean += weight * _norm_at(corner, near, far, near)
        mean += weight * _norm_at(corner, near, near, far)
    return mean


@_compiled()
@no_type_check
def _norm_at(corner, u, v, w):
    x = u * corner[0, 0] + v * corner[1, 0] + w * corner[2, 0]
    y = u * corner[0, 1] + v * corner[1, 1] + w * corner[2, 1]
    z = u * corner[0, 2] + v * corner[1, 2] + w * corner[2, 2]
    return math.sqrt(x * x + y * y + z * z)


@_compiled(parallel=True)
@no_type_check
def describe(vertices, triangles, centroids, radii, frames, normal_power, low_passes, high_passes, lengths, out):
    """Features of each mesh, alignment and axis: ``out`` (N, 2, 3, AXIS_SIZE) float32.

    ``frames`` (N, 2, 3, 3): principal axes as rows, right-handed. ``low_passes``, ``high_passes`` (2, L): filters
    of the two wavelets, ``lengths`` (2,) of them used. One task draws and describes one cylinder.
    """
    for task in numba.prange(vertices.shape[0] * 6):
        item, alignment, axis = task // 6, (task // 3) % 2, task % 3
        maps = np.zeros((2, ROWS, COLUMNS), dtype=np.float32)
        basis = np.empty((3, 3))
        for k in range(3):  # cyclic, so right-handed; the last one is the cylinder's axis
            basis[k] = frames[item, alignment, (axis + 1 + k) % 3] / radii[item]
        local = np.empty((vertices.shape[1], 3))
        for v in range(vertices.shape[1]):
            x = vertices[item, v, 0] - centroids[item, 0]
            y = vertices[item, v, 1] - centroids[item, 1]
            z = vertices[item, v, 2] - centroids[item, 2]
            for k in range(3):
                local[v, k] = basis[k, 0] * x + basis[k, 1] * y + basis[k, 2] * z
        draw_cylinder(local, triangles, normal_power, maps[0], maps[1])
        features = out[item, alignment, axis]
        for kind in range(2):
            start = kind * FOURIER_SIZE
            _fourier(maps[kind], features[start : start + FOURIER_SIZE])
            start = AXIS_FOURIER + kind * WAVELET_SIZE
            _wavelets(maps[kind], low_passes, high_passes, lengths, features[start : start + WAVELET_SIZE])


@_compiled()
@no_type_check
def draw_cylinder(points, triangles, normal_power, depth, normal):
    """Draw SDM into ``depth`` and NDM into ``normal`` (ROWS, COLUMNS), both zero before.

    ``points`` (V, 3) in units of R with the axis along z. All rays of a row lie in one plane across the axis;
    that plane cuts a triangle in a segment, and the segment covers the directions between its two ends, the
    short way round. So the candidates are exact, also across the seam at angle 0, and the depth of each is the
    exact crossing of ray and segment. Surface above, below or beyond the cylinder is not drawn.
    """
    columns_per_rad = COLUMNS / (2.0 * math.pi)
    for f in range(triangles.shape[0]):
        low, middle, high = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        nx, ny, _, area = _normal(points, low, middle, high)
        if area == 0.0:
            continue
        # edges are always walked upward, so that neighbours get the same cut and no crack opens between them
        if points[low, 2] > points[middle, 2]:
            low, middle = middle, low
        if points[middle, 2] > points[high, 2]:
            middle, high = high, middle
        if points[low, 2] > points[middle, 2]:
            low, middle = middle, low
        bottom, top = points[low, 2], points[high, 2]
        if bottom > 1.0 or top < -1.0:
            continue
        first = max(0, math.ceil((bottom + 1.0) * (0.5 * ROWS) - 0.5))
        last = min(ROWS - 1, math.floor((top + 1.0) * (0.5 * ROWS) - 0.5))
        for v in range(first, last + 1):
            height = (v + 0.5) * (2.0 / ROWS) - 1.0
            px, py = _cut(points, low, high, height)
            if height < points[middle, 2]:
                qx, qy = _cut(points, low, middle, height)
            else:
                qx, qy = _cut(points, middle, high, height)
            area_cross = px * qy - py * qx
            farthest = math.sqrt(max(px * px + py * py, qx * qx + qy * qy))
            if area_cross == 0.0 or farthest <= ON_AXIS:
                continue
            start = math.atan2(py, px) * columns_per_rad - 0.5
            # positive cross: the segment turns by less than half a turn from p to q
            turn = math.atan2(area_cross, px * qx + py * qy) * columns_per_rad
            lower = math.ceil(min(start, start + turn))
            upper = math.floor(max(start, start + turn))
            dx, dy = qx - px, qy - py
            for column in range(lower, upper + 1):
                u = column % COLUMNS
                across = _RAY_COS[u] * dy - _RAY_SIN[u] * dx
                if across == 0.0:
                    continue
                distance = min(area_cross / across, farthest)
                if ON_AXIS < distance <= 1.0 and distance > depth[v, u]:
                    depth[v, u] = distance
                    normal[v, u] = abs(_RAY_COS[u] * nx + _RAY_SIN[u] * ny) ** normal_power


@_compiled()
@no_type_check
def _cut(points, lower, upper, height):
    rise = points[upper, 2] - points[lower, 2]
    part = (height - points[lower, 2]) / rise if rise > 0.0 else 0.0
    x = points[lower, 0] + part * (points[upper, 0] - points[lower, 0])
    y = points[lower, 1] + part * (points[upper, 1] - points[lower, 1])
    return x, y


@_compiled(fastmath=True)
@no_type_check
def _fourier(image, out):
    """Magnitudes of the low frequencies of the 2-D DFT, divided by their sum; zeros for an empty map."""
    turns = MOST_TURNS + 1
    waves = 2 * MOST_WAVES + 1
    real = np.zeros((waves, turns))
    imaginary = np.zeros((waves, turns))
    for v in range(ROWS):
        row = image[v]
        if not row.any():
            continue
        for m in range(turns):
            row_real = np.float32(0.0)
            row_imaginary = np.float32(0.0)
            for u in range(COLUMNS):
                row_real += row[u] * _WAVE_COS[m, u]
                row_imaginary -= row[u] * _WAVE_SIN[m, u]
            for n in range(waves):
                part = (2 * (n - MOST_WAVES) * v) % COLUMNS
                c, s = _COS[part], _SIN[part]
                real[n, m] += row_real * c + row_imaginary * s
                imaginary[n, m] += row_imaginary * c - row_real * s
    total = 0.0
    position = 0
    for m in range(turns):
        for n in range(MOST_WAVES if m == 0 else 0, waves):
            magnitude = math.sqrt(real[n, m] ** 2 + imaginary[n, m] ** 2)
            out[position] = magnitude
            total += magnitude
            position += 1
    if total > 0.0:
        for k in range(position):
            out[k] /= total


@_compiled()
@no_type_check
def _wavelets(image, low_passes, high_passes, lengths, out):
    """Statistics of the sub-bands of two wavelets, each the mean over the map and the map turned by 180 degrees."""
    image_rows, image_columns = image.shape
    work = np.empty((image_rows, image_columns), dtype=np.float32)
    spare = np.empty((image_rows, image_columns), dtype=np.float32)
    out[:] = 0.0
    for wavelet in range(2):
        length = lengths[wavelet]
        versions = 1 if length == 2 else 2  # Haar is symmetric: both versions give the same
        for version in range(versions):
            for v in range(image_rows):
                for u in range(image_columns):
                    work[v, u] = image[v, u] if version == 0 else image[image_rows - 1 - v, image_columns - 1 - u]
            position = wavelet * 3 * SUB_BANDS
            rows, columns = image_rows, image_columns
            for _ in range(LEVELS):
                analyse(work, spare, rows, columns, low_passes[wavelet, :length], high_passes[wavelet, :length])
                rows //= 2
                columns //= 2
                _statistics(work[rows : 2 * rows, :columns], versions, out[position : position + 3])
                _statistics(work[:rows, columns : 2 * columns], versions, out[position + 3 : position + 6])
                _statistics(work[rows : 2 * rows, columns : 2 * columns], versions, out[position + 6 : position + 9])
                position += 9
            _statistics(work[:rows, :columns], versions, out[position : position + 3])


@_compiled()
@no_type_check
def analyse(work, spare, rows, columns, low_pass, high_pass):
    """One level of a periodic 2-D DWT of ``work[:rows, :columns]`` in place: low and high halves side by side."""
    length = len(low_pass)
    half = columns // 2
    for v in range(rows):
        for k in range(half):
            low = np.float32(0.0)
            high = np.float32(0.0)
            base = 2 * k + length // 2
            if base - length >= -1 and base < columns:
                for j in range(length):
                    low += low_pass[j] * work[v, base - j]
                    high += high_pass[j] * work[v, base - j]
            else:
                for j in range(length):
                    value = work[v, (base - j) % columns]
                    low += low_pass[j] * value
                    high += high_pass[j] * value
            spare[v, k] = low
            spare[v, half + k] = high
    half = rows // 2
    for k in range(half):
        for u in range(columns):
            work[k, u] = 0.0
            work[half + k, u] = 0.0
        for j in range(length):
            v = (2 * k + length // 2 - j) % rows
            low_factor, high_factor = low_pass[j], high_pass[j]
            for u in range(columns):
                work[k, u] += low_factor * spare[v, u]
                work[half + k, u] += high_factor * spare[v, u]


@_compiled(fastmath={"contract", "reassoc", "nsz"})
@no_type_check
def _statistics(band, versions, out):
    rows, columns = band.shape
    total = 0.0
    absolute = 0.0
    for v in range(rows):
        for u in range(columns):
            total += band[v, u]
            absolute += abs(band[v, u])
    count = rows * columns
    mean = total / count
    second = 0.0
    third = 0.0
    for v in range(rows):
        for u in range(columns):
            away = band[v, u] - mean
            second += away * away
            third += away * away * away
    variance = second / count
    out[0] += absolute / count / versions
    out[1] += math.sqrt(variance) / versions
    out[2] += abs(third / count) / (variance + FLAT * FLAT) ** 1.5 / versions


@_compiled(parallel=True)
@no_type_check
def distances(query, bank, axis_weights, softening, out):
    """Distance of ``query`` (2, 3, AXIS_SIZE) to each row of ``bank`` (N, 2, 3, AXIS_SIZE)."""
    for item in numba.prange(bank.shape[0]):
        best = np.inf
        for alignment in range(2):
            total = 0.0
            for axis in range(3):
                a = query[alignment, axis]
                b = bank[item, alignment, axis]
                manhattan = 0.0
                for k in range(AXIS_FOURIER):
                    manhattan += abs(np.float64(a[k]) - np.float64(b[k]))
                canberra = 0.0
                for k in range(AXIS_FOURIER, AXIS_SIZE):
                    x, y = np.float64(a[k]), np.float64(b[k])
                    canberra += abs(x - y) / (abs(x) + abs(y) + softening)
                total += axis_weights[axis] * (manhattan / 4.0 + canberra / (AXIS_SIZE - AXIS_FOURIER))
            best = min(best, total)
        out[item] = best
