"""Where an object is seen from: rotations that are rotations, and repeat."""

import numpy as np
import pytest

from shapewright.rendering.views import random_views, spread_views


@pytest.mark.parametrize("draw", [random_views, spread_views])
@pytest.mark.parametrize("count", [1, 3, 10])
def test_any_number_of_views_are_rotations_that_repeat(draw, count: int) -> None:
    rotations, scales = draw(np.random.default_rng(4), count, scale_range=(0.8, 2.0))
    np.testing.assert_allclose(rotations @ rotations.swapaxes(1, 2), np.tile(np.eye(3), (count, 1, 1)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(rotations), 1.0)
    assert scales.shape == (count,)
    assert ((scales >= 0.8) & (scales <= 2.0)).all()
    again, _ = draw(np.random.default_rng(4), count, scale_range=(0.8, 2.0))
    np.testing.assert_array_equal(again, rotations)


def test_spread_views_look_from_directions_far_from_each_other() -> None:
    rotations, _ = spread_views(np.random.default_rng(0), 10)
    directions = rotations[:, 2]  # the object's direction that points at the camera
    cosines = directions @ directions.T - 2 * np.eye(10)
    assert np.degrees(np.arccos(cosines.max())) > 30
