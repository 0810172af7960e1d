"""What a fit determines: how its surface moves with every parameter and the pose, and how far it is from the query."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.estimation.determination.determine import Determination, continuous_columns, determine
from shapewright.estimation.determination.factors import IntervalFactors
from shapewright.estimation.determination.information import pose_columns
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.deviation import POINTS, measure_deviation
from shapewright.estimation.fast.fitted_model import FINE
from shapewright.estimation.fast.target import Target

_DIFFERENCE: Final = 1e-4


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """How the surface of a fit moves, and how far it is from the query.

    Attributes:
        jacobian: (N, A + 7) movement along the normals by x of each active measure, then by the pose.
        gradient: (A,) of half the mean squared residual by x.
        mean_residual: the systematic residual, in half extents; see :class:`Deviation`.
    """

    jacobian: Float[np.ndarray, "N C"]
    gradient: Float[np.ndarray, " A"]
    mean_residual: float


def measure_sensitivity(target: Target, candidate: Candidate) -> Sensitivity | None:
    """Measure a fit; ``None`` if its instance has no area."""
    model = candidate.model
    values, compiled = candidate.values, model.compiled
    active = compiled.space.active(values[None])[0]
    columns = np.array(continuous_columns(compiled.model.parameters, active), dtype=np.int64)
    highest = compiled.space.ranges(values[None])[1][0]
    widths = model.widths[columns]
    differences = np.where(values[columns] + _DIFFERENCE * widths <= highest[columns], 1.0, -1.0) * _DIFFERENCE * widths
    rows = np.repeat(values[None], len(columns) + 1, axis=0)
    rows[np.arange(1, len(rows)), columns] += differences
    controls = compiled.control_points(rows)
    samples = model.samples(controls[0], POINTS, FINE, 0.5)
    if samples is None:
        return None
    made, normals = samples
    points = np.stack([made.points(control) for control in controls], axis=1)
    placed = candidate.placed(points[:, 0])
    turned = np.ascontiguousarray(normals @ candidate.rotation.T)
    own = (turned @ (candidate.scale * candidate.rotation))[:, None]  # normals in model space, scaled
    slopes = ((points[:, 1:] - points[:, :1]) * own).sum(axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.where(differences != 0, slopes / differences, 0.0)
    deviation = measure_deviation(target, placed, turned)
    return Sensitivity(
        np.column_stack([slopes, pose_columns(placed, turned)]),
        slopes.T @ deviation.along / POINTS,
        deviation.systematic,
    )


def determine_fit(
    target: Target, candidate: Candidate, *, scale_known: bool, factors: IntervalFactors
) -> Determination | None:
    """Judge every parameter of a fit; ``None`` if its instance has no area."""
    sensitivity = measure_sensitivity(target, candidate)
    if sensitivity is None:
        return None
    compiled = candidate.model.compiled
    values = candidate.values[None]
    lowest, highest = (bounds[0] for bounds in compiled.space.ranges(values))
    return determine(
        compiled.model.parameters,
        candidate.values,
        lowest,
        highest,
        compiled.space.active(values)[0],
        sensitivity.jacobian,
        mean_residual=sensitivity.mean_residual,
        factor=factors.of(compiled.model.digest, compiled.model.name),
        scale_known=scale_known,
        gradient=sensitivity.gradient,
    )
