"""Laws of cutting: the surface stays, the triangulation does not."""

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree
from simple_shapes import box

from models_store.library.shipped import load_shipped
from shapewright.distances.surface import uniform_points
from shapewright.evaluation.anew import cut_anew
from shapewright.mesh import TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges
from shapewright.modeling import compile_model

SHIPPED = ("table", "sword_sabre", "spider_ant", "bicycle")


def shipped(name: str) -> TriangleMesh:
    compiled = compile_model(load_shipped(name))
    return compiled.instance(compiled.random_values(np.random.default_rng(3), 1)[0])


def half_extent(mesh: TriangleMesh) -> float:
    return 0.5 * float(np.ptp(mesh.bounds, axis=0).max())


def farthest(mesh: TriangleMesh, surface: TriangleMesh) -> np.ndarray:
    """Distances of points on a mesh to a surface, as shares of its half extent."""
    points = uniform_points(mesh, 1500, rng=np.random.default_rng(0))
    fine = cut_edges(surface, 0.03 * half_extent(surface))
    near = cKDTree(fine.triangles.mean(axis=1)).query(points, k=20)[1]
    corners = fine.triangles[near].reshape(-1, 3, 3)
    closest = trimesh.triangles.closest_point(corners, np.repeat(points, 20, axis=0))
    away = np.linalg.norm(closest.reshape(-1, 20, 3) - points[:, None], axis=2).min(axis=1)
    return np.asarray(away / half_extent(surface))


@pytest.mark.parametrize("name", SHIPPED)
def test_the_surface_that_is_cut_anew_stays_within_a_thousandth(name: str) -> None:
    mesh = shipped(name)
    anew = cut_anew(mesh, np.random.default_rng(7))
    for away in (farthest(anew, mesh), farthest(mesh, anew)):
        assert np.quantile(away, 0.99) < 1e-3
        assert away.mean() < 1e-4
    assert anew.area == pytest.approx(mesh.area, rel=0.02)


@pytest.mark.parametrize("name", SHIPPED)
def test_nothing_of_the_triangulation_is_left(name: str) -> None:
    """Corners must stay where they are; the vertices between them and all triangles are others, in another order."""
    mesh = shipped(name)
    anew = cut_anew(mesh, np.random.default_rng(7))
    kept = cKDTree(anew.vertices).query(mesh.cleaned().vertices)[0] < 1e-9 * half_extent(mesh)
    assert kept.mean() < 0.2
    middles = cKDTree(anew.triangles.mean(axis=1)).query(mesh.triangles.mean(axis=1))[0] < 1e-9 * half_extent(mesh)
    assert middles.mean() < 0.02
    assert len(anew.vertices) > len(mesh.vertices)
    steps = np.linalg.norm(np.diff(anew.vertices, axis=0), axis=1)
    assert np.median(steps) > 0.2 * half_extent(mesh)  # neighbors in the list are no neighbors on the surface


def test_the_same_seed_cuts_the_same() -> None:
    first, second, other = (cut_anew(box(), np.random.default_rng(seed)) for seed in (0, 0, 1))
    np.testing.assert_array_equal(first.vertices, second.vertices)
    np.testing.assert_array_equal(first.faces, second.faces)
    assert first.vertices.shape != other.vertices.shape or not np.allclose(first.vertices, other.vertices)
