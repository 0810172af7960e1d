import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from shapewright.distances.surface import (
    SurfaceDistance,
    poisson_disk_points,
    surface_distance,
    uniform_points,
)
from shapewright.errors import MeshError
from shapewright.mesh import TriangleMesh


def mesh_of(thing):
    return TriangleMesh.from_trimesh(thing)


def spacing(points):
    return cKDTree(points).query(points, k=2)[0][:, 1]


def test_points_are_on_the_surface_and_evenly_spread():
    mesh = mesh_of(trimesh.creation.box((2.0, 1.0, 0.5)))
    points = poisson_disk_points(mesh, 1000, rng=np.random.default_rng(0))
    assert points.shape == (1000, 3)
    away = np.abs(points) - np.array([1.0, 0.5, 0.25])
    np.testing.assert_allclose(away.max(axis=1), 0, atol=1e-12)
    widest = np.sqrt(mesh.area / (2 * np.sqrt(3) * 1000))
    gaps = spacing(points)
    random_gaps = spacing(uniform_points(mesh, 1000, rng=np.random.default_rng(0)))
    # radius of a disk 'widest', so perfect packing has gaps of twice that
    assert gaps.min() > 0.6 * 2 * widest
    assert gaps.std() / gaps.mean() < 0.15 < 0.4 < random_gaps.std() / random_gaps.mean()
    assert random_gaps.min() < 0.1 * 2 * widest
    # no holes either: every place of the surface has a point near
    places = uniform_points(mesh, 5000, rng=np.random.default_rng(1))
    assert cKDTree(points).query(places)[0].max() < 2.5 * widest


def test_a_seed_gives_the_same_points_and_another_seed_others():
    mesh = mesh_of(trimesh.creation.icosphere(2))
    first, again, other = (poisson_disk_points(mesh, 200, rng=np.random.default_rng(s)) for s in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)


def test_area_decides_not_the_number_of_triangles():
    coarse = trimesh.creation.box((1, 1, 1))
    fine = trimesh.creation.box((1, 1, 1)).subdivide().subdivide().subdivide().subdivide()
    fine.apply_translation((5, 0, 0))
    points = poisson_disk_points(mesh_of(trimesh.util.concatenate([coarse, fine])), 500, rng=np.random.default_rng(0))
    assert (points[:, 0] > 2.5).sum() == pytest.approx(250, abs=15)


@pytest.mark.parametrize("kind", ["twofold", "layers", "needle", "single"])
def test_soup_of_every_sort_gives_the_count(kind):
    box = trimesh.creation.box((1, 1, 1))
    if kind == "twofold":  # every face twice, wound both ways
        mesh = TriangleMesh(np.array(box.vertices), np.concatenate([box.faces, box.faces[:, ::-1]]))
    elif kind == "layers":
        mesh = TriangleMesh(np.array(box.vertices), np.tile(box.faces[:2], (2000, 1)))
    elif kind == "needle":
        mesh = mesh_of(trimesh.creation.box((1e-6, 1e-6, 1.0)))
    else:
        mesh = TriangleMesh(np.array(box.vertices), box.faces[:1])
    points = poisson_disk_points(mesh, 300, rng=np.random.default_rng(0))
    assert points.shape == (300, 3)
    assert len(np.unique(points, axis=0)) == 300
    assert np.isfinite(points).all()


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000), sizes=st.tuples(st.integers(1, 60), st.integers(1, 60)))
def test_distance_laws(seed, sizes):
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(sizes[0], 3)), rng.normal(size=(sizes[1], 3))
    table = np.linalg.norm(a[:, None] - b, axis=2)
    brute = np.concatenate([table.min(axis=1), table.min(axis=0)]).mean()
    assert surface_distance(a, b) == pytest.approx(brute, rel=1e-12)
    assert surface_distance(a, b) == pytest.approx(surface_distance(b, a), rel=1e-12)
    assert surface_distance(a, a) == 0
    turn = Rotation.random(rng=rng)
    moved = surface_distance(turn.apply(a) + 7, turn.apply(b) + 7)
    assert moved == pytest.approx(surface_distance(a, b), rel=1e-9)
    assert surface_distance(3 * a, 3 * b) == pytest.approx(3 * brute, rel=1e-12)


def test_one_query_against_many_sets():
    rng = np.random.default_rng(0)
    query = rng.normal(size=(50, 3))
    distance = SurfaceDistance(query)
    for size in (1, 10, 200):
        other = rng.normal(size=(size, 3))
        assert distance(other) == surface_distance(query, other)


def test_it_tells_shapes_and_sizes_apart():
    ball = mesh_of(trimesh.creation.icosphere(4)).normalized().mesh
    distance = SurfaceDistance(poisson_disk_points(ball, rng=np.random.default_rng(0)))
    box = mesh_of(trimesh.creation.box((2, 2, 2)).subdivide().subdivide().subdivide().subdivide())
    same = distance(ball.vertices)
    assert same < 0.04 < distance(box.vertices)
    assert same < distance(ball.vertices * 0.95) < distance(ball.vertices * 0.8)


def test_refusals():
    flat = TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    with pytest.raises(MeshError, match="no area"):
        poisson_disk_points(flat, 10, rng=np.random.default_rng(0))
    with pytest.raises(MeshError, match="positive"):
        poisson_disk_points(mesh_of(trimesh.creation.box()), 0, rng=np.random.default_rng(0))
    with pytest.raises(MeshError, match="query_points"):
        SurfaceDistance(np.zeros((0, 3)))
    with pytest.raises(MeshError, match=r"model_vertices.*NaN"):
        surface_distance(np.zeros((1, 3)), np.full((2, 3), np.nan))
