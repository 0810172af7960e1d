import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from shapewright.errors import MeshError
from shapewright.mesh import TriangleMesh
from shapewright.mesh.file import load_mesh


def box(size=(1.0, 2.0, 3.0)):
    return TriangleMesh.from_trimesh(trimesh.creation.box(size))


def test_figures_of_a_box():
    mesh = box()
    assert mesh.area == pytest.approx(22)
    np.testing.assert_allclose(mesh.bounds, [(-0.5, -1, -1.5), (0.5, 1, 1.5)])
    np.testing.assert_allclose(np.linalg.norm(mesh.face_normals, axis=1), 1)
    outward = np.einsum("fk,fk->f", mesh.face_normals, mesh.triangles.mean(axis=1))
    assert (outward > 0).all()
    assert mesh.is_watertight
    assert not TriangleMesh(mesh.vertices, mesh.faces[1:]).is_watertight
    np.testing.assert_allclose(mesh.centroid, 0, atol=1e-15)


def test_the_centroid_weighs_area_and_the_vertex_mean_does_not():
    fine = trimesh.creation.box((1, 1, 1)).subdivide().subdivide()
    fine.apply_translation((4, 0, 0))
    mesh = TriangleMesh.from_trimesh(trimesh.util.concatenate([trimesh.creation.box((1, 1, 1)), fine]))
    assert mesh.centroid[0] == pytest.approx(2)
    assert mesh.vertex_mean[0] > 3


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000), scale=st.floats(1e-6, 1e6), shift=st.floats(-1e3, 1e3))
def test_normalising_undoes_size_and_place(seed, scale, shift):
    rng = np.random.default_rng(seed)
    mesh = TriangleMesh(rng.normal(size=(20, 3)), rng.integers(0, 20, (30, 3)))
    moved = mesh.transformed(np.eye(3), np.full(3, shift * scale), scale)
    one, two = mesh.normalized(), moved.normalized()
    np.testing.assert_allclose(one.mesh.vertices, two.mesh.vertices, atol=1e-9)
    np.testing.assert_allclose(two.mesh.vertex_mean, 0, atol=1e-9)
    assert np.abs(two.mesh.vertices).max() == pytest.approx(1)
    back = (two.mesh.vertices - two.translation) / two.scale
    np.testing.assert_allclose(back, moved.vertices, rtol=1e-9, atol=1e-9 * scale)
    again = moved.transformed(np.eye(3), two.translation, two.scale)
    np.testing.assert_allclose(again.vertices, two.mesh.vertices, atol=1e-9)


def test_transforming_turns_then_scales_then_shifts():
    mesh = box()
    turn = Rotation.random(rng=np.random.default_rng(0)).as_matrix()
    moved = mesh.transformed(turn, np.array([1.0, 2.0, 3.0]), 2.0)
    np.testing.assert_allclose(moved.vertices[0], 2 * turn @ mesh.vertices[0] + [1, 2, 3])
    assert moved.area == pytest.approx(4 * mesh.area)


def test_cleaning_merges_and_drops_and_keeps_the_rest():
    mesh = box()
    soup = mesh.triangles.reshape(-1, 3)
    faces = np.arange(len(soup)).reshape(-1, 3)
    dirty = TriangleMesh(
        np.concatenate([soup, [(50.0, 50.0, 50.0)]]),  # a vertex that nobody uses
        np.concatenate([faces, [(0, 0, 1)], faces[:1], faces[:1, ::-1]]),
    )
    clean = dirty.cleaned()
    assert len(clean.vertices) == 8
    assert len(clean.faces) == 14  # repeated faces stay
    assert clean.area == pytest.approx(dirty.area)
    assert TriangleMesh(clean.vertices, clean.faces[:12]).is_watertight
    np.testing.assert_array_equal(clean.triangles[:12], mesh.triangles)  # order and winding stay
    with pytest.raises(MeshError, match="area"):
        TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]])).cleaned()


@pytest.mark.parametrize(
    ("vertices", "faces", "where"),
    [
        (np.zeros((3, 3)), np.zeros((0, 3), dtype=int), "faces"),
        (np.array([(0, 0, 0), (1, 0, 0), (0, np.nan, 0)]), [[0, 1, 2]], r"vertices\[2\]"),
        (np.array([(0, 0, 0), (np.inf, 0, 0), (0, 1, 0)]), [[0, 1, 2]], r"vertices\[1\]"),
        (np.eye(3), [[0, 1, 2], [0, 1, 3]], r"faces\[1\]"),
        (np.eye(3), [[-1, 1, 2]], r"faces\[0\]"),
    ],
)
def test_refusals_tell_the_place(vertices, faces, where):
    with pytest.raises(MeshError, match=f"^{where}: "):
        TriangleMesh(vertices, np.array(faces))


def test_a_single_point_cannot_be_normalised():
    with pytest.raises(MeshError, match="one point"):
        TriangleMesh(np.ones((3, 3)), np.array([[0, 1, 2]])).normalized()


@pytest.mark.parametrize("file_type", ["glb", "obj", "off", "ply", "stl"])
def test_written_files_read_back(tmp_path, file_type):
    mesh = box((1e-4 / 3, 2.0, 3.0 / 7)).cleaned()
    path = tmp_path / f"box.{file_type.upper()}"
    mesh.save(path)
    again = load_mesh(path)
    assert again.is_watertight
    if file_type in ("obj", "off"):
        np.testing.assert_array_equal(again.vertices, mesh.vertices)
        np.testing.assert_array_equal(again.faces, mesh.faces)
    else:
        order = np.lexsort(mesh.vertices.T.round(6)), np.lexsort(again.vertices.T.round(6))
        np.testing.assert_allclose(again.vertices[order[1]], mesh.vertices[order[0]], rtol=1e-6)
        assert again.area == pytest.approx(mesh.area, rel=1e-5)
    other = trimesh.load_mesh(path, process=True)
    assert len(other.faces) == 12


def test_unknown_file_type_is_not_written(tmp_path):
    with pytest.raises(MeshError, match="docx"):
        box().save(tmp_path / "box.docx")
    assert list(tmp_path.iterdir()) == []


def test_trimesh_round_trip_copies():
    mesh = box()
    other = mesh.to_trimesh()
    np.testing.assert_array_equal(other.vertices, mesh.vertices)
    other.vertices[0] = 99
    assert mesh.vertices.max() < 99
    assert TriangleMesh.from_trimesh(other).vertices.max() == 99
