"""Laws of voxel grids and of the surfaces made of them."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation
from simple_shapes import box

from shapewright.evaluation.voxels import level_surface, voxel_sides, voxelize
from shapewright.mesh import TriangleMesh

BALL = TriangleMesh.from_trimesh(trimesh.creation.icosphere(3))


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return float((a * np.cross(b, c)).sum()) / 6.0


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("count", [5, 17, 60])
def test_no_closed_surface_leaks(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    shape = (BALL, box((1.0, 0.7, 0.4)))[seed % 2]
    turned = shape.transformed(Rotation.random(rng=rng).as_matrix(), rng.normal(size=3), 3.0)
    grid = voxelize(turned, count, 1, rng)
    middle = tuple(((turned.bounds.mean(axis=0) - grid.corner) / grid.side).astype(int))
    assert grid.filled()[middle]
    assert not grid.filled()[0].any()
    assert not grid.filled()[:, :, -1].any()
    assert count < 10 or not grid.occupied[middle]


def test_occupied_voxels_hold_points_of_the_surface() -> None:
    grid = voxelize(BALL, 30, 2, np.random.default_rng(0))
    centers = grid.placed(np.argwhere(grid.occupied) + 0.5)
    assert np.abs(np.linalg.norm(centers, axis=1) - 1.0).max() < 0.5 * np.sqrt(3.0) * grid.side + 0.01
    marked = tuple(((BALL.vertices - grid.corner) / grid.side).astype(int).T)
    assert grid.occupied[marked].all()


def test_thin_triangles_cost_little_and_are_whole() -> None:
    needle = TriangleMesh(np.array([[0.0, 0, 0], [1, 1, 1], [0.5, 0.5, 0.5 + 1e-9]]), np.array([[0, 1, 2]]))
    grid = voxelize(needle, 50, 1, np.random.default_rng(0))
    assert 50 <= grid.occupied.sum() <= 160


def test_sides_of_one_voxel_are_a_cube_that_faces_outward() -> None:
    solid = np.zeros((3, 4, 5), dtype=bool)
    solid[1, 2, 3] = True
    corners, faces = voxel_sides(solid)
    assert len(faces) == 12
    np.testing.assert_array_equal([corners.min(axis=0), corners.max(axis=0)], [[1, 2, 3], [2, 3, 4]])
    assert volume(corners, faces) == pytest.approx(1.0)
    assert TriangleMesh(corners, faces).is_watertight


def test_sides_hold_as_much_as_there_are_solid_voxels() -> None:
    solid = np.pad(np.random.default_rng(0).random((6, 5, 7)) < 0.4, 1)
    assert volume(*voxel_sides(solid)) == pytest.approx(solid.sum())


def test_the_level_surface_of_a_ball_is_the_ball() -> None:
    center = np.array([9.3, 10.1, 11.7])
    places = np.stack(np.meshgrid(*(np.arange(n) for n in (20, 21, 24)), indexing="ij"), axis=-1)
    vertices, faces = level_surface(np.linalg.norm(places - center, axis=-1), 6.4)
    np.testing.assert_allclose(np.linalg.norm(vertices - center, axis=1), 6.4, atol=0.1)
    assert TriangleMesh(vertices, faces).is_watertight
    assert volume(vertices, faces) == pytest.approx(4.0 / 3.0 * np.pi * 6.4**3, rel=0.035)  # a net cuts corners
