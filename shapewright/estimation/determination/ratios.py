"""Ratios of lengths, which the query determines even where the scale of the pose trades against all lengths."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from jaxtyping import Bool, Float

from shapewright.estimation.determination.information import Information
from shapewright.estimation.determination.statuses import is_determined
from shapewright.estimation.generator import ParameterInfo
from shapewright.estimation.result import Ratio

WIDEST_RATIO: Final = 0.05
"""Half width of a ratio's interval, as a share of the ratio, above which it is not offered."""


def find_ratios(
    information: Information,
    parameters: Sequence[ParameterInfo],
    values: Float[np.ndarray, " A"],
    lengths: Bool[np.ndarray, " A"],
    deviation: float,
) -> tuple[Ratio, ...]:
    """Return the determined ratios of each length to one of them, whose ratios are the surest.

    All other determined ratios follow from these. The reference is the length with the most determined ratios, and
    among those the one whose ratios vary least.

    Args:
        information: about the parameters in this order.
        parameters: names, labels, base values.
        values: x.
        lengths: which of them are lengths.
        deviation: what the square root of a variance is multiplied by to give half of an interval.
    """
    columns = np.flatnonzero(lengths)
    if len(columns) < 2:
        return ()
    relative = information.ranges[columns] / values[columns]  # change of the logarithm a range
    covariance = information.covariance[np.ix_(columns, columns)] * np.outer(relative, relative)
    variances = np.diagonal(covariance)
    of_ratio = np.maximum(variances[:, None] + variances[None, :] - 2.0 * covariance, 1e-300)
    range_of_ratio = (relative[:, None] + relative[None, :]) / 2.0
    determined = is_determined((range_of_ratio / np.sqrt(of_ratio)).reshape(-1), deviation).reshape(of_ratio.shape)
    determined &= deviation * np.sqrt(of_ratio) <= WIDEST_RATIO
    measured = np.array([parameters[column].base_value is not None for column in columns.tolist()])
    determined &= measured[:, None] == measured[None, :]  # a length and a factor have no ratio
    np.fill_diagonal(determined, val=False)
    spread = np.array(
        [np.median(row[known]) if known.any() else np.inf for row, known in zip(of_ratio, determined, strict=True)]
    )
    reference = int(np.lexsort((spread, -determined.sum(axis=1)))[0])
    denominator = parameters[columns[reference]]
    below = _displayed(denominator, values[columns[reference]])
    ratios = []
    for i in np.flatnonzero(determined[reference]).tolist():
        numerator = parameters[columns[i]]
        value = _displayed(numerator, values[columns[i]]) / below
        factor = float(np.exp(min(deviation * np.sqrt(of_ratio[i, reference]), 50.0)))
        ratios.append(
            Ratio(
                numerator=numerator.name,
                denominator=denominator.name,
                label=f"{numerator.label} : {denominator.label}",
                value=value,
                interval=(value / factor, value * factor),
                status="determined",
            )
        )
    return tuple(ratios)


def _displayed(parameter: ParameterInfo, value: float) -> float:
    return float(value if parameter.base_value is None else value * parameter.base_value)
