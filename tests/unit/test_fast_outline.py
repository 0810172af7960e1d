"""Outlines of query and instance in the depth views, and how one pulls the other."""

import numpy as np
import pytest
import simple_shapes
from fast_support import target_of

from shapewright.distances.depth_kernels import WINDOW
from shapewright.distances.rasterize import PASS_FRAMES
from shapewright.estimation.fast import outline_kernels
from shapewright.mesh import TriangleMesh

SIZE = 128


def outline_of(mask: np.ndarray, room: int = 5000):
    pixels, normals = np.empty((room, 2), dtype=np.int64), np.empty((room, 2))
    found = outline_kernels.mask_outline(mask, pixels, normals)
    return pixels[:found], normals[:found]


def disc(size: int = 64, radius: float = 20.0) -> np.ndarray:
    rows, columns = np.mgrid[:size, :size]
    return (rows - 30) ** 2 + (columns - 33) ** 2 <= radius**2


def test_the_outline_of_a_disc_is_a_circle_whose_normals_point_outward():
    pixels, normals = outline_of(disc())
    away = pixels - np.array([33.0, 30.0])
    radii = np.linalg.norm(away, axis=1)
    assert radii.min() > 18.5
    assert radii.max() <= 20.0
    assert ((away / radii[:, None]) * normals).sum(axis=1).min() > 0.9
    assert len(np.unique(pixels, axis=0)) == len(pixels)
    angles = np.sort(np.arctan2(away[:, 1], away[:, 0]))
    assert np.diff(angles).max() < 0.12  # no gap


def test_a_hole_has_an_outline_whose_normals_point_into_it():
    mask = disc() & ~disc(radius=8.0)
    pixels, normals = outline_of(mask)
    away = pixels - np.array([33.0, 30.0])
    inner = np.linalg.norm(away, axis=1) < 12.0
    assert inner.sum() > 30
    assert ((away * normals).sum(axis=1)[inner] < 0).all()


def test_no_more_is_found_than_there_is_room_for():
    assert len(outline_of(disc(), 10)[0]) == 10
    assert len(outline_of(np.zeros((20, 20), dtype=bool))[0]) == 0


def points_of(mesh: TriangleMesh):
    room = 20_000
    found = (
        np.empty(room, dtype=np.int64),
        np.empty((room, 3)),
        np.empty(room, dtype=np.int64),
        np.empty((room, 2), dtype=np.int64),
        np.empty((room, 2)),
    )
    count = outline_kernels.outline_points(mesh.vertices, mesh.faces, PASS_FRAMES, SIZE, WINDOW, *found)
    return [part[:count] for part in found]


def test_outline_points_are_seen_at_their_pixels():
    mesh = simple_shapes.goblet()
    faces, weights, views, pixels, normals = points_of(mesh)
    assert set(views.tolist()) == set(range(7))
    assert weights.min() >= -1e-9
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    places = np.einsum("nk,nkd->nd", weights, mesh.triangles[faces])
    seen = np.einsum("nkd,nd->nk", PASS_FRAMES[views][:, :2], places)
    middles = (pixels - 0.5 * (SIZE - 1)) * (2.0 * WINDOW / SIZE)
    np.testing.assert_allclose(seen, middles, atol=1e-9)


def test_an_instance_has_the_outline_that_its_depth_images_have():
    mesh = simple_shapes.stool()
    target = target_of(mesh, SIZE)
    _, _, views, pixels, _ = points_of(mesh)
    from shapewright.distances.rasterize import depth_views

    for view, mask in enumerate(np.isfinite(depth_views(mesh.vertices, mesh.faces, SIZE)[::2])):
        expected = {tuple(pixel) for pixel in outline_of(mask)[0].tolist()}
        found = {tuple(pixel) for pixel in pixels[views == view].tolist()}
        # the depth images snap vertices to fractions of a pixel, the outlines do not
        assert len(expected ^ found) <= 0.05 * len(expected)
    assert target.outline.pulls(mesh.vertices, mesh.faces, 200, 1.0, 0.1) is not None


def test_outline_pairs_are_matched_by_the_way_that_they_face():
    others = np.array([[0.0, 0.0], [0.1, 0.0]])
    other_normals = np.array([[-1.0, 0.0], [1.0, 0.0]])
    points, near = np.array([[0.06, 0.0], [0.04, 0.0]]), np.array([[0, 1], [0, 1]])
    chosen = np.empty(2, dtype=np.int64)
    outline_kernels.match_outlines(points, other_normals, others, other_normals, near, 0.3, chosen)
    np.testing.assert_array_equal(chosen, [0, 1])


@pytest.mark.parametrize("view", range(7))
def test_outline_pairs_pull_within_the_plane_of_their_view_only(view):
    frame = PASS_FRAMES[view]
    metrics, forces = np.zeros((1, 3, 3)), np.zeros((1, 3))
    outline_kernels.add_outline_pairs(
        np.zeros(1, dtype=np.int64), np.array([[0.3, 0.1]]), np.array([[1.0, 0.0]]), np.array([view]), PASS_FRAMES,
        0.0, 1e6, 2.0, metrics, forces,
    )  # fmt: skip
    np.testing.assert_allclose(forces[0], 2.0 * (0.3 * frame[0] + 0.1 * frame[1]), atol=1e-9)
    across = np.outer(frame[2], frame[2])
    np.testing.assert_allclose(metrics[0], 2.0 * (np.eye(3) - across), atol=1e-9)
    # a move along the outline by less than the spacing counts nothing
    metrics[:], forces[:] = 0.0, 0.0
    outline_kernels.add_outline_pairs(
        np.zeros(1, dtype=np.int64), np.array([[0.3, 0.1]]), np.array([[1.0, 0.0]]), np.array([view]), PASS_FRAMES,
        0.2, 1e6, 2.0, metrics, forces,
    )  # fmt: skip
    np.testing.assert_allclose(forces[0], 0.6 * frame[0], atol=1e-9)


def test_what_is_too_large_is_pulled_inward_and_a_perfect_fit_hardly_at_all():
    mesh = simple_shapes.goblet()
    outline = target_of(mesh, SIZE).outline
    strengths = []
    for scale in (1.0, 1.2):
        points = scale * mesh.vertices
        pulls = outline.pulls(points, mesh.faces, 500, 1.0, 0.5)
        places = np.einsum("nk,nkd->nd", pulls.weights, points[mesh.faces[pulls.faces]])
        strengths.append(float((places * pulls.forces).sum()))  # the gradient by the logarithm of the scale
    assert strengths[1] > 0.02
    assert abs(strengths[0]) < 0.05 * strengths[1]


def test_what_is_out_of_sight_or_too_small_is_not_pulled():
    mesh = simple_shapes.goblet()
    outline = target_of(mesh, SIZE).outline
    assert outline.pulls(mesh.vertices + np.array((10.0, -7.0, 3.0)), mesh.faces, 500, 1.0, 0.5) is None
    assert outline.pulls(1e-4 * mesh.vertices, mesh.faces, 500, 1.0, 0.5) is None
