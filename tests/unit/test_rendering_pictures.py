"""Pictures for people, and the views that things are seen from."""

import numpy as np
import pytest
import simple_shapes
from scipy.spatial.transform import Rotation

from shapewright.errors import RenderingError
from shapewright.rendering import (
    compose_side_by_side,
    even_views,
    random_views,
    render_mesh,
    three_quarter_view,
)
from shapewright.rendering.smoothing import corner_normals


def covered(picture: np.ndarray) -> np.ndarray:
    return np.abs(picture.astype(int) - picture[0, 0]).max(axis=2) > 12


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_a_mesh_fills_its_picture_whole(scale):
    mesh = simple_shapes.goblet().transformed(np.eye(3), np.array([5.0, -3.0, 8.0]) * scale, scale)
    rows, columns = np.nonzero(covered(render_mesh(mesh, size=200)))
    assert min(rows.min(), columns.min()) >= 5
    assert max(rows.max(), columns.max()) <= 194
    assert max(np.ptp(rows), np.ptp(columns)) > 170


def test_light_comes_from_above_and_colour_is_kept():
    ball = simple_shapes.lathe([(np.sin(a), np.cos(a)) for a in np.linspace(0.01, np.pi - 0.01, 24)])
    picture = render_mesh(ball, rotation=np.eye(3), size=128, color=(0.8, 0.2, 0.2)).astype(float)
    assert picture[35, 55].sum() > 1.3 * picture[100, 75].sum()
    assert picture[35, 55, 0] > 2 * picture[35, 55, 2]


def test_smooth_normals_need_neither_shared_vertices_nor_winding():
    ball = simple_shapes.lathe([(np.sin(a), np.cos(a)) for a in np.linspace(0.2, np.pi - 0.2, 24)])
    soup = simple_shapes.flipped(ball, 0.5)
    soup = type(soup)(soup.triangles.reshape(-1, 3), np.arange(3 * len(soup.faces)).reshape(-1, 3))
    inner = np.abs(soup.triangles[:, :, 1]) < 0.8
    cosine = np.abs(np.einsum("fcd,fcd->fc", corner_normals(soup), soup.triangles))[inner]
    assert cosine.min() > 0.99, "the normal of a ball is its radius"


def test_a_box_keeps_its_edges():
    mesh = simple_shapes.box()
    flat = np.abs(np.einsum("fcd,fd->fc", corner_normals(mesh), mesh.face_normals))
    assert np.allclose(flat, 1.0, atol=1e-6)


def test_overlay_shows_agreement_and_difference():
    query = simple_shapes.box()
    same = compose_side_by_side(query, query, rotation=np.eye(3), size=90)
    assert same.shape == (90, 270, 3)
    blue, orange, both = same[45, 45].astype(int), same[45, 135].astype(int), same[45, 225].astype(int)
    assert blue[2] > blue[0] + 60
    assert orange[0] > orange[2] + 60
    assert np.ptp(both) < 60
    moved = query.transformed(np.eye(3), np.array([0.5, 0.0, 0.0]), 1.0)
    apart = compose_side_by_side(query, moved, rotation=np.eye(3), size=90).astype(int)
    only_query, only_fitted = apart[45, 180 + 12], apart[45, 180 + 77]
    assert only_query[2] > only_query[0] + 30
    assert only_fitted[0] > only_fitted[2] + 30


def test_pictures_have_pixels():
    with pytest.raises(RenderingError):
        render_mesh(simple_shapes.box(), size=0)


def test_random_views_are_uniform_rotations():
    rotations, scales = random_views(np.random.default_rng(0), 4000)
    assert np.allclose(rotations @ rotations.transpose(0, 2, 1), np.eye(3), atol=1e-9)
    assert np.allclose(np.linalg.det(rotations), 1.0)
    assert np.abs(rotations.mean(axis=0)).max() < 0.04, "every direction is as likely as its opposite"
    assert np.abs((rotations**2).mean(axis=0) - 1 / 3).max() < 0.03
    assert scales.min() >= 0.8
    assert scales.max() <= 2.0
    assert abs(scales.mean() - 1.4) < 0.02


def test_random_views_come_from_the_generator_alone():
    a, b = (random_views(np.random.default_rng(7), 5) for _ in range(2))
    assert np.array_equal(a[0], b[0])
    assert np.array_equal(a[1], b[1])


def test_even_views_surround_the_object_upright():
    views = even_views(30)
    assert np.allclose(views @ views.transpose(0, 2, 1), np.eye(3), atol=1e-12)
    assert np.allclose(np.linalg.det(views), 1.0)
    directions = views[:, 2]
    nearest = np.sort(np.arccos(np.clip(directions @ directions.T, -1, 1)), axis=1)[:, 1]
    assert nearest.min() > 0.5 * nearest.max()
    assert (views[:, 1, 1] >= -1e-9).all(), "up is not down"
    assert even_views(0).shape == (0, 3, 3)


def test_the_view_for_people_looks_from_above():
    for up, axis in (("y", [0, 1, 0]), ("z", [0, 0, 1])):
        seen = three_quarter_view(up) @ axis
        assert seen[1] > 0.8, "up is up in the picture"
        assert seen[2] > 0.2, "the top is turned towards the camera"
    assert np.isclose(np.linalg.det(three_quarter_view()), 1.0)
    assert Rotation.from_matrix(three_quarter_view("z")).magnitude() > 0
