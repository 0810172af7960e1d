"""Compiled kernels that spread samples evenly over a surface and follow them as its control points move."""

from typing import no_type_check

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
@no_type_check
def sample_surface(points, triangles, count, first_share):
    """Spread ``count`` points evenly over a surface: systematic sampling along its cumulated area.

    Triangles keep their order, in which neighbors mostly lie side by side, so that equal steps of area are spread
    evenly. Within a triangle the points follow the R2 sequence (Roberts 2018).

    Args:
        points: (V, 3).
        triangles: (F, 3).
        count: number of samples N.
        first_share: place of the first sample in its step, in [0, 1).

    Returns:
        triangle (N,) int64, barycentric weights (N, 3), unit normal (N, 3); count 0 if the surface has no area.
    """
    n_triangles = triangles.shape[0]
    sums = np.empty(n_triangles)
    normals = np.empty((n_triangles, 3))
    total = 0.0
    for f in range(n_triangles):
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
        vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        area = np.sqrt(nx * nx + ny * ny + nz * nz)
        total += area
        sums[f] = total
        inverse = 1.0 / area if area > 0.0 else 0.0
        normals[f, 0], normals[f, 1], normals[f, 2] = nx * inverse, ny * inverse, nz * inverse
    if not total > 0.0:
        return np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3))
    chosen = np.empty(count, np.int64)
    weights = np.empty((count, 3))
    normal = np.empty((count, 3))
    f = 0
    for i in range(count):
        wanted = (i + first_share) / count * total
        while f < n_triangles - 1 and sums[f] <= wanted:
            f += 1
        first = (0.5 + 0.7548776662466927 * (i + 1)) % 1.0
        second = (0.5 + 0.5698402909980532 * (i + 1)) % 1.0
        root = np.sqrt(first)
        chosen[i] = f
        weights[i, 0], weights[i, 1], weights[i, 2] = 1.0 - root, root * (1.0 - second), root * second
        normal[i] = normals[f]
    return chosen, weights, normal


@njit(cache=True, nogil=True)
@no_type_check
def place_samples(points, triangles, chosen, weights, out):
    """Fill ``out`` (N, 3) with the places of barycentric samples."""
    for i in range(chosen.shape[0]):
        a, b, c = triangles[chosen[i], 0], triangles[chosen[i], 1], triangles[chosen[i], 2]
        for d in range(3):
            out[i, d] = weights[i, 0] * points[a, d] + weights[i, 1] * points[b, d] + weights[i, 2] * points[c, d]


@njit(cache=True, nogil=True)
@no_type_check
def combine_rows(chosen, weights, triangles, starts, columns, entries, n_columns):
    """Express barycentric samples of a surface in the points that make its vertices.

    Args:
        chosen: (N,) triangle of each sample.
        weights: (N, 3) barycentric.
        triangles: (F, 3) vertex indices.
        starts, columns, entries: a sparse matrix (vertices, V) in CSR form that makes the vertices.
        n_columns: V.

    Returns:
        The sparse matrix (N, V) that makes the samples, in CSR form.
    """
    count = chosen.shape[0]
    most = 0
    for i in range(count):
        for corner in range(3):
            vertex = triangles[chosen[i], corner]
            most += starts[vertex + 1] - starts[vertex]
    out_starts = np.empty(count + 1, np.int64)
    out_columns, out_entries = np.empty(most, np.int64), np.empty(most)
    place = np.full(n_columns, -1, np.int64)
    end = 0
    for i in range(count):
        begin = out_starts[i] = end
        for corner in range(3):
            vertex, weight = triangles[chosen[i], corner], weights[i, corner]
            for k in range(starts[vertex], starts[vertex + 1]):
                column = columns[k]
                if place[column] < begin:
                    place[column] = end
                    out_columns[end], out_entries[end] = column, 0.0
                    end += 1
                out_entries[place[column]] += weight * entries[k]
    out_starts[count] = end
    return out_starts, out_columns[:end].copy(), out_entries[:end].copy()


@njit(cache=True, nogil=True, fastmath=True)
@no_type_check
def make_points(starts, columns, entries, control, out):
    """Fill ``out`` (N, 3) with the product of a sparse matrix (N, V) in CSR form and control points (V, 3)."""
    for i in range(out.shape[0]):
        x, y, z = 0.0, 0.0, 0.0
        for k in range(starts[i], starts[i + 1]):
            row, weight = columns[k], entries[k]
            x += weight * control[row, 0]
            y += weight * control[row, 1]
            z += weight * control[row, 2]
        out[i, 0], out[i, 1], out[i, 2] = x, y, z


@njit(cache=True, nogil=True)
@no_type_check
def face_areas(points, triangles, areas):
    """Fill ``areas`` (B, F) with the areas of the triangles (F, 3) of several surfaces (B, V, 3)."""
    for row in range(points.shape[0]):
        for f in range(triangles.shape[0]):
            a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            ax, ay, az = points[row, a, 0], points[row, a, 1], points[row, a, 2]
            ux, uy, uz = points[row, b, 0] - ax, points[row, b, 1] - ay, points[row, b, 2] - az
            vx, vy, vz = points[row, c, 0] - ax, points[row, c, 1] - ay, points[row, c, 2] - az
            nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            areas[row, f] = 0.5 * np.sqrt(nx * nx + ny * ny + nz * nz)
