"""All that is known about the parameters of a fit, from one Jacobian."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Bool, Float

from shapewright.errors import EstimationError
from shapewright.estimation.determination.combinations import find_combinations
from shapewright.estimation.determination.information import N_POSE, Information
from shapewright.estimation.determination.lengths import find_lengths
from shapewright.estimation.determination.ratios import find_ratios
from shapewright.estimation.determination.statuses import judge
from shapewright.estimation.generator import ParameterInfo
from shapewright.estimation.result import Combination, ParameterStatus, Ratio

RESIDUAL_FLOOR: Final = 2e-4
"""Least mean residual, in half extents: a query that is cut from an instance is not fitted any better than its
tessellation allows, however small the residual is."""
_NO_RANGE: Final = 1e-9


@dataclass(frozen=True, eq=False)
class Determination:
    """What is known about each parameter, given the structure.

    Attributes:
        statuses: of each parameter; ``None`` for an active option, which alternatives are about.
        intervals: of x, within the range; ``None`` for options and what is inactive.
        half_widths: of the intervals before they were clipped to the range; NaN where there is none.
        ratios: of lengths.
        combinations: of parameters that are not determined alone.
        information: about the active continuous parameters with a range.
        columns: which of all parameters these are.
    """

    statuses: tuple[ParameterStatus | None, ...]
    intervals: tuple[tuple[float, float] | None, ...]
    half_widths: Float[np.ndarray, " P"]
    ratios: tuple[Ratio, ...]
    combinations: tuple[Combination, ...]
    information: Information
    columns: tuple[int, ...]


def continuous_columns(parameters: Sequence[ParameterInfo], active: Bool[np.ndarray, " P"]) -> tuple[int, ...]:
    """Return the columns of the active parameters that are no options, which a Jacobian is about."""
    return tuple(i for i, parameter in enumerate(parameters) if active[i] and not parameter.named_options())


def determine(
    parameters: Sequence[ParameterInfo],
    values: Float[np.ndarray, " P"],
    lowest: Float[np.ndarray, " P"],
    highest: Float[np.ndarray, " P"],
    active: Bool[np.ndarray, " P"],
    jacobian: Float[np.ndarray, "N C"],
    *,
    mean_residual: float,
    factor: float,
    scale_known: bool,
    gradient: Float[np.ndarray, " A"] | None = None,
) -> Determination:
    """Judge every parameter of a fit.

    Args:
        parameters: of the model.
        values: settled x.
        lowest: smallest x, given the other values.
        highest: largest x, given the other values.
        active: which parameters mean something.
        jacobian: movement of points of the surface along their normals, in half extents, by each parameter of
            :func:`continuous_columns` and then by the pose (:func:`pose_columns`). Points stand for equal areas.
        mean_residual: mean absolute residual, in half extents.
        factor: of the model, see :class:`IntervalFactors`.
        scale_known: whether the scale of the pose is known.
        gradient: of half the mean squared residual by x of the same parameters.

    Raises:
        EstimationError: arrays that do not belong together, NaN, or a factor that is not positive.
    """
    if not factor > 0:
        raise EstimationError(f"expected a positive factor, got {factor}", where="factor")
    continuous = continuous_columns(parameters, active)
    if jacobian.shape[1] != len(continuous) + N_POSE:
        expected = f"{len(continuous)} + {N_POSE} columns"
        raise EstimationError(f"expected {expected}, got {jacobian.shape[1]}", where="jacobian")
    ranged = np.array([highest[c] - lowest[c] > _NO_RANGE for c in continuous], dtype=bool)
    columns = np.array(continuous, dtype=np.int64)[ranged]
    kept = np.concatenate([np.flatnonzero(ranged), len(continuous) + np.arange(N_POSE)])
    information = Information(jacobian[:, kept], highest[columns] - lowest[columns], scale_known)
    deviation = factor * max(mean_residual, RESIDUAL_FLOOR)
    own_gradient = None if gradient is None else gradient[ranged]
    judged = judge(information, values[columns], lowest[columns], highest[columns], deviation, own_gradient)
    half_widths = np.full(len(parameters), np.nan)
    half_widths[columns] = deviation * np.sqrt(np.diagonal(information.covariance)) * information.ranges
    statuses: list[ParameterStatus | None] = [None if is_active else "inactive" for is_active in active]
    intervals: list[tuple[float, float] | None] = [None] * len(parameters)
    for column in continuous:  # those without a range are at both of its ends
        statuses[column], intervals[column] = "at_range_end", (float(values[column]),) * 2
    for column, status in zip(columns.tolist(), judged, strict=True):
        half = half_widths[column]
        statuses[column] = status
        intervals[column] = (
            float(max(values[column] - half, lowest[column])),
            float(min(values[column] + half, highest[column])),
        )
    chosen = [parameters[column] for column in columns]
    lengths = find_lengths(chosen, values[columns], information)
    undetermined = np.array([status == "not_determined" for status in judged], dtype=bool)
    return Determination(
        statuses=tuple(statuses),
        intervals=tuple(intervals),
        half_widths=half_widths,
        ratios=find_ratios(information, chosen, values[columns], lengths, deviation),
        combinations=find_combinations(information, chosen, undetermined, deviation),
        information=information,
        columns=tuple(columns.tolist()),
    )
