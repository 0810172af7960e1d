"""Laws of the corruptions, over every one and over each alone."""

import numpy as np
import pytest
from scipy.spatial import cKDTree
from simple_shapes import box, crossing_sheets, goblet, joined, stool

from shapewright.distances.rasterize import depth_views
from shapewright.distances.surface import uniform_points
from shapewright.errors import EvaluationError
from shapewright.evaluation.corruptions import CORRUPTIONS, Corruption
from shapewright.evaluation.corruptions.corruption import diagonal
from shapewright.evaluation.corruptions.half import STEEPEST
from shapewright.evaluation.corruptions.holes import RADII
from shapewright.evaluation.corruptions.noise import LONGEST_EDGE
from shapewright.evaluation.edge_cutting import cut_edges
from shapewright.mesh import TriangleMesh

SHAPES = {
    "box": box((3.0, 1.0, 0.4), (5.0, -2.0, 1.0)),
    "goblet": goblet(),
    "stool": stool(),
    "soup": crossing_sheets(),
}
NOISE, HOLES, DECIMATED, HALF = (CORRUPTIONS[name] for name in ("noise", "holes", "decimated", "half"))


def sphere(radius: float = 1.0) -> TriangleMesh:
    fine = cut_edges(box(), 0.1)
    return TriangleMesh(radius * fine.vertices / np.linalg.norm(fine.vertices, axis=1)[:, None], fine.faces).cleaned()


def corrupted(corruption: Corruption, mesh: TriangleMesh, strength: float | None = None, seed: int = 0) -> TriangleMesh:
    return corruption(mesh, strength, np.random.default_rng(seed))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("name", CORRUPTIONS)
def test_a_seed_gives_one_mesh_near_the_shape_and_leaves_the_original_alone(name: str, shape: str) -> None:
    corruption, mesh = CORRUPTIONS[name], SHAPES[shape]
    vertices, faces = mesh.vertices.copy(), mesh.faces.copy()
    first, second = corrupted(corruption, mesh), corrupted(corruption, mesh)
    np.testing.assert_array_equal(first.vertices, second.vertices)
    np.testing.assert_array_equal(first.faces, second.faces)
    np.testing.assert_array_equal(mesh.vertices, vertices)
    np.testing.assert_array_equal(mesh.faces, faces)
    if name != "decimated":  # which has nothing random
        other = corrupted(corruption, mesh, seed=1)
        assert other.vertices.shape != first.vertices.shape or not np.allclose(other.vertices, first.vertices)
    points = uniform_points(mesh, 4000, rng=np.random.default_rng(2))
    away = cKDTree(points).query(uniform_points(first, 500, rng=np.random.default_rng(3)))[0]
    assert np.median(away) < 0.03 * diagonal(mesh)


@pytest.mark.parametrize("name", CORRUPTIONS)
def test_each_has_three_strengths_in_its_range_and_refuses_what_is_outside(name: str) -> None:
    corruption = CORRUPTIONS[name]
    assert corruption.name == name
    assert len(set(corruption.strengths)) == 3
    for strength in (*corruption.strengths, corruption.default):
        assert corruption.checked(strength) == strength
    assert corruption.checked(None) == corruption.default
    for strength in (corruption.least - 1.0, corruption.most * 2.0, float("nan")):
        with pytest.raises(EvaluationError, match="expected a strength") as caught:
            corruption.checked(strength)
        assert caught.value.where == "strength"


@pytest.mark.parametrize("name", CORRUPTIONS)
@pytest.mark.parametrize("factor", [1e-9, 1e9])
def test_scale_and_place_do_not_matter(name: str, factor: float) -> None:
    plain = corrupted(CORRUPTIONS[name], SHAPES["stool"])
    scaled = corrupted(CORRUPTIONS[name], SHAPES["stool"].transformed(np.eye(3), np.full(3, factor), factor))
    assert scaled.area / factor**2 == pytest.approx(plain.area, rel=0.02)


@pytest.mark.parametrize("strength", NOISE.strengths)
def test_noise_has_the_amplitude_that_is_asked_for(strength: float) -> None:
    mesh = SHAPES["box"]
    fine = cut_edges(mesh.cleaned(), LONGEST_EDGE * diagonal(mesh))
    moved = (corrupted(NOISE, mesh, strength).vertices - fine.vertices) / diagonal(mesh)
    assert moved.std() == pytest.approx(strength, rel=0.05)
    assert abs(moved.mean()) < 0.1 * strength
    np.testing.assert_allclose(corrupted(NOISE, mesh, 0.0).vertices, fine.vertices)


def test_noise_does_not_tear_triangles_that_touch() -> None:
    mesh = box()
    apart = TriangleMesh(mesh.triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3))
    assert not apart.is_watertight
    assert corrupted(NOISE, apart).is_watertight


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("strength", HOLES.strengths)
def test_holes_take_the_area_that_is_asked_for(shape: str, strength: float) -> None:
    mesh = SHAPES[shape]
    left = corrupted(HOLES, mesh, strength)
    assert left.area == pytest.approx((1.0 - strength) * mesh.cleaned().area, rel=0.01)
    assert not left.is_watertight


def test_holes_are_patches() -> None:
    mesh = box()
    left = corrupted(HOLES, mesh, 0.1)
    points = uniform_points(mesh, 4000, rng=np.random.default_rng(0))
    away = cKDTree(uniform_points(left, 20_000, rng=np.random.default_rng(1))).query(points)[0]
    inside = away > 0.02 * diagonal(mesh)  # well inside a hole
    assert 0.02 < inside.mean() < 0.1
    assert away.max() < RADII[1] * diagonal(mesh) * 1.5


@pytest.mark.parametrize("strength", DECIMATED.strengths)
def test_decimation_keeps_the_share_of_faces_and_the_shape(strength: float) -> None:
    mesh = sphere()
    fewer = corrupted(DECIMATED, mesh, strength)
    assert len(fewer.faces) == pytest.approx(strength * len(mesh.faces), rel=0.1)
    assert fewer.area == pytest.approx(mesh.area, rel=0.05)
    assert fewer.is_watertight


def test_decimation_gives_no_thin_part_up() -> None:
    """The package's default deletes most of the spokes at this strength."""
    spokes = [cut_edges(box((0.02, 0.02, 2.0), (0.1 * i, 0.0, 0.0)), 0.1) for i in range(12)]
    mesh = joined(spokes)
    assert corrupted(DECIMATED, mesh, 0.03).area == pytest.approx(mesh.area, rel=0.05)


@pytest.mark.parametrize("strength", HALF.strengths)
def test_half_sees_the_front_only(strength: float) -> None:
    ball = sphere(2.0)
    seen = corrupted(HALF, ball, strength)
    radii = np.linalg.norm(seen.vertices, axis=1)
    np.testing.assert_allclose(radii, 2.0, atol=0.03)
    middle = seen.vertices.mean(axis=0)
    toward_camera = middle / np.linalg.norm(middle)
    assert (seen.vertices @ toward_camera).min() > 0.0
    cap = 0.5 * ball.area * (1.0 - np.cos(np.arctan(STEEPEST)))  # without the rim, which is too steep
    assert seen.area == pytest.approx(cap, rel=0.05)


def test_half_keeps_the_picture_and_nothing_that_is_hidden() -> None:
    """From the camera's side the mesh and what was seen of it look the same; a box within another is never seen."""
    nested = joined([box((2.0, 2.0, 2.0)), box((1.0, 1.0, 1.0))])
    seen = corrupted(HALF, nested, 256.0)
    assert (np.abs(seen.vertices).max(axis=1) > 0.99).all()
    original, half = (depth_views(mesh.vertices, mesh.faces, 64) for mesh in (nested, seen))
    both = np.isfinite(original) & np.isfinite(half)
    assert (half[both] >= original[both] - 0.02).all()  # nothing is nearer to any camera than the mesh was


def test_half_of_a_thin_sheet_is_the_sheet() -> None:
    sheet = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    seen = corrupted(HALF, sheet)
    assert np.abs(seen.vertices[:, 2]).max() < 1e-5
    assert seen.area == pytest.approx(1.0, rel=0.1)
