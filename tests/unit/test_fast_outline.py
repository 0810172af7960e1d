"""Outlines of query and instance in the depth views, and how one pulls the other."""

import numpy as np
import pytest
import simple_shapes
from fast_support import target_of

from shapewright.distances.depth_kernels import WINDOW, trace_mask
from shapewright.distances.rasterize import PASS_FRAMES, depth_views
from shapewright.estimation.fast import outline_kernels

SIZE = 128


def outline_of(mask: np.ndarray, room: int = 5000):
    pixels, normals = np.empty((room, 2), dtype=np.int64), np.empty((room, 2))
    found = trace_mask(np.where(mask, 0, -1).astype(np.int32), pixels, normals)
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


def test_outline_points_are_seen_at_their_pixels():
    mesh = simple_shapes.goblet()
    distance, trace = target_of(mesh, SIZE).traced(mesh.vertices, mesh.faces)
    assert distance == 0.0
    faces, weights, views, pixels, normals = trace.faces, trace.weights, trace.views, trace.pixels, trace.normals
    assert set(views.tolist()) == set(range(7))
    assert weights.min() >= -1e-9
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    places = np.einsum("nk,nkd->nd", weights, mesh.triangles[faces])
    seen = np.einsum("nkd,nd->nk", PASS_FRAMES[views][:, :2], places)
    middles = (pixels - 0.5 * (SIZE - 1)) * (2.0 * WINDOW / SIZE)
    np.testing.assert_allclose(seen, middles, atol=2.0 * WINDOW / SIZE / 4096)  # vertices are snapped


def test_an_instance_has_the_outline_and_the_distance_that_its_depth_images_have():
    mesh, moved = simple_shapes.stool(), simple_shapes.stool().vertices * (1.1, 0.9, 0.8)
    target = target_of(mesh, SIZE)
    distance, trace = target.traced(moved, mesh.faces)
    assert distance == target.zbuffer_distance(moved, mesh.faces) > 0.01
    for view, mask in enumerate(np.isfinite(depth_views(moved, mesh.faces, SIZE)[::2])):
        expected = {tuple(pixel) for pixel in outline_of(mask)[0].tolist()}
        assert {tuple(pixel) for pixel in trace.pixels[trace.views == view].tolist()} == expected
    assert target.outline.pulls(trace, 200, 1.0, 0.1) is not None


def test_outline_pairs_are_matched_by_the_way_that_they_face():
    others = np.array([[0.0, 0.1], [0.0, 0.0], [-1.0, 1.0], [0.0, 0.0]])
    points = np.array([[0.06, 0.04, 0.04], [0.0, 0.0, 0.0], [-1.0, 1.0, 1.0], [0.0, 0.0, 0.0]])
    chosen = np.empty(3, dtype=np.int64)
    # the third point is in a view in which the other object has no outline
    outline_kernels.match_outlines(points, np.array([0, 2, 3]), others, np.array([0, 2, 2]), 0.3, chosen)
    np.testing.assert_array_equal(chosen, [0, 1, -1])


@pytest.mark.parametrize("view", range(7))
def test_outline_pairs_pull_within_the_plane_of_their_view_only(view):
    frame = PASS_FRAMES[view]
    places, others = np.array([[0.3], [0.1], [0.0], [0.0]]), np.array([[0.0], [0.0], [1.0], [0.0]])
    row, views = np.zeros(1, dtype=np.int64), np.array([view])

    def pulled(spacing: float, own: int = 0) -> tuple[np.ndarray, np.ndarray]:
        metrics, forces = np.zeros((1, 3, 3)), np.zeros((1, 3))
        outline_kernels.add_outline_pairs(
            row, places, np.array([own]), others, views, PASS_FRAMES, spacing, 1e6, 2.0, metrics, forces
        )
        return metrics[0], forces[0]

    metric, force = pulled(0.0)
    np.testing.assert_allclose(force, 2.0 * (0.3 * frame[0] + 0.1 * frame[1]), atol=1e-9)
    np.testing.assert_allclose(metric, 2.0 * (np.eye(3) - np.outer(frame[2], frame[2])), atol=1e-9)
    np.testing.assert_allclose(pulled(0.2)[1], 0.6 * frame[0], atol=1e-9)  # moves along it count beyond the spacing
    assert not pulled(0.0, own=-1)[0].any()  # nothing to be matched with


def test_what_is_too_large_is_pulled_inward_and_a_perfect_fit_hardly_at_all():
    mesh = simple_shapes.goblet()
    target = target_of(mesh, SIZE)
    strengths = []
    for scale in (1.0, 1.2):
        points = scale * mesh.vertices
        pulls = target.outline.pulls(target.traced(points, mesh.faces)[1], 500, 1.0, 0.5)
        places = np.einsum("nk,nkd->nd", pulls.weights, points[mesh.faces[pulls.faces]])
        strengths.append(float((places * pulls.forces).sum()))  # the gradient by the logarithm of the scale
    assert strengths[1] > 0.02
    assert abs(strengths[0]) < 0.05 * strengths[1]


def test_what_is_out_of_sight_or_too_small_is_not_pulled():
    mesh = simple_shapes.goblet()
    target = target_of(mesh, SIZE)
    for vertices in (mesh.vertices + np.array((10.0, -7.0, 3.0)), 1e-4 * mesh.vertices):
        trace = target.traced(vertices, mesh.faces)[1]
        assert target.outline.pulls(trace, 500, 1.0, 0.5) is None
