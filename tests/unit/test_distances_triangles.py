"""Exact distances to triangle soup."""

import numpy as np
import pytest
import simple_shapes
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from shapewright.distances.triangles import TriangleDistance
from shapewright.mesh import TriangleMesh


def soup(rng, count, size):
    centres = rng.uniform(-1, 1, (count, 1, 3))
    corners = centres + size * rng.normal(size=(count, 3, 3))
    return TriangleMesh(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def brute_force(mesh, points):
    """The distance to each triangle by trimesh, one triangle after the other."""
    return np.min(
        [
            np.linalg.norm(trimesh.triangles.closest_point(np.tile(t, (len(points), 1, 1)), points) - points, axis=1)
            for t in mesh.triangles
        ],
        axis=0,
    )


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), count=st.sampled_from([1, 2, 3, 4, 5, 9, 60, 200]), size=st.floats(0.001, 2.0))
def test_it_is_what_trimesh_finds_in_random_soup(seed, count, size):
    rng = np.random.default_rng(seed)
    mesh = soup(rng, count, size)
    points = rng.uniform(-2, 2, (50, 3))
    distances, faces = TriangleDistance(mesh).nearest(points)
    np.testing.assert_allclose(distances, brute_force(mesh, points), rtol=1e-9, atol=1e-12)
    of_those = trimesh.triangles.closest_point(mesh.triangles[faces], points)
    np.testing.assert_allclose(np.linalg.norm(of_those - points, axis=1), distances, rtol=1e-9, atol=1e-12)


def test_points_of_the_surface_are_at_zero():
    mesh = simple_shapes.goblet()
    weights = np.random.default_rng(0).dirichlet(np.ones(3), len(mesh.faces))
    on_it = np.einsum("fk,fkd->fd", weights, mesh.triangles)
    assert TriangleDistance(mesh)(on_it).max() < 1e-10
    assert TriangleDistance(mesh)(mesh.vertices).max() < 1e-10


@pytest.mark.parametrize("shape", ["point", "line", "needle"])
def test_a_triangle_without_area_is_the_line_or_point_that_it_is(shape):
    end = {"point": [0.0, 0, 0], "line": [1.0, 0, 0], "needle": [1.0, 1e-12, 0]}[shape]
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [0.5 * end[0], 0, 0], end]), np.array([[0, 1, 2]]))
    points = np.array([[-1.0, 0, 0], [0.25, 0.3, 0.4], [2.0, 0, 0], [0.5, 0, 0]])
    ends = np.array([1.0, 0.5, 1.0, 0.0])
    expected = np.linalg.norm(points, axis=1) if shape == "point" else ends
    np.testing.assert_allclose(TriangleDistance(mesh)(points), expected, atol=1e-11)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10_000), scale=st.floats(1e-6, 1e6))
def test_distances_scale_with_the_mesh(seed, scale):
    rng = np.random.default_rng(seed)
    mesh, points = soup(rng, 30, 0.3), rng.uniform(-2, 2, (20, 3))
    grown = mesh.transformed(np.eye(3), np.zeros(3), scale)
    np.testing.assert_allclose(TriangleDistance(grown)(scale * points), scale * TriangleDistance(mesh)(points))


def test_a_flat_mesh_and_no_points_are_fine():
    sheet = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]]), np.array([[0, 1, 2]]))
    assert TriangleDistance(sheet)(np.array([[0.6, 0.2, 0.7]])) == pytest.approx(0.7)
    assert len(TriangleDistance(sheet)(np.zeros((0, 3)))) == 0
