"""Least squares over the pose and all active measures together (Levenberg 1944, Marquardt 1963; ours).

The residual is the distance between the query and the instance, both ways: every sample of the instance to the closest
triangle of the query, every point of the query to the best sample of the instance. Only the component along the mean
normal counts, and the one along the surface beyond the spacing of the samples; far pairs lose their weight.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import cKDTree

from shapewright.estimation.fast import kernels
from shapewright.estimation.fast.candidate import Candidate, Curvature
from shapewright.estimation.fast.fitted_model import barycentric_rows
from shapewright.estimation.fast.measure import outline_distance
from shapewright.estimation.fast.target import SAMPLES, Target

_DIFFERENCE = 1e-4
"""Step of the finite differences, in shares of a range."""
_REACH = 0.3
"""Longest step: of a measure in shares of its range, of the pose in radians, half extents, logarithm of scale."""
_FAR = 0.3
"""Distances beyond this count no more in the misfit."""
_LEAST_WIDTH = 0.01
_SAMPLED_EVERY = 3
_GAIN, _PATIENCE = 0.003, 1
"""A round gains if its distance falls by this share; with outlines the search ends after more rounds without a gain."""
_SETTLED = 2e-5
"""Root mean square move of the surface, in half extents, below which a search by surfaces alone has settled. Distances
between samples have a floor far above what the values still gain."""
_EXACT_SPACING = 0.005
_ACROSS = 0.1
"""Pairs whose normals are at a right angle cost as much as so large a distance."""


@dataclass(frozen=True)
class Effort:
    """How a least-squares search works.

    Attributes:
        rounds: at most; fewer if nothing is gained any more.
        points: samples on either side.
        steps: subdivision steps of the surface.
        neighbors: near samples among which each pair is chosen.
        width: of the robust weight; ``None`` follows the median distance.
        damping: relative to the curvature.
        pull: of each measure towards the middle of its range, where nothing else is known.
        outline: points of the outlines on either side; none if 0.
        outline_weight: of all of them together; the surfaces have 1.
        outline_width: of their robust weight.
    """

    rounds: int
    points: int
    steps: int
    neighbors: int = 6
    width: float | None = None
    damping: float = 1e-3
    pull: float = 1e-8
    outline: int = 0
    outline_weight: float = 10.0
    outline_width: float = 0.1


def fit(
    target: Target,
    candidate: Candidate,
    effort: Effort,
    *,
    keeps_scale: bool = False,
    keeps_rotation: bool = False,
    checkpoint: Callable[[], None] | None = None,
) -> Candidate:
    """Move a candidate to where query and instance are nearest to each other.

    Args:
        target: the query.
        candidate: where to begin.
        effort: how to work.
        keeps_scale: whether the scale of the pose stays.
        keeps_rotation: whether its rotation stays.
        checkpoint: called once a round; may raise to stop.

    Returns:
        The best round: of the later half the one with the smallest z-buffer distance if outlines pull, else the last
        one whose misfit is hardly larger than the smallest.
    """
    samples = None
    best, stale = candidate, 0
    least = movement = np.inf
    for number in range(effort.rounds + 1):
        if checkpoint is not None:
            checkpoint()
        if effort.outline and number >= effort.rounds // 2:
            candidate = outline_distance(target, candidate)
            gains = candidate.zbuffer < (1.0 - _GAIN) * best.zbuffer
            stale = 0 if gains or number == effort.rounds // 2 else stale + 1
            best = candidate if number == effort.rounds // 2 else min(best, candidate, key=lambda one: one.zbuffer)
            if number == effort.rounds or stale > _PATIENCE:
                break
        model = candidate.model
        columns, lowest, highest = model.free_columns(candidate.values)
        rows, differences = _rows_around(candidate, columns, highest)
        controls = model.compiled.control_points(rows)
        if number % _SAMPLED_EVERY == 0 or samples is None:
            samples = model.samples(controls[0], effort.points, effort.steps, (0.5 + 0.618 * number) % 1.0)
            if samples is None:
                break
        matrix, normals = samples
        moves = kernels.sparse_product(matrix, controls)
        matches = _match(target, candidate, effort, np.ascontiguousarray(moves[:, :3]), normals)
        if not effort.outline:
            candidate = replace(candidate, misfit=matches.misfit)
            least = min(least, candidate.misfit)
            if candidate.misfit <= (1.0 + _GAIN) * least:
                best = candidate
            if number == effort.rounds or movement < _SETTLED:
                break
        system = _surface_system(target, candidate, effort, matches, moves, differences)
        if effort.outline:
            _add_outline(system, target, candidate, effort, controls, differences)
        free = np.ones(len(columns) + 7, dtype=bool)
        free[-1] = not keeps_scale
        free[len(columns) : len(columns) + 3] = not keeps_rotation
        step = _bounded_step(candidate, effort, system, columns, lowest, highest, free)
        movement = float(np.sqrt(max(0.0, step @ system.curvature @ step)))
        curvature = Curvature(columns, system.curvature)
        candidate = replace(candidate.moved(columns, step, target.center), curvature=curvature)
    return best


def _rows_around(
    candidate: Candidate, columns: Int[np.ndarray, " D"], highest: Float[np.ndarray, " P"]
) -> tuple[Float[np.ndarray, "B P"], Float[np.ndarray, " D"]]:
    """Rows for finite differences, the candidate's own first, and the steps in shares of the ranges."""
    widths = candidate.model.widths[columns]
    upward = candidate.values[columns] + _DIFFERENCE * widths <= highest[columns]
    differences = np.where(upward, _DIFFERENCE, -_DIFFERENCE)
    rows = np.repeat(candidate.values[None], len(columns) + 1, axis=0)
    rows[np.arange(1, len(columns) + 1), columns] += differences * widths
    return rows, differences


@dataclass(frozen=True, eq=False)
class _Matches:
    """Pairs of both directions: the placed samples of the instance and what of the query they belong to."""

    placed: Float[np.ndarray, "N 3"]
    offsets: Float[np.ndarray, "N 3"]
    normals: Float[np.ndarray, "N 3"]
    query_rows: Int[np.ndarray, " M"]
    query_offsets: Float[np.ndarray, "M 3"]
    query_normals: Float[np.ndarray, "M 3"]
    misfit: float
    median: float


def _match(
    target: Target,
    candidate: Candidate,
    effort: Effort,
    samples: Float[np.ndarray, "N 3"],
    normals: Float[np.ndarray, "N 3"],
) -> _Matches:
    count, near = effort.points, effort.neighbors
    placed = candidate.placed(samples)
    turned = np.ascontiguousarray(normals @ candidate.rotation.T)
    there, places, place_normals = _closest(target, placed, turned, near)
    points, point_normals = target.points[:count], target.normals[:count]
    own_tree = cKDTree(placed, balanced_tree=False, compact_nodes=False)
    own_distances, own_rows = own_tree.query(points, k=[*range(1, min(near, len(placed)) + 1)])
    chosen, chosen_normals = np.empty(count, dtype=np.int64), np.empty_like(points)
    kernels.match_to_samples(
        points, point_normals, placed, turned, own_rows, target.spacing(count), _ACROSS, chosen, chosen_normals
    )
    back = np.asarray(own_distances)[:, 0]
    misfit = 0.5 * float(np.minimum(there, _FAR).mean() + np.minimum(back, _FAR).mean())
    median = float(np.median(there) + np.median(back))
    return _Matches(
        placed, placed - places, place_normals, chosen, placed[chosen] - points, chosen_normals, misfit, median
    )


def closest_places(
    target: Target, placed: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"]
) -> Float[np.ndarray, "N 3"]:
    """Return the places on the query's triangles that samples of an instance belong to."""
    return _closest(target, placed, normals, Effort.neighbors)[1]


def _closest(
    target: Target, placed: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"], near: int
) -> tuple[Float[np.ndarray, " N"], Float[np.ndarray, "N 3"], Float[np.ndarray, "N 3"]]:
    """Return the distance to the nearest sample of the query, the place on its triangles, and the normal there."""
    distances, rows = target.tree.query(placed, k=[*range(1, near + 1)])
    places, place_normals = np.empty_like(placed), np.empty_like(placed)
    kernels.match_to_triangles(
        placed, normals, target.points, target.normals, target.faces, target.vertices, target.triangles,
        rows, target.spacing(SAMPLES), _ACROSS, places, place_normals,
    )  # fmt: skip
    return np.asarray(distances)[:, 0], places, place_normals


@dataclass(frozen=True, eq=False)
class _System:
    """Normal equations: the curvature and the gradient, in the units of :class:`Curvature`."""

    curvature: Float[np.ndarray, "N N"]
    gradient: Float[np.ndarray, " N"]

    @classmethod
    def empty(cls, size: int) -> "_System":
        return cls(np.zeros((size, size)), np.zeros(size))

    def add(
        self,
        candidate: Candidate,
        target: Target,
        moves: Float[np.ndarray, "N C"],
        differences: Float[np.ndarray, " D"],
        metrics: Float[np.ndarray, "N 3 3"],
        forces: Float[np.ndarray, "N 3"],
    ) -> None:
        """Add what pulls samples; ``moves`` are the samples of every row around the candidate, in model space."""
        count = len(moves)
        slopes = moves[:, 3:].reshape(count, -1, 3) - moves[:, None, :3]
        slopes /= differences[:, None]
        jacobian = np.empty((count, 3, len(differences) + 7))
        kernels.pose_jacobian(
            slopes.reshape(count, -1), candidate.placed(np.ascontiguousarray(moves[:, :3])),
            candidate.scale * candidate.rotation, target.center, jacobian,
        )  # fmt: skip
        weighted = np.empty_like(jacobian)
        kernels.apply_metrics(metrics, jacobian, weighted)
        flat = jacobian.reshape(3 * count, -1)
        self.curvature[:] += flat.T @ weighted.reshape(3 * count, -1)
        self.gradient[:] += flat.T @ forces.ravel()


def _surface_system(
    target: Target,
    candidate: Candidate,
    effort: Effort,
    matches: _Matches,
    moves: Float[np.ndarray, "N C"],
    differences: Float[np.ndarray, " D"],
) -> _System:
    count, n_query = len(matches.placed), len(matches.query_rows)
    width = max(_LEAST_WIDTH, 1.5 * matches.median) if effort.width is None else effort.width
    metrics, forces = np.zeros((count, 3, 3)), np.zeros((count, 3))
    kernels.add_pairs(
        np.arange(count), matches.offsets, matches.normals, _EXACT_SPACING, width, 1.0 / count, metrics, forces
    )
    kernels.add_pairs(
        matches.query_rows, matches.query_offsets, matches.query_normals, 1.5 * target.spacing(n_query), width,
        1.0 / n_query, metrics, forces,
    )  # fmt: skip
    system = _System.empty(len(differences) + 7)
    system.add(candidate, target, moves, differences, metrics, forces)
    return system


def _add_outline(
    system: _System,
    target: Target,
    candidate: Candidate,
    effort: Effort,
    controls: Float[np.ndarray, "B V 3"],
    differences: Float[np.ndarray, " D"],
) -> None:
    model = candidate.model
    placed = np.ascontiguousarray(candidate.placed(model.outline @ controls[0]))
    pulls = target.outline.pulls(
        placed, model.outline_triangles, effort.outline, effort.outline_weight, effort.outline_width
    )
    if pulls is not None:
        matrix = barycentric_rows(pulls.faces, pulls.weights, model.outline_triangles, model.outline)
        system.add(
            candidate, target, kernels.sparse_product(matrix, controls), differences, pulls.metrics, pulls.forces
        )


def _bounded_step(
    candidate: Candidate,
    effort: Effort,
    system: _System,
    columns: Int[np.ndarray, " D"],
    lowest: Float[np.ndarray, " P"],
    highest: Float[np.ndarray, " P"],
    free: Bool[np.ndarray, " N"],
) -> Float[np.ndarray, " N"]:
    """Solve for a damped step that stays in the ranges: what would leave its range is held at its end."""
    count = len(columns)
    widths = candidate.model.widths[columns]
    matrix, gradient = system.curvature.copy(), system.gradient.copy()
    middle = (candidate.values[columns] - candidate.model.compiled.minimum[columns]) / widths - 0.5
    diagonal = np.arange(count + 7)
    matrix[diagonal, diagonal] += effort.damping * np.maximum(np.diag(system.curvature), 1e-6)
    matrix[diagonal[:count], diagonal[:count]] += effort.pull
    gradient[:count] += effort.pull * middle
    down = np.maximum((lowest[columns] - candidate.values[columns]) / widths, -_REACH)
    up = np.minimum((highest[columns] - candidate.values[columns]) / widths, _REACH)
    free[:count] &= ~((down > -1e-9) & (gradient[:count] > 0)) & ~((up < 1e-9) & (gradient[:count] < 0))
    step = np.zeros(count + 7)
    for _ in range(4):
        open_, held = np.flatnonzero(free), np.flatnonzero(~free)
        right = gradient[open_] + matrix[np.ix_(open_, held)] @ step[held]
        step[open_] = -np.linalg.solve(matrix[np.ix_(open_, open_)], right)
        outside = np.zeros_like(free)
        outside[:count] = free[:count] & ((step[:count] < down - 1e-12) | (step[:count] > up + 1e-12))
        if not outside.any():
            break
        step[:count] = np.where(outside[:count], np.clip(step[:count], down, up), step[:count])
        free &= ~outside
    step[:count] = np.clip(step[:count], down, up)
    step[count:] /= max(1.0, float(np.abs(step[count:]).max()) / _REACH)
    return step
