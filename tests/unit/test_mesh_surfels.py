"""Laws of surfels."""

import numpy as np
import pytest

from shapewright.mesh.surfels import MOST, surfels


def sphere(count: int, seed: int = 0) -> np.ndarray:
    """Independent random points of the unit sphere."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


def spacing_of(count: int) -> float:
    return float(np.sqrt(4 * np.pi / count))


@pytest.mark.parametrize("count", [300, 2500, 20_000])
def test_surfels_of_a_sphere_lie_on_it(count: int) -> None:
    spacing = spacing_of(count)
    mesh = surfels(sphere(count), spacing)
    middles = mesh.triangles.mean(axis=1)
    distances = np.linalg.norm(middles, axis=1)
    # 48 neighbors reach four spacings far, and a plane through them lies below the sphere by four squared spacings.
    dip = 8.0 * spacing**2
    assert np.abs(distances - 1.0).max() < dip
    reach = np.linalg.norm(mesh.triangles - middles[:, None], axis=2).max()
    assert np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1.0).max() < dip + reach**2
    facing = np.abs((mesh.face_normals * middles).sum(axis=1) / distances)
    assert facing.min() > 1.0 - 3.0 * spacing**2
    assert facing.mean() > 0.995


@pytest.mark.parametrize("count", [300, MOST, MOST + 1, 20_000])
def test_every_surfel_is_as_much_larger_than_its_share_of_the_surface(count: int) -> None:
    mesh = surfels(sphere(count), spacing_of(count))
    assert len(mesh.faces) <= MOST
    assert len(mesh.faces) > min(count, MOST) / 2
    np.testing.assert_allclose(mesh.face_areas, mesh.face_areas[0])
    assert mesh.area == pytest.approx(2.37 * 4 * np.pi, rel=0.01)


def test_surfels_lie_nearer_to_the_surface_than_noisy_points() -> None:
    rng = np.random.default_rng(1)
    flat = rng.random((2500, 3)) * [1.0, 1.0, 0.0]
    noisy = flat + [0.0, 0.0, 0.01] * rng.normal(size=(2500, 3))
    middles = surfels(noisy, 0.02).triangles.mean(axis=1)
    assert np.abs(middles[:, 2]).mean() < 0.4 * np.abs(noisy[:, 2]).mean()
    shaken = sphere(3000) * (1.0 + 0.02 * rng.normal(size=(3000, 1)))
    distances = np.linalg.norm(surfels(shaken, spacing_of(3000)).triangles.mean(axis=1), axis=1)
    assert distances.std() < 0.5 * 0.02


def test_surfels_of_a_plane_lie_in_it() -> None:
    flat = np.random.default_rng(0).random((400, 3)) * [1.0, 1.0, 0.0]
    mesh = surfels(flat, 0.05)
    assert np.abs(mesh.vertices[:, 2]).max() < 1e-9
    assert np.linalg.norm(mesh.triangles.mean(axis=1) - flat, axis=1).max() < 1e-9


def test_surfels_move_with_the_points() -> None:
    points = sphere(500)
    moved = surfels(7.0 * points + [1.0, 2.0, 3.0], 7.0 * spacing_of(500)).triangles.mean(axis=1)
    np.testing.assert_allclose(
        moved, 7.0 * surfels(points, spacing_of(500)).triangles.mean(axis=1) + [1.0, 2.0, 3.0], atol=1e-6
    )


@pytest.mark.parametrize("count", [1, 2, 5])
def test_fewer_points_than_neighbors_have_a_surfel_each(count: int) -> None:
    assert len(surfels(sphere(count), 0.1).faces) == count
