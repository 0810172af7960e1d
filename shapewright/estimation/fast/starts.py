"""Where a search begins: random instances of every model in every likely orientation.

No bank is needed: a few dozen instances, scored on few points by brute force, and closest points on the best.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import rotations_24
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import COARSE, FittedModel
from shapewright.estimation.fast.pose_kernels import align_by_closest_points, score_rotations
from shapewright.estimation.fast.target import Target, principal_axes
from shapewright.estimation.sampling_kernels import place_samples, sample_surface

POINTS = 112
"""Samples of the query and of an instance while poses are scored."""
ROUNDS = 12
"""Rounds of closest points."""
_TURNS: Final = rotations_24()
_TURNS_KEPT = 3
"""Orientations of an instance that go on to closest points."""
OF_ONE_TURN: Final = 4
_OF_ONE_KIND: Final = 2
_ONE_TURN_TRACE: Final = 1.0 + 2.0 * float(np.cos(np.radians(40.0)))
"""Trace of the rotation between two orientations that are taken for one."""


@dataclass(frozen=True, eq=False)
class _Scored:
    """An instance in one orientation: samples in model space, their mean and radius, and how near they come."""

    model: FittedModel
    values: Float[np.ndarray, " P"]
    rotation: Float[np.ndarray, "3 3"]
    points: Float[np.ndarray, "N 3"]
    center: Float[np.ndarray, " 3"]
    radius: float
    score: float


def find_starts(
    target: Target,
    model: FittedModel,
    values: Float[np.ndarray, "B P"],
    kept: int,
    *,
    known_rotations: Float[np.ndarray, "R 3 3"] | None = None,
    known_scale: float | None = None,
    keeps_rotation: bool = False,
) -> list[Candidate]:
    """Find the poses in which instances of one model come nearest to the query.

    Args:
        target: the query.
        model: what to begin with.
        values: settled rows, an instance each.
        kept: candidates to return; three times as many are aligned by closest points.
        known_rotations: the only rotations from model to query space to try, if something is known of them.
        known_scale: from model to query space.
        keeps_rotation: whether the known rotations are exact.

    Returns:
        Candidates with their ``misfit``, the best first.
    """
    scored = [
        one
        for row, points in zip(values, _surfaces(model, values), strict=True)
        for one in _score(target, model, row, points, known_rotations, known_scale)
    ]
    scored.sort(key=lambda one: one.score)
    candidates = [_aligned(target, one, known_scale, keeps_rotation) for one in scored[: 3 * kept]]
    candidates.sort(key=lambda one: one.misfit)
    return candidates[:kept]


def spread(
    candidates: Sequence[Candidate], kept: int, of_each: int, *, of_one_turn: int = OF_ONE_TURN
) -> list[Candidate]:
    """Choose the best of all and the best few of each model, no more than a few of one model in one orientation.

    Args:
        candidates: the best first.
        kept: how many to choose of all.
        of_each: how many to choose of each model at least.
        of_one_turn: how many to choose of one model in one orientation at most; of those with the same options, two.
    """
    chosen: list[Candidate] = []
    counts: dict[int, int] = {}
    for one in candidates:
        count = counts.get(id(one.model), 0)
        alike = [other for other in chosen if _alike(one, other)]
        same = sum(bool((one.values == other.values)[one.model.is_option].all()) for other in alike)
        if (len(chosen) < kept or count < of_each) and len(alike) < of_one_turn and same < _OF_ONE_KIND:
            chosen.append(one)
            counts[id(one.model)] = count + 1
    return chosen


def _alike(first: Candidate, second: Candidate) -> bool:
    """Tell whether two candidates are of one model in nearly one orientation."""
    return first.model is second.model and float(np.sum(first.rotation * second.rotation)) > _ONE_TURN_TRACE


def _surfaces(model: FittedModel, values: Float[np.ndarray, "B P"]) -> Float[np.ndarray, "B V 3"]:
    return model.compiled.surface_points(values, COARSE)


def _score(
    target: Target,
    model: FittedModel,
    values: Float[np.ndarray, " P"],
    surface: Float[np.ndarray, "V 3"],
    known_rotations: Float[np.ndarray, "R 3 3"] | None,
    known_scale: float | None,
) -> list[_Scored]:
    triangles = model.triangles[COARSE]
    chosen, weights, normals = sample_surface(surface, triangles, POINTS, 0.5)
    if len(chosen) == 0:
        return []
    points = np.empty((POINTS, 3))
    place_samples(surface, triangles, chosen, weights, points)
    center = points.mean(axis=0)
    centered = points - center
    radius = float(np.sqrt((centered**2).sum(axis=1).mean()))
    if not radius > 0:
        return []
    rotations = known_rotations
    if rotations is None:
        frames = (principal_axes(centered), principal_axes(normals), np.eye(3))
        pairs = zip(target.frames, frames, strict=True)
        rotations = np.concatenate([to.T @ _TURNS @ own for to, own in pairs])
    size = target.radius if known_scale is None else known_scale * radius
    scores = np.empty(len(rotations), dtype=np.float32)
    score_rotations(
        np.ascontiguousarray(((target.points[:POINTS] - target.center) / target.radius).T, dtype=np.float32),
        np.ascontiguousarray(centered * (size / (radius * target.radius)), dtype=np.float32),
        np.ascontiguousarray(rotations, dtype=np.float32),
        scores,
    )
    best = np.argsort(scores, kind="stable")[:_TURNS_KEPT]
    return [_Scored(model, values, rotations[i], points, center, radius, float(scores[i])) for i in best]


def _aligned(target: Target, start: _Scored, known_scale: float | None, keeps_rotation: bool) -> Candidate:
    scale = target.radius / start.radius if known_scale is None else known_scale
    rotation, translation, found_scale, misfit = align_by_closest_points(
        target.points[:POINTS],
        start.points,
        np.ascontiguousarray(start.rotation),
        target.center - scale * (start.rotation @ start.center),
        scale,
        ROUNDS,
        known_scale is not None,
        keeps_rotation,
    )
    candidate = Candidate(start.model, start.values, rotation, translation, found_scale)
    return replace(candidate, misfit=float(misfit))
