"""Compiled kernels of the fast estimator: even samples of a surface, scores of poses, closest points.

They release the interpreter's lock. They share one file on purpose: numba's cache looks at the date of the file a
kernel stands in, not at those of the kernels that it calls.
"""

from typing import no_type_check

import numpy as np
from jaxtyping import Float
from numba import njit
from scipy import sparse


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


@njit(cache=True, nogil=True, fastmath=True)
@no_type_check
def weighted_rows(starts, columns, weights, dense, out):
    """Multiply a sparse matrix in CSR form (N, V) with a dense one (V, C): ``out`` is (N, C)."""
    width = dense.shape[1]
    for i in range(out.shape[0]):
        for c in range(width):
            out[i, c] = 0.0
        for k in range(starts[i], starts[i + 1]):
            row, weight = columns[k], weights[k]
            for c in range(width):
                out[i, c] += weight * dense[row, c]


def sparse_product(matrix: sparse.csr_array, controls: Float[np.ndarray, "B V 3"]) -> Float[np.ndarray, "N C"]:
    """Return samples of every row of control points as columns (x, y, z of the first row, of the second, ...)."""
    dense = np.ascontiguousarray(controls.transpose(1, 0, 2)).reshape(controls.shape[1], -1)
    product = np.empty((matrix.shape[0], dense.shape[1]))
    weighted_rows(matrix.indptr, matrix.indices, matrix.data, dense, product)
    return product


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
        points, normals: (N, 3), what is matched.
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


@njit(cache=True, nogil=True, fastmath=True)
@no_type_check
def pose_jacobian(moves, placed, turn, center, jacobian):
    """Turn derivatives of model-space samples into those of placed ones, and append those of the pose.

    Args:
        moves: (N, 3 D) derivatives of the samples in model space, x, y and z of the first parameter first.
        placed: (N, 3) samples in query space.
        turn: (3, 3) scale times rotation.
        center: (3,) that rotations and the scale leave in place.
        jacobian: (N, 3, D + 7), filled: D parameters, 3 rotations, 3 translations, logarithm of the scale.
    """
    n_parameters = jacobian.shape[2] - 7
    for i in range(placed.shape[0]):
        for c in range(n_parameters):
            mx, my, mz = moves[i, 3 * c], moves[i, 3 * c + 1], moves[i, 3 * c + 2]
            for a in range(3):
                jacobian[i, a, c] = turn[a, 0] * mx + turn[a, 1] * my + turn[a, 2] * mz
        x, y, z = placed[i, 0] - center[0], placed[i, 1] - center[1], placed[i, 2] - center[2]
        d = n_parameters
        for a in range(3):
            for c in range(d, d + 6):
                jacobian[i, a, c] = 0.0
            jacobian[i, a, d + 3 + a] = 1.0
        jacobian[i, 1, d], jacobian[i, 2, d] = -z, y
        jacobian[i, 0, d + 1], jacobian[i, 2, d + 1] = z, -x
        jacobian[i, 0, d + 2], jacobian[i, 1, d + 2] = -y, x
        jacobian[i, 0, d + 6], jacobian[i, 1, d + 6], jacobian[i, 2, d + 6] = x, y, z


@njit(cache=True, nogil=True, fastmath=True)
@no_type_check
def apply_metrics(metrics, jacobian, out):
    """Multiply each sample's (3, 3) metric with its (3, D) Jacobian."""
    width = jacobian.shape[2]
    for i in range(jacobian.shape[0]):
        for a in range(3):
            m0, m1, m2 = metrics[i, a, 0], metrics[i, a, 1], metrics[i, a, 2]
            for c in range(width):
                out[i, a, c] = m0 * jacobian[i, 0, c] + m1 * jacobian[i, 1, c] + m2 * jacobian[i, 2, c]
