"""Sums and differences that are determined although their members are not."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.estimation.determination.information import Information
from shapewright.estimation.determination.statuses import is_determined
from shapewright.estimation.generator import ParameterInfo
from shapewright.estimation.result import Combination

MOST_MEMBERS: Final = 3
"""A sum of more values says nothing to people."""
LEAST_WEIGHT: Final = 0.2
"""Of the largest weight; members with less are left out if the rest is still determined."""


def find_combinations(
    information: Information,
    parameters: Sequence[ParameterInfo],
    undetermined: Bool[np.ndarray, " A"],
    deviation: float,
) -> tuple[Combination, ...]:
    """Return sums of a few undetermined parameters that are determined, if need be up to the scale.

    Members have one unit: a length and an angle have no sum. The determined directions among the undetermined
    parameters of a unit are those with large eigenvalues of their information, all else refitted; a reduced basis of
    them has few members each.

    Args:
        information: about the parameters in this order.
        parameters: names, labels, units, base values.
        undetermined: those that not even a known scale determines.
        deviation: what the square root of a variance is multiplied by to give half of an interval.
    """
    known = information.with_known_scale()
    groups: dict[tuple[str | None, bool], list[int]] = {}
    for column in np.flatnonzero(undetermined).tolist():
        groups.setdefault((parameters[column].unit, parameters[column].base_value is None), []).append(column)
    found = []
    for members in groups.values():
        if len(members) > 1:
            found += _of_group(known, parameters, np.array(members), deviation)
    return tuple(found)


def _of_group(
    known: Information, parameters: Sequence[ParameterInfo], columns: Int[np.ndarray, " M"], deviation: float
) -> list[Combination]:
    covariance = known.covariance[np.ix_(columns, columns)]
    strengths, directions = np.linalg.eigh(known.schur_complement(columns))
    basis = directions[:, is_determined(np.sqrt(np.maximum(strengths, 0.0)), deviation)].T
    found = []
    for row in _reduced(basis):
        weights = np.where(np.abs(row) >= LEAST_WEIGHT * np.abs(row).max(), row, 0.0)
        members = np.flatnonzero(weights)
        spread = float(np.sqrt(weights @ covariance @ weights))
        extent = float(np.abs(weights).sum())
        if 2 <= len(members) <= MOST_MEMBERS and is_determined(np.array([extent / spread]), deviation)[0]:
            share = min(2.0 * deviation * spread / extent, 1.0)
            found.append(_named(weights[members], columns[members], known.ranges, parameters, share))
    return found


def _reduced(basis: Float[np.ndarray, "K M"]) -> Float[np.ndarray, "K M"]:
    """Return a basis of the same directions, each 1 in a column of its own, where the others are 0."""
    rows = basis.copy()
    for i in range(len(rows)):
        left = np.abs(rows[i:])
        below, column = np.unravel_index(int(left.argmax()), left.shape)
        rows[[i, i + int(below)]] = rows[[i + int(below), i]]
        rows[i] /= rows[i, column]
        others = np.arange(len(rows)) != i
        rows[others] -= np.outer(rows[others, column], rows[i])
    return rows


def _named(
    weights: Float[np.ndarray, " K"],
    columns: Int[np.ndarray, " K"],
    ranges: Float[np.ndarray, " A"],
    parameters: Sequence[ParameterInfo],
    interval_share: float,
) -> Combination:
    """Return the combination in displayed values, the largest weight 1; ``weights`` are of shares of ranges."""
    displayed = {}
    for weight, column in zip(weights, columns, strict=True):
        base = parameters[column].base_value
        displayed[int(column)] = float(weight / (ranges[column] * (base or 1.0)))
    largest = max(displayed.values(), key=abs)
    scaled = {column: weight / largest for column, weight in displayed.items()}
    ordered = sorted(scaled, key=lambda column: -abs(scaled[column]))
    label = parameters[ordered[0]].label
    for column in ordered[1:]:
        size = abs(scaled[column])
        times = "" if abs(size - 1.0) < 0.05 else f"{size:.2g} × "
        label += f" {'+' if scaled[column] > 0 else '−'} {times}{parameters[column].label}"
    return Combination(label, {parameters[column].name: scaled[column] for column in ordered}, interval_share)
