"""Compiled kernels that match samples of two surfaces.

They share one file on purpose: numba's cache looks at the date of the file a kernel stands in, not at those of the
kernels that it calls.
"""

from typing import no_type_check

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
@no_type_check
def _closest_on_triangle(px, py, pz, vertices, triangle, out):
    """Put the point of a triangle that is nearest to p into ``out`` (Ericson 2005, section 5.1.5)."""
    a, b, c = triangle[0], triangle[1], triangle[2]
    ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    abx, aby, abz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
    acx, acy, acz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
    apx, apy, apz = px - ax, py - ay, pz - az
    d1, d2 = abx * apx + aby * apy + abz * apz, acx * apx + acy * apy + acz * apz
    bpx, bpy, bpz = apx - abx, apy - aby, apz - abz
    d3, d4 = abx * bpx + aby * bpy + abz * bpz, acx * bpx + acy * bpy + acz * bpz
    cpx, cpy, cpz = apx - acx, apy - acy, apz - acz
    d5, d6 = abx * cpx + aby * cpy + abz * cpz, acx * cpx + acy * cpy + acz * cpz
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    v, w = 0.0, 0.0
    if d1 <= 0.0 and d2 <= 0.0:
        v, w = 0.0, 0.0
    elif d3 >= 0.0 and d4 <= d3:
        v, w = 1.0, 0.0
    elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        v = d1 / (d1 - d3) if d1 > d3 else 0.0
    elif d6 >= 0.0 and d5 <= d6:
        v, w = 0.0, 1.0
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        w = d2 / (d2 - d6) if d2 > d6 else 0.0
    elif va <= 0.0 and d4 >= d3 and d5 >= d6:
        across = (d4 - d3) + (d5 - d6)
        w = (d4 - d3) / across if across > 0.0 else 0.0
        v = 1.0 - w
    else:
        inverse = 1.0 / (va + vb + vc)
        v, w = vb * inverse, vc * inverse
    out[0] = ax + v * abx + w * acx
    out[1] = ay + v * aby + w * acy
    out[2] = az + v * abz + w * acz


@njit(cache=True, nogil=True)
@no_type_check
def _best_pair(x, y, z, normal, others, other_normals, near, spacing, across):
    """Choose among near points the one whose surface a point lies on best.

    What counts is the distance to the plane of the other point, the distance along it beyond ``spacing`` (two sets of
    samples never coincide), how much the normals differ, and a little the distance itself.
    """
    best, chosen = 1e300, 0
    for k in range(near.shape[0]):
        j = near[k]
        ex, ey, ez = x - others[j, 0], y - others[j, 1], z - others[j, 2]
        nx, ny, nz = other_normals[j, 0], other_normals[j, 1], other_normals[j, 2]
        out = ex * nx + ey * ny + ez * nz
        square = ex * ex + ey * ey + ez * ez
        along = max(0.0, np.sqrt(max(square - out * out, 0.0)) - spacing)
        cosine = abs(nx * normal[0] + ny * normal[1] + nz * normal[2])
        cost = out * out + along * along + across * across * (1.0 - cosine) + 0.01 * square
        if cost < best:
            best, chosen = cost, j
    return chosen


@njit(cache=True, nogil=True)
@no_type_check
def match_to_triangles(
    points,
    normals,
    samples,
    sample_normals,
    sample_faces,
    vertices,
    faces,
    near,
    spacing,
    across,
    places,
    place_normals,
):
    """Match points with the surface of a mesh: the best of the near samples, then the closest point of its triangle.

    Args:
        points, normals: (N, 3), the samples to match.
        samples, sample_normals, sample_faces: of the mesh.
        vertices, faces: the mesh.
        near: (N, K) samples that are near each point.
        spacing: of the samples.
        across: how far a point may be for the price of normals at a right angle.
        places, place_normals: (N, 3), filled; normals face as those of the points do.
    """
    for i in range(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        j = _best_pair(x, y, z, normals[i], samples, sample_normals, near[i], spacing, across)
        _closest_on_triangle(x, y, z, vertices, faces[sample_faces[j]], places[i])
        _mean_normal(normals[i], sample_normals[j], place_normals[i])


@njit(cache=True, nogil=True)
@no_type_check
def match_to_samples(points, normals, samples, sample_normals, near, spacing, across, chosen, chosen_normals):
    """Match points with samples: ``chosen`` (N,) is the best of the near ones, with the mean of both normals."""
    for i in range(points.shape[0]):
        j = _best_pair(
            points[i, 0], points[i, 1], points[i, 2], normals[i], samples, sample_normals, near[i], spacing, across
        )
        chosen[i] = j
        _mean_normal(normals[i], sample_normals[j], chosen_normals[i])


@njit(cache=True, nogil=True)
@no_type_check
def nearest_distances(points, others, near, distances):
    """Fill the distance of each point from the nearest of those of the others that are near it."""
    for i in range(points.shape[0]):
        least = np.inf
        for k in range(near.shape[1]):
            j = near[i, k]
            ex, ey, ez = points[i, 0] - others[j, 0], points[i, 1] - others[j, 1], points[i, 2] - others[j, 2]
            least = min(least, ex * ex + ey * ey + ez * ez)
        distances[i] = np.sqrt(least)


@njit(cache=True, nogil=True)
@no_type_check
def _mean_normal(first, second, out):
    """Mean of two normals, turned to the same side; the first where they are at a right angle.

    With it the distance to the plane has no error of first order in the curvature (Rusinkiewicz 2019).
    """
    sign = 1.0 if first[0] * second[0] + first[1] * second[1] + first[2] * second[2] >= 0.0 else -1.0
    square = 0.0
    for d in range(3):
        out[d] = first[d] + sign * second[d]
        square += out[d] * out[d]
    if square > 1e-12:
        inverse = 1.0 / np.sqrt(square)
        for d in range(3):
            out[d] *= inverse
    else:
        for d in range(3):
            out[d] = first[d]
