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

from shapewright.estimation.fast import matching_kernels, system_kernels
from shapewright.estimation.fast.candidate import Candidate, Curvature
from shapewright.estimation.fast.measure import outline_distance
from shapewright.estimation.fast.outline import Trace
from shapewright.estimation.fast.sparse_rows import SparseRows
from shapewright.estimation.fast.target import SAMPLES, Target

_DIFFERENCE = 1e-4
"""Step of the finite differences, in shares of a range."""
_REACH = 0.3
"""Longest step: of a measure in shares of its range, of the pose in radians, half extents, logarithm of scale."""
_FAR = 0.3
"""Distances beyond this count no more in the misfit."""
_LEAST_WIDTH = 0.01
_SAMPLED_EVERY = 3
_SAME_NEIGHBORS = 0.25
"""Root mean square move of the surface, in spacings of the query's samples, after which neighbors are searched anew."""
_GAIN, _PATIENCE = 0.003, 1
"""A round gains if its distance falls by this share; with outlines the search ends after more rounds without a gain."""
_SETTLED = 2e-5
"""Root mean square move of the surface, in half extents, below which a search by surfaces alone has settled. Distances
between samples have a floor far above what the values still gain."""
_EXACT_SPACING = 0.005
ACROSS = 0.1
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
    samples, neighbors = None, None
    drift = 0.0
    best, stale = candidate, 0
    least = movement = np.inf
    for number in range(effort.rounds + 1):
        if checkpoint is not None:
            checkpoint()
        if effort.outline and number == effort.rounds:
            return min(best, outline_distance(target, candidate), key=lambda one: one.zbuffer)
        around = _Around.of(candidate)
        trace = None
        if effort.outline:
            model = candidate.model
            drawn = candidate.placed(model.outline.points(around.control))
            zbuffer, trace = target.traced(drawn, model.outline_triangles)
            if number >= effort.rounds // 2:
                candidate = replace(candidate, zbuffer=zbuffer)
                first = number == effort.rounds // 2
                stale = 0 if first or zbuffer < (1.0 - _GAIN) * best.zbuffer else stale + 1
                best = candidate if first or zbuffer < best.zbuffer else best
                if stale > _PATIENCE:
                    break
        if number % _SAMPLED_EVERY == 0 or samples is None:
            first_share = (0.5 + 0.618 * number) % 1.0
            samples = candidate.model.samples(around.control, effort.points, effort.steps, first_share)
            neighbors = None
            if samples is None:
                break
        made, normals = samples
        placed, normals = _placed(candidate, made.points(around.control), normals)
        if neighbors is None or drift > _SAME_NEIGHBORS * target.spacing(SAMPLES):
            neighbors, drift = _Neighbors.find(target, placed, effort), 0.0
        matches = _match(target, placed, normals, neighbors)
        if not effort.outline:
            candidate = replace(candidate, misfit=matches.misfit)
            least = min(least, candidate.misfit)
            if candidate.misfit <= (1.0 + _GAIN) * least:
                best = candidate
            if number == effort.rounds or movement < _SETTLED:
                break
        system = _System.empty(len(around.columns) + 7)
        _add_surface(system, target, candidate, effort, around, matches, made)
        if trace is not None:
            _add_outline(system, target, candidate, effort, around, trace)
        free = np.ones(len(around.columns) + 7, dtype=bool)
        free[-1] = not keeps_scale
        free[-7:-4] = not keeps_rotation
        curvature = system.whole()
        step = _bounded_step(candidate, effort, curvature, system.gradient, around, free)
        movement = float(np.sqrt(max(0.0, step @ curvature @ step)))
        drift += movement
        candidate = candidate.moved(around.columns, step, target.center)
        candidate = replace(candidate, curvature=Curvature(around.columns, curvature))
    return best


@dataclass(frozen=True, eq=False)
class _Around:
    """The control points of a candidate and how its free measures move them.

    Attributes:
        columns: of the D free measures.
        lowest, highest: (P,) ends of the ranges.
        control: (V, 3).
        starts, moved, moves: which free measure moves each control point and how, for a step of a whole range.
    """

    columns: Int[np.ndarray, " D"]
    lowest: Float[np.ndarray, " P"]
    highest: Float[np.ndarray, " P"]
    control: Float[np.ndarray, "V 3"]
    starts: Int[np.ndarray, " V1"]
    moved: Int[np.ndarray, " K"]
    moves: Float[np.ndarray, "K 3"]

    @classmethod
    def of(cls, candidate: Candidate) -> "_Around":
        """Evaluate the candidate, and once more for every free measure."""
        model = candidate.model
        columns, lowest, highest = model.free_columns(candidate.values)
        widths = model.widths[columns]
        upward = candidate.values[columns] + _DIFFERENCE * widths <= highest[columns]
        differences = np.where(upward, _DIFFERENCE, -_DIFFERENCE)
        rows = np.repeat(candidate.values[None], len(columns) + 1, axis=0)
        rows[np.arange(1, len(columns) + 1), columns] += differences * widths
        controls = model.compiled.control_points(rows)
        slopes = (controls[1:] - controls[0]) / differences[:, None, None]
        return cls(columns, lowest, highest, controls[0], *system_kernels.moved_columns(slopes))


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


@dataclass(frozen=True, eq=False)
class _Neighbors:
    """Among which samples pairs are chosen.

    Attributes:
        there: (N, K) rows of samples of the query that are near each sample of the instance.
        back: (M, K) rows of samples of the instance near each of the first M samples of the query.
    """

    there: Int[np.ndarray, "N K"]
    back: Int[np.ndarray, "M K"]

    @classmethod
    def find(cls, target: Target, placed: Float[np.ndarray, "N 3"], effort: Effort) -> "_Neighbors":
        """Search both ways."""
        return cls(
            _near(target.tree, placed, effort.neighbors),
            _near(_tree(placed), target.points[: effort.points], effort.neighbors),
        )


def _tree(points: Float[np.ndarray, "N 3"]) -> cKDTree:
    return cKDTree(points, balanced_tree=False, compact_nodes=False)


def _near(tree: cKDTree, points: Float[np.ndarray, "N 3"], count: int) -> Int[np.ndarray, "N K"]:
    return np.asarray(tree.query(points, k=[*range(1, min(count, tree.n) + 1)])[1])


def _placed(
    candidate: Candidate, samples: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"]
) -> tuple[Float[np.ndarray, "N 3"], Float[np.ndarray, "N 3"]]:
    return candidate.placed(samples), np.ascontiguousarray(normals @ candidate.rotation.T)


def _match(
    target: Target, placed: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"], neighbors: _Neighbors
) -> _Matches:
    there, back = np.empty(len(placed)), np.empty(len(neighbors.back))
    points, point_normals = target.points[: len(back)], target.normals[: len(back)]
    places, place_normals = _on_query(target, placed, normals, neighbors.there)
    chosen, chosen_normals = np.empty(len(back), dtype=np.int64), np.empty_like(points)
    matching_kernels.match_to_samples(
        points, point_normals, placed, normals, neighbors.back, target.spacing(len(back)), ACROSS, chosen,
        chosen_normals,
    )  # fmt: skip
    matching_kernels.nearest_distances(placed, target.points, neighbors.there, there)
    matching_kernels.nearest_distances(points, placed, neighbors.back, back)
    misfit = 0.5 * float(np.minimum(there, _FAR).mean() + np.minimum(back, _FAR).mean())
    median = float(np.median(there) + np.median(back))
    return _Matches(
        placed, placed - places, place_normals, chosen, placed[chosen] - points, chosen_normals, misfit, median
    )


def closest(
    target: Target, placed: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"], near: int
) -> tuple[Float[np.ndarray, "N 3"], Float[np.ndarray, "N 3"]]:
    """Return the places on the query's triangles that samples of an instance belong to, and the mean normals there."""
    return _on_query(target, placed, normals, _near(target.tree, placed, near))


def _on_query(
    target: Target, placed: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"], rows: Int[np.ndarray, "N K"]
) -> tuple[Float[np.ndarray, "N 3"], Float[np.ndarray, "N 3"]]:
    places, place_normals = np.empty_like(placed), np.empty_like(placed)
    matching_kernels.match_to_triangles(
        placed, normals, target.points, target.normals, target.faces, target.vertices, target.triangles,
        rows, target.spacing(SAMPLES), ACROSS, places, place_normals,
    )  # fmt: skip
    return places, place_normals


@dataclass(frozen=True, eq=False)
class _System:
    """Normal equations: the lower triangle of the curvature, and the gradient, in the units of :class:`Curvature`."""

    curvature: Float[np.ndarray, "N N"]
    gradient: Float[np.ndarray, " N"]

    @classmethod
    def empty(cls, size: int) -> "_System":
        return cls(np.zeros((size, size)), np.zeros(size))

    def add(
        self,
        candidate: Candidate,
        target: Target,
        around: _Around,
        made: SparseRows,
        placed: Float[np.ndarray, "N 3"],
        metrics: Float[np.ndarray, "N 3 3"],
        forces: Float[np.ndarray, "N 3"],
    ) -> None:
        """Add what pulls samples that are made of control points."""
        system_kernels.add_system(
            made.starts, made.columns, made.entries, around.starts, around.moved, around.moves, placed,
            candidate.scale * candidate.rotation, target.center, metrics, forces, self.curvature, self.gradient,
        )  # fmt: skip

    def whole(self) -> Float[np.ndarray, "N N"]:
        """Return the whole curvature."""
        return self.curvature + np.tril(self.curvature, -1).T


def _add_surface(
    system: _System,
    target: Target,
    candidate: Candidate,
    effort: Effort,
    around: _Around,
    matches: _Matches,
    made: SparseRows,
) -> None:
    count, n_query = len(matches.placed), len(matches.query_rows)
    width = max(_LEAST_WIDTH, 1.5 * matches.median) if effort.width is None else effort.width
    metrics, forces = np.zeros((count, 3, 3)), np.zeros((count, 3))
    system_kernels.add_pairs(
        np.arange(count), matches.offsets, matches.normals, _EXACT_SPACING, width, 1.0 / count, metrics, forces
    )
    system_kernels.add_pairs(
        matches.query_rows, matches.query_offsets, matches.query_normals, 1.5 * target.spacing(n_query), width,
        1.0 / n_query, metrics, forces,
    )  # fmt: skip
    system.add(candidate, target, around, made, matches.placed, metrics, forces)


def _add_outline(
    system: _System, target: Target, candidate: Candidate, effort: Effort, around: _Around, trace: Trace
) -> None:
    pulls = target.outline.pulls(trace, effort.outline, effort.outline_weight, effort.outline_width)
    if pulls is not None:
        made = candidate.model.outline.combined(pulls.faces, pulls.weights, candidate.model.outline_triangles)
        placed = candidate.placed(made.points(around.control))
        system.add(candidate, target, around, made, placed, pulls.metrics, pulls.forces)


def _bounded_step(
    candidate: Candidate,
    effort: Effort,
    curvature: Float[np.ndarray, "N N"],
    gradient: Float[np.ndarray, " N"],
    around: _Around,
    free: Bool[np.ndarray, " N"],
) -> Float[np.ndarray, " N"]:
    """Solve for a damped step that stays in the ranges: what would leave its range is held at its end."""
    columns, lowest, highest = around.columns, around.lowest, around.highest
    count = len(columns)
    widths = candidate.model.widths[columns]
    matrix, gradient = curvature.copy(), gradient.copy()
    middle = (candidate.values[columns] - candidate.model.compiled.minimum[columns]) / widths - 0.5
    diagonal = np.arange(count + 7)
    matrix[diagonal, diagonal] += effort.damping * np.maximum(np.diag(curvature), 1e-6)
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
