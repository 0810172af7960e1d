"""Views: rotations that are spread evenly, and still random each."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from shapewright.rendering import even_views
from shapewright.rendering.views import random_views, spread_views, three_quarter_view, views_about


def smallest_angle(rotations: np.ndarray) -> float:
    """Between any two directions towards the camera, in radians."""
    directions = rotations[:, 2]
    cosines = directions @ directions.T - 2 * np.eye(len(directions))
    return float(np.arccos(cosines.max()))


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 60))
@settings(deadline=None)
def test_spread_views_are_proper_rotations_and_evenly_spread(seed: int, count: int) -> None:
    rotations, scales = spread_views(np.random.default_rng(seed), count, scale_range=(0.7, 0.9))
    assert rotations.shape == (count, 3, 3)
    assert np.allclose(rotations @ rotations.transpose(0, 2, 1), np.eye(3), atol=1e-9)
    assert np.allclose(np.linalg.det(rotations), 1.0)
    assert scales.shape == (count,)
    assert np.all((scales >= 0.7) & (scales <= 0.9))
    if count > 1:
        # caps of half this angle about all directions cover two fifths of the sphere and do not overlap
        assert smallest_angle(rotations) > 2.5 / np.sqrt(count)
        assert np.linalg.norm(rotations[:, 2].mean(axis=0)) < 1.0 / count + 0.05


def test_each_spread_view_alone_is_uniformly_random() -> None:
    rng = np.random.default_rng(0)
    rotations = np.stack([spread_views(rng, 10)[0] for _ in range(400)])
    for number in (0, 4, 9):
        one = rotations[:, number]
        assert np.abs(one.mean(axis=0)).max() < 0.13, "every entry has mean 0"
        assert np.allclose((one**2).mean(axis=0), 1 / 3, atol=0.08)


def test_spread_views_repeat_with_the_generator() -> None:
    first, again, other = (spread_views(np.random.default_rng(seed), 5) for seed in (1, 1, 2))
    assert np.array_equal(first[0], again[0])
    assert np.array_equal(first[1], again[1])
    assert not np.allclose(first[0], other[0])


@pytest.mark.parametrize("count", [0, 1, 7])
def test_even_views_are_the_same_each_time(count: int) -> None:
    assert even_views(count).shape == (count, 3, 3)
    assert np.array_equal(even_views(count), even_views(count))


@pytest.mark.parametrize("count", [0, 1, 7])
def test_random_views_are_the_rotations_that_scipy_draws(count: int) -> None:
    rotations, _ = random_views(np.random.default_rng(5), count)
    drawn = Rotation.random(count, rng=np.random.default_rng(5)).as_matrix().reshape(count, 3, 3)
    assert np.allclose(rotations, drawn, atol=1e-12)


def test_the_three_quarter_view_turns_the_object_then_tips_it_towards_the_camera() -> None:
    turned = Rotation.from_euler("yx", [-0.3, 0.2]).as_matrix()
    assert np.allclose(three_quarter_view("y", azimuth_rad=0.3, elevation_rad=0.2), turned)
    upright = Rotation.from_euler("x", -np.pi / 2).as_matrix()
    assert np.allclose(three_quarter_view("z", azimuth_rad=0.3, elevation_rad=0.2), turned @ upright)


@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (0.6, 0.0, -0.8)])
def test_views_about_a_direction_look_from_near_it(direction: tuple[float, float, float]) -> None:
    rotations, scales = views_about(
        np.random.default_rng(0), np.array(direction), 2000, farthest_rad=0.5, scale_range=(0.7, 0.9)
    )
    assert np.allclose(rotations @ rotations.transpose(0, 2, 1), np.eye(3))
    assert np.allclose(np.linalg.det(rotations), 1.0)
    cosines = rotations[:, 2] @ direction  # the third row is the direction to the viewer
    assert cosines.min() >= np.cos(0.5) - 1e-9
    assert np.isclose(cosines.mean(), 0.5 * (1.0 + np.cos(0.5)), atol=0.003), "evenly over the cap"
    turned = rotations @ np.array(direction)  # where that direction points in the picture
    assert np.abs(turned[:, :2].mean(axis=0)).max() < 0.02, "to all sides alike"
    assert 0.7 <= scales.min() < 0.71
    assert 0.89 < scales.max() <= 0.9


def test_no_views_about_a_direction_are_empty_arrays() -> None:
    rotations, scales = views_about(np.random.default_rng(0), np.array([0.0, 0.0, 1.0]), 0, farthest_rad=0.5)
    assert rotations.shape == (0, 3, 3)
    assert scales.shape == (0,)
