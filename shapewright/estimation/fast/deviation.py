"""How far the surface of a fit is from the query: what is noise, and what the model cannot follow."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.spatial import cKDTree

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import FINE
from shapewright.estimation.fast.least_squares import ACROSS, Effort, closest
from shapewright.estimation.fast.matching_kernels import match_to_triangles
from shapewright.estimation.fast.target import SAMPLES, Target
from shapewright.estimation.sampling_kernels import place_samples, sample_surface

POINTS: Final = 2000
_FAR: Final = 0.3
_AMONG: Final = 6
_DENSER: Final = 4
"""Samples of a fit among which those of the query are matched, for each one of the query."""
NEAR: Final = 0.05
"""Distances beyond this count no more where two fits are compared, in half extents."""
_NEIGHBORS: Final = 16
"""Points over which residuals are averaged before their size is taken."""


@dataclass(frozen=True, eq=False)
class Deviation:
    """Residuals of even samples of a fit, in half extents.

    Attributes:
        along: (N,) signed distance to the query along the normal of each sample.
        mean: mean size of these.
        systematic: mean size of the local mean of these. Noise of single points averages out in it as it does in a
            fit; what remains is what the fit does not follow.
    """

    along: Float[np.ndarray, " N"]
    mean: float
    systematic: float


def measure_deviation(target: Target, placed: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"]) -> Deviation:
    """Measure samples of an instance, placed in the space of the query, with their normals there."""
    along = ((placed - closest(target, placed, normals, Effort.neighbors)[0]) * normals).sum(axis=1)
    near = np.asarray(cKDTree(placed).query(placed, k=[*range(1, min(_NEIGHBORS, len(placed)) + 1)])[1])
    return Deviation(along, _mean_size(along), _mean_size(along[near].mean(axis=1)))


def mutual_deviation(target: Target, candidate: Candidate, count: int = POINTS) -> tuple[float, float] | None:
    """Measure how far samples of query and fit are from each other's triangles.

    Returns:
        The mean distance from the query to the fit, and from the fit to the query, in half extents; no single one
        counts as more than :data:`NEAR`. ``None`` if the instance has no area.
    """
    model = candidate.model
    surface, triangles = model.surfaces[FINE], model.triangles[FINE]
    vertices = candidate.placed(surface.points(model.control_points(candidate.values)))
    faces, weights, normals = sample_surface(vertices, triangles, _DENSER * count, 0.5)
    if len(faces) == 0:
        return None
    placed = np.empty((len(faces), 3))
    place_samples(vertices, triangles, faces, weights, placed)
    some, some_normals = np.ascontiguousarray(placed[::_DENSER]), np.ascontiguousarray(normals[::_DENSER])
    places, place_normals = closest(target, some, some_normals, _AMONG)
    back = _apart(some - places, place_normals, target.spacing(SAMPLES))
    points = target.points[:count]
    rows = cKDTree(placed, balanced_tree=False, compact_nodes=False).query(points, k=[*range(1, _AMONG + 1)])[1]
    places, place_normals = np.empty_like(points), np.empty_like(points)
    spacing = target.spacing(len(placed))
    match_to_triangles(
        points, target.normals[:count], placed, normals, faces, vertices, triangles, rows, spacing, ACROSS, places,
        place_normals,
    )  # fmt: skip
    return _apart(points - places, place_normals, spacing), back


def _apart(offsets: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"], spacing: float) -> float:
    """Return the mean distance of pairs: along the normal, and along the surface beyond the spacing of the samples."""
    out = np.abs((offsets * normals).sum(axis=1))
    along = np.sqrt(np.maximum((offsets**2).sum(axis=1) - out**2, 0.0))
    return float(np.minimum(out + np.maximum(along - 1.5 * spacing, 0.0), NEAR).mean())


def _mean_size(residuals: Float[np.ndarray, " N"]) -> float:
    return float(np.minimum(np.abs(residuals), _FAR).mean())


def candidate_deviation(target: Target, candidate: Candidate) -> Deviation | None:
    """Measure a candidate; ``None`` if its instance has no area."""
    control = candidate.model.control_points(candidate.values)
    samples = candidate.model.samples(control, POINTS, FINE, 0.5)
    if samples is None:
        return None
    rows, normals = samples
    placed = candidate.placed(rows.points(control))
    return measure_deviation(target, placed, np.ascontiguousarray(normals @ candidate.rotation.T))
