"""The value of a point cloud, and what it refuses."""

import numpy as np
import pytest

from shapewright.errors import MeshError
from shapewright.mesh import PointCloud


def test_points_are_kept_as_float64_and_bounded() -> None:
    cloud = PointCloud(np.asfortranarray([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, -3]], dtype=np.float32))
    assert cloud.points.dtype == np.float64
    assert cloud.points.flags.c_contiguous
    np.testing.assert_array_equal(cloud.bounds, [[0, 0, -3], [1, 2, 0]])


def test_points_that_already_fit_are_not_copied() -> None:
    points = np.zeros((4, 3))
    assert PointCloud(points).points is points


@pytest.mark.parametrize(
    ("points", "where", "message"),
    [
        (np.zeros((3, 3)), "points", "at least 4 points, got 3"),
        (np.array([[0, 0, 0], [0, 0, np.nan], [0, 0, 1], [1, 0, 0]]), "points[1]", "NaN"),
        (np.array([[0, 0, 0], [0, 0, 1], [0, 0, 1], [1, 0, -np.inf]]), "points[3]", "infinite"),
    ],
)
def test_what_is_no_cloud_is_refused_with_its_place(points: np.ndarray, where: str, message: str) -> None:
    with pytest.raises(MeshError, match=message) as caught:
        PointCloud(points)
    assert caught.value.where == where
