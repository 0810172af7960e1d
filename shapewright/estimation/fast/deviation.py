"""How far the surface of a fit is from the query: what is noise, and what the model cannot follow."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.spatial import cKDTree

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import FINE
from shapewright.estimation.fast.least_squares import closest_places
from shapewright.estimation.fast.target import Target

POINTS: Final = 2000
_FAR: Final = 0.3
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
    along = ((placed - closest_places(target, placed, normals)) * normals).sum(axis=1)
    near = np.asarray(cKDTree(placed).query(placed, k=[*range(1, min(_NEIGHBORS, len(placed)) + 1)])[1])
    return Deviation(along, _mean_size(along), _mean_size(along[near].mean(axis=1)))


def _mean_size(residuals: Float[np.ndarray, " N"]) -> float:
    return float(np.minimum(np.abs(residuals), _FAR).mean())


def candidate_deviation(target: Target, candidate: Candidate) -> Deviation | None:
    """Measure a candidate; ``None`` if its instance has no area."""
    control = candidate.model.control_points(candidate.values)
    samples = candidate.model.samples(control, POINTS, FINE, 0.5)
    if samples is None:
        return None
    matrix, normals = samples
    placed = np.ascontiguousarray(candidate.placed(matrix @ control))
    return measure_deviation(target, placed, np.ascontiguousarray(normals @ candidate.rotation.T))
