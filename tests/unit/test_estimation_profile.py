"""Profiles of single parameters, against fits whose residuals are known in closed form."""

import numpy as np
import pytest

from shapewright.estimation.determination.information import N_POSE, Information
from shapewright.estimation.determination.profile import find_suspects, profile
from shapewright.estimation.determination.statuses import CHANGE, LEAST_EFFECT

RANGES = np.array([2.0, 1.0])
RESIDUAL = 0.01


def plane_information(effects=(0.5, 0.2)):
    """Two parameters that move different halves of the points, by ``effects`` a range, root mean square."""
    jacobian = np.zeros((200, 2 + N_POSE))
    jacobian[:100, 0] = np.sqrt(2) * effects[0] / RANGES[0]
    jacobian[100:, 1] = np.sqrt(2) * effects[1] / RANGES[1]
    return Information(jacobian, RANGES)


def test_a_quadratic_fit_is_as_promised():
    information = plane_information()

    def refit(column, x):
        return float(np.sqrt(RESIDUAL**2 + (0.5 * (x - 1.3) / 2.0) ** 2))

    found = profile(0, 1.3, (0.5, 2.5), information, RESIDUAL, refit)
    assert found.values[found.fitted] == 1.3
    assert (found.values[0], found.values[-1]) == (0.5, 2.5)
    assert found.residuals == pytest.approx(found.predicted, rel=1e-4)
    assert found.is_quadratic
    assert found.better is None
    low, high = found.interval(0.05)
    assert (low, high) == pytest.approx((1.3 - 0.2, 1.3 + 0.2), abs=1e-3)
    assert found.interval(10.0) == (0.5, 2.5)


def test_a_valley_on_one_side_is_not_quadratic_and_widens_the_interval_there():
    information = plane_information()

    def refit(column, x):
        return RESIDUAL if x < 1.3 else float(np.sqrt(RESIDUAL**2 + (0.5 * (x - 1.3) / 2.0) ** 2))

    found = profile(0, 1.3, (0.5, 2.5), information, RESIDUAL, refit)
    assert not found.is_quadratic
    assert found.interval(0.05) == pytest.approx((0.5, 1.5), abs=1e-3)


def test_a_better_fit_elsewhere_is_found():
    found = profile(
        0, 1.3, (0.5, 2.5), plane_information(), RESIDUAL, lambda column, x: 0.001 if abs(x - 2.5) < 0.1 else 0.05
    )
    assert found.better == 2.5


def test_suspects_are_borderline_first_then_flat_and_not_at_an_end():
    limit = LEAST_EFFECT / CHANGE
    lowest, highest = np.zeros(2), RANGES
    inside = np.array([1.0, 0.5])
    assert find_suspects(plane_information((50 * limit, 2 * limit)), inside, lowest, highest).tolist() == [1]
    assert find_suspects(plane_information((0.0, 0.7 * limit)), inside, lowest, highest).tolist() == [1, 0]
    assert find_suspects(plane_information((0.0, 50 * limit)), lowest, lowest, highest).tolist() == []
