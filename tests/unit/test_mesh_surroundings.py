"""Laws of what counts as debris and as ground."""

import numpy as np
import pytest
import simple_shapes
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shipped_models import compiled_shipped

from models_store.library.shipped import list_shipped
from shapewright.classification.readings import plain_reading
from shapewright.distances.surface import uniform_points
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.surroundings import is_debris, is_ground

TURN_AND_SIZE = {"turn_seed": st.integers(0, 10**6), "size": st.sampled_from([1e-4, 1.0, 3e3])}


def bird() -> np.ndarray:
    """A body, a head and thin legs: nothing flat."""
    return np.concatenate(
        [
            ball(2500, 0.5, (0, 0, 0)),
            ball(700, 0.25, (0.6, 0.5, 0)),
            *(ball(150, 1.0, (0, 0, 0)) * (0.04, 0.4, 0.04) + (0, -0.8, z) for z in (-0.15, 0.15)),
        ]
    )


def ball(count: int, radius: float, center: tuple[float, float, float]) -> np.ndarray:
    """Points spread evenly over a sphere."""
    heights = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    angles_rad = np.pi * (3.0 - 5.0**0.5) * np.arange(count)
    rims = np.sqrt(1.0 - heights**2)
    return radius * np.stack([rims * np.cos(angles_rad), heights, rims * np.sin(angles_rad)], axis=1) + center


def sheet(side: float, height: float) -> TriangleMesh:
    """A horizontal square without thickness."""
    corners = 0.5 * side * np.array([[-1.0, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]])
    return TriangleMesh(corners + np.array([0.0, height, 0.0]), np.array([[0, 1, 2], [0, 2, 3]]))


def moved(points: np.ndarray, turn_seed: int, size: float) -> np.ndarray:
    return size * (points @ Rotation.random(rng=np.random.default_rng(turn_seed)).as_matrix().T + [3.0, -2.0, 5.0])


@given(**TURN_AND_SIZE)
@settings(max_examples=8)
def test_clumps_and_specks_beside_a_cloud_are_debris(turn_seed: int, size: float) -> None:
    clumps = np.concatenate(
        [ball(30, 0.03, (1.6, 0, 0)), ball(30, 0.05, (0, 1.5, 0.9)), [[-2.0, 0.1, 0.3], [0.2, -1.9, 0.4]]]
    )
    points = moved(np.concatenate([ball(3000, 1.0, (0, 0, 0)), clumps]), turn_seed, size)
    expected = np.arange(len(points)) >= 3000
    np.testing.assert_array_equal(is_debris(points, size * (4 * np.pi / 3000) ** 0.5), expected)


@given(**TURN_AND_SIZE)
@settings(max_examples=8)
def test_specks_are_debris_nearer_to_an_object_than_clumps(turn_seed: int, size: float) -> None:
    specks = 1.22 * np.array([[1.0, 0, 0], [0, 0.6, 0.8], [-0.8, 0, -0.6]])
    points = moved(np.concatenate([ball(20_000, 1.0, (0, 0, 0)), specks]), turn_seed, size)
    expected = np.arange(len(points)) >= 20_000
    np.testing.assert_array_equal(is_debris(points, size * (4 * np.pi / 20_000) ** 0.5), expected)


@pytest.mark.parametrize("shape", [simple_shapes.goblet(), simple_shapes.stool()])
def test_clumps_beside_a_mesh_are_debris(shape: TriangleMesh) -> None:
    clumps = [simple_shapes.box((0.05, 0.05, 0.05), (2.0 * x, 0.3, 0)) for x in (-1, 1)]
    reading = plain_reading(simple_shapes.joined([shape, *clumps]))
    found = is_debris(reading.points, reading.spacing)
    np.testing.assert_array_equal(found, np.abs(reading.points[:, 0]) > 1.9)
    assert found.any()


@pytest.mark.parametrize("share", [0.5, 0.2, 0.1])
def test_a_large_second_piece_is_no_debris(share: float) -> None:
    # The leg of a table that the scanner saw apart from the rest is part of the table.
    points = np.concatenate([ball(3000, 1.0, (0, 0, 0)), ball(int(3000 * share), share**0.5, (2.5, 0, 0))])
    assert not is_debris(points, 0.065).any()


def test_an_object_in_many_pieces_keeps_them() -> None:
    centers = np.random.default_rng(3).permutation(np.mgrid[0:4, 0:4, 0:4].reshape(3, -1).T.astype(float))
    points = np.concatenate([ball(40, 0.05, tuple(center)) for center in centers])
    assert not is_debris(points, 0.03).any()


@pytest.mark.parametrize("away", [1e3, 1e15, 1e21])
def test_one_point_far_away_does_not_hide_a_clump(away: float) -> None:
    # The grid must neither overflow nor be as coarse as all there is.
    points = np.concatenate([ball(3000, 1.0, (0, 0, 0)), ball(30, 0.05, (1.6, 0, 0)), [[-away, away, 0.0]]])
    np.testing.assert_array_equal(is_debris(points, 0.065), np.arange(len(points)) >= 3000)


def test_points_at_one_place_are_no_debris() -> None:
    assert not is_debris(np.ones((50, 3)), 0.0).any()


def test_no_shipped_model_has_debris() -> None:
    for name in list_shipped():
        compiled = compiled_shipped(name)
        reading = plain_reading(compiled.instance(compiled.base_values()))
        assert not is_debris(reading.points, reading.spacing).any(), name


@given(**TURN_AND_SIZE, side=st.floats(2.0, 4.0))
@settings(max_examples=10)
def test_a_sheet_below_an_object_is_ground(turn_seed: int, size: float, side: float) -> None:
    low = bird()[:, 1].min()
    ground = uniform_points(sheet(side, low), int(700 * side**2), rng=np.random.default_rng(1))
    points = np.concatenate([bird(), ground])
    found = is_ground(moved(points, turn_seed, size))
    assert found is not None
    assert found[len(bird()) :].all()
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    assert not found[: len(bird())][bird()[:, 1] > low + 0.02 * diagonal].any(), "only the soles may go with it"


@pytest.mark.parametrize("deviation", [0.0, 0.002])
def test_ground_may_be_a_little_rough(deviation: float) -> None:
    rng = np.random.default_rng(2)
    ground = uniform_points(sheet(3.0, -1.2), 6000, rng=rng) + deviation * rng.normal(size=(6000, 3))
    found = is_ground(np.concatenate([bird(), ground]))
    assert found is not None
    assert found[len(bird()) :].mean() > 0.99


@given(**TURN_AND_SIZE)
@settings(max_examples=8)
def test_round_objects_have_no_ground(turn_seed: int, size: float) -> None:
    for points in (ball(3000, 1.0, (0, 0, 0)), bird()):
        assert is_ground(moved(points, turn_seed, size)) is None


def test_a_plane_inside_or_narrower_than_the_object_is_no_ground() -> None:
    sphere = ball(3000, 1.0, (0, 0, 0))
    halved = uniform_points(sheet(3.0, 0.0), 6000, rng=np.random.default_rng(1))
    assert is_ground(np.concatenate([sphere, halved])) is None
    pedestal = uniform_points(sheet(0.8, -1.0), 2000, rng=np.random.default_rng(1))
    assert is_ground(np.concatenate([sphere, pedestal])) is None


def test_a_sheet_alone_and_a_single_place_have_no_ground() -> None:
    assert is_ground(uniform_points(sheet(1.0, 0.0), 2000, rng=np.random.default_rng(1))) is None
    assert is_ground(PointCloud(np.zeros((10, 3))).points) is None
