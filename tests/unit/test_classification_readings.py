"""Laws of readings: what is drawn and compared of a query that may be a scan."""

import numpy as np
import pytest
import simple_shapes
from scipy.spatial import cKDTree

from shapewright.classification.readings import (
    LEAST_POINTS,
    MOST_POINTS,
    Reading,
    plain_reading,
    readings,
)
from shapewright.distances.surface import uniform_points
from shapewright.errors import MeshError
from shapewright.evaluation.corruptions.ground import add_ground
from shapewright.evaluation.corruptions.noise import add_noise
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.rendering.splats import RADIUS

PROFILE = np.array([(0.01, -1.0), (0.5, -0.8), (0.3, -0.2), (0.45, 0.3), (0.2, 0.8), (0.01, 1.0)])


@pytest.fixture(scope="module")
def bumpy() -> TriangleMesh:
    """A closed shape without any flat side: :data:`PROFILE` turned about the y axis."""
    return simple_shapes.lathe(PROFILE, 96)


def distances_to_bumpy(points: np.ndarray) -> np.ndarray:
    flat = np.stack([np.hypot(points[:, 0], points[:, 2]), points[:, 1]], axis=1)[:, None]
    starts, along = PROFILE[:-1], np.diff(PROFILE, axis=0)
    shares = np.clip(((flat - starts) * along).sum(axis=2) / (along**2).sum(axis=1), 0.0, 1.0)
    return np.linalg.norm(flat - starts - shares[..., None] * along, axis=2).min(axis=1)


def scanned(mesh: TriangleMesh, count: int, seed: int = 0) -> PointCloud:
    return PointCloud(uniform_points(mesh, count, rng=np.random.default_rng(seed)))


def same(one: Reading, other: Reading) -> bool:
    return bool(np.array_equal(one.points, other.points) and one.spacing == other.spacing)


@pytest.mark.parametrize("mesh", [simple_shapes.goblet(), simple_shapes.stool(), simple_shapes.box((1, 1, 0.01))])
def test_points_of_a_mesh_are_dense_enough_for_the_discs(mesh: TriangleMesh) -> None:
    reading = plain_reading(mesh)
    assert reading.surface is mesh
    assert LEAST_POINTS <= len(reading.points) <= MOST_POINTS
    assert reading.spacing == pytest.approx(np.sqrt(mesh.area / len(reading.points)))
    cloud = reading.cloud
    assert cloud.radius == pytest.approx(RADIUS)
    everywhere = uniform_points(mesh, 3000, rng=np.random.default_rng(1))
    gaps = cKDTree(reading.points).query(everywhere)[0]
    reach = np.linalg.norm(np.ptp(reading.points, axis=0)) / 2
    assert gaps.max() < 2.0 * RADIUS * reach
    assert np.quantile(gaps, 0.99) < RADIUS * reach


def test_the_same_query_is_read_the_same_twice(bumpy) -> None:
    noisy = add_noise(bumpy, 0.005, np.random.default_rng(0))
    for query in (bumpy, noisy, scanned(bumpy, 500), scanned(bumpy, MOST_POINTS + 500)):
        assert all(same(*pair) for pair in zip(readings(query), readings(query), strict=True))
        assert same(plain_reading(query), plain_reading(query))


def test_a_reading_knows_that_its_mesh_was_noisy(bumpy) -> None:
    assert not any(reading.was_noisy for reading in readings(bumpy))
    for query in (add_noise(bumpy, 0.005, np.random.default_rng(0)), add_ground(bumpy, 1.5, np.random.default_rng(0))):
        noisy = add_noise(query, 0.005, np.random.default_rng(0))
        assert all(reading.was_noisy for reading in readings(noisy))


def test_vertices_without_faces_do_not_count(bumpy) -> None:
    more = TriangleMesh(np.concatenate([bumpy.vertices, [[100.0, 0, 0]]]), bumpy.faces)
    assert same(readings(more)[0], readings(bumpy)[0])


def test_debris_of_a_mesh_is_neither_drawn_nor_compared(bumpy) -> None:
    clumps = [simple_shapes.box((0.05, 0.05, 0.05), (2.0 * x, 0.3, 0)) for x in (-1, 1)]
    first = readings(simple_shapes.joined([bumpy, *clumps]))[0]
    low, high = bumpy.bounds
    for vertices in (first.points, first.described_surface().vertices):
        assert (vertices >= low - 1e-9).all()
        assert (vertices <= high + 1e-9).all()
    assert first.described_surface().area == pytest.approx(bumpy.area)


def test_debris_of_a_cloud_is_not_drawn(bumpy) -> None:
    scan = scanned(bumpy, 3000).points
    clump = np.array([2.0, 0, 0]) + 0.03 * np.random.default_rng(1).normal(size=(20, 3))
    (reading,) = readings(PointCloud(np.concatenate([clump, scan])))
    assert reading.surface is None
    np.testing.assert_array_equal(reading.points, scan)


@pytest.mark.parametrize("seed", range(3))
def test_ground_of_a_mesh_gives_a_second_reading_without_it(bumpy, seed: int) -> None:
    query = add_ground(bumpy, 1.5, np.random.default_rng(seed))
    assert len(readings(bumpy)) == 1
    whole, without = readings(query)
    assert whole.surface is query
    left = without.described_surface()
    assert left.area == pytest.approx(bumpy.area, rel=0.05)
    np.testing.assert_allclose(left.bounds, bumpy.bounds, atol=0.05)
    assert (np.abs(without.points).max(axis=0) <= np.abs(bumpy.bounds).max(axis=0) + 1e-9).all()


def test_ground_of_a_cloud_gives_a_second_reading_without_it(bumpy) -> None:
    query = scanned(add_ground(bumpy, 1.5, np.random.default_rng(0)), 5000)
    whole, without = readings(query)
    np.testing.assert_array_equal(whole.points, query.points)
    assert without.surface is None
    np.testing.assert_allclose([without.points.min(axis=0), without.points.max(axis=0)], bumpy.bounds, atol=0.1)


def test_noise_of_a_mesh_is_smoothed(bumpy) -> None:
    noisy = add_noise(bumpy, 0.005, np.random.default_rng(0))
    before = distances_to_bumpy(plain_reading(noisy).points).mean()
    after = distances_to_bumpy(readings(noisy)[0].points).mean()
    assert distances_to_bumpy(plain_reading(bumpy).points).mean() < 0.1 * before
    assert after < 0.6 * before


def test_a_large_cloud_is_thinned_at_random(bumpy) -> None:
    query = scanned(bumpy, MOST_POINTS + 12_345)
    reading = plain_reading(query)
    assert len(reading.points) == MOST_POINTS
    assert len(np.unique(reading.points, axis=0)) == MOST_POINTS
    assert cKDTree(query.points).query(reading.points)[0].max() == 0.0
    assert reading.spacing == pytest.approx(np.sqrt(bumpy.area / MOST_POINTS), rel=0.15)


@pytest.mark.parametrize("count", [500, 4000])
def test_the_spacing_of_a_cloud_is_that_of_its_points(bumpy, count: int) -> None:
    reading = plain_reading(scanned(bumpy, count))
    assert reading.spacing == pytest.approx(np.sqrt(bumpy.area / count), rel=0.15)
    assert reading.described_surface().area > bumpy.area


def test_repeated_points_count_once(bumpy) -> None:
    once = scanned(bumpy, 600)
    repeated = PointCloud(np.repeat(once.points, 10, axis=0))
    assert same(plain_reading(repeated), plain_reading(once))


def test_what_has_no_extent_is_refused() -> None:
    flat = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]]))
    for read in (plain_reading, readings):
        with pytest.raises(MeshError, match="no area"):
            read(flat)
        with pytest.raises(MeshError, match="one place"):
            read(PointCloud(np.ones((9, 3))))


@pytest.mark.parametrize("count", [2, 4, 5])
def test_very_few_points_are_read(count: int) -> None:
    points = np.random.default_rng(0).normal(size=(count, 3))
    for reading in readings(PointCloud(np.concatenate([points, points]))):
        assert reading.cloud.radius > RADIUS
        assert np.isfinite(reading.described_surface().vertices).all()
