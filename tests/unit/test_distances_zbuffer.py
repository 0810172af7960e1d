"""The 14 depth views and the z-buffer distance (Algorithm 1)."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from shapewright.distances.rasterize import PASS_DIRECTIONS, PASS_FRAMES, depth_views
from shapewright.distances.zbuffer import ZBufferTarget, zbuffer_distance
from shapewright.errors import ShapewrightError

SIZE = 32
SUBPIXEL = 4.0 / SIZE / 4096  # vertices are snapped to this grid

soups = arrays(
    np.float64,
    st.tuples(st.integers(1, 5), st.just(3), st.just(3)),
    elements=st.floats(-1.125, 1.125, allow_nan=False, width=32),
)


def box(x: float, y: float, z: float) -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.box((x, y, z))
    return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)


def of_soup(soup: np.ndarray, size: int = SIZE) -> np.ndarray:
    return depth_views(soup.reshape(-1, 3), np.arange(3 * len(soup)).reshape(-1, 3), size)


def pixel_centres(size: int) -> np.ndarray:
    return (np.arange(size) + 0.5) / size * 4.0 - 2.0


def ray_cast(soup: np.ndarray, frame: np.ndarray) -> tuple[np.ndarray, ...]:
    """Nearest and farthest hit of each pixel's ray with the triangles' planes, its error, and the doubtful pixels."""
    x, y = np.meshgrid(pixel_centres(SIZE), pixel_centres(SIZE))
    near, far = np.full(x.shape, np.inf), np.full(x.shape, -np.inf)
    error, doubtful = np.full(x.shape, 1e-6), np.zeros(x.shape, dtype=bool)
    for corners in soup:
        u, v, depth = frame @ corners.T
        area = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0])
        distances = []
        for a, b in ((0, 1), (1, 2), (2, 0)):
            length = max(np.hypot(u[b] - u[a], v[b] - v[a]), 1e-12)
            cross = (u[b] - u[a]) * (y - v[a]) - (v[b] - v[a]) * (x - u[a])
            distances.append(np.sign(area) * cross / length)
        margin = np.min(distances, axis=0)
        thin = abs(area) < 0.02  # the plane of a sliver is too steep to predict the depth of a snapped one
        close_to_corner = np.min(np.hypot(x[..., None] - u, y[..., None] - v), axis=-1) < 4 * SUBPIXEL
        inside_frame = (x > u.min() - SUBPIXEL) & (x < u.max() + SUBPIXEL)
        inside_frame &= (y > v.min() - SUBPIXEL) & (y < v.max() + SUBPIXEL)
        doubtful |= inside_frame & (thin | (np.abs(margin) < 4 * SUBPIXEL) | close_to_corner)
        if thin:
            continue
        slope = np.linalg.solve([[u[1] - u[0], v[1] - v[0]], [u[2] - u[0], v[2] - v[0]]], depth[1:] - depth[0])
        z = depth[0] + slope[0] * (x - u[0]) + slope[1] * (y - v[0])
        hit = margin > 0
        near[hit], far[hit] = np.minimum(near, z)[hit], np.maximum(far, z)[hit]
        error[hit] = np.maximum(error, 10 * SUBPIXEL * (1 + np.abs(slope).sum()) ** 2)[hit]
    return near, far, error, doubtful


@settings(max_examples=60, deadline=None)
@given(soups)
def test_pixels_are_what_rays_through_their_centres_hit(soup: np.ndarray) -> None:
    views = of_soup(soup).astype(np.float64)
    for k, frame in enumerate(PASS_FRAMES):
        near, far, error, doubtful = ray_cast(soup, frame)
        covered = np.isfinite(near)
        np.testing.assert_array_equal(np.isfinite(views[2 * k])[~doubtful], covered[~doubtful])
        sure = covered & ~doubtful
        assert (np.abs(views[2 * k][sure] - near[sure]) <= error[sure]).all()
        assert (np.abs(-views[2 * k + 1][sure] - far[sure]) <= error[sure]).all()


@settings(max_examples=40, deadline=None)
@given(soups)
def test_opposite_views_share_silhouettes_and_order_their_layers(soup: np.ndarray) -> None:
    views = of_soup(soup)
    front, back = views[::2], views[1::2]
    np.testing.assert_array_equal(np.isfinite(front), np.isfinite(back))
    covered = np.isfinite(front)
    assert (front[covered] <= -back[covered]).all()


@settings(max_examples=40, deadline=None)
@given(soups, st.randoms(use_true_random=False))
def test_winding_and_order_of_triangles_play_no_part(soup: np.ndarray, random) -> None:
    turned = soup[random.sample(range(len(soup)), len(soup))][:, ::-1]
    np.testing.assert_allclose(of_soup(turned), of_soup(soup), atol=2e-6)


@settings(max_examples=40, deadline=None)
@given(soups)
def test_distance_to_itself_is_zero_and_the_fused_kernel_agrees(soup: np.ndarray) -> None:
    points, triangles = soup.reshape(-1, 3), np.arange(3 * len(soup)).reshape(-1, 3)
    target = ZBufferTarget(points, triangles, SIZE)
    assert target.distance(points, triangles).raw == 0.0
    moved = points * 0.9 + [0.1, 0.0, -0.2]
    fused = target.distance(moved, triangles)
    plain = zbuffer_distance(target.views, depth_views(moved, triangles, SIZE))
    assert fused.raw == pytest.approx(plain.raw, rel=1e-12)
    assert fused.normalized == pytest.approx(plain.normalized, rel=1e-12)


def test_the_14_views_look_along_the_axes_and_from_the_corners_of_a_cube() -> None:
    directions = np.stack([PASS_DIRECTIONS, -PASS_DIRECTIONS], axis=1).reshape(14, 3)
    axes = {tuple(row) for row in (directions[:6] + 0.0).tolist()}
    assert axes == {tuple(row) for row in (np.concatenate([np.eye(3), -np.eye(3)]) + 0.0).tolist()}
    np.testing.assert_allclose(np.abs(directions[6:]), 1 / np.sqrt(3))
    assert len({tuple(row) for row in np.sign(directions[6:])}) == 8
    for frame in PASS_FRAMES:
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-15)
        assert np.linalg.det(frame) == pytest.approx(1)


def test_a_box_has_the_depths_of_its_sides() -> None:
    views = depth_views(*box(1.0, 1.5, 0.5), 256)
    for axis, half in enumerate((0.5, 0.75, 0.25)):
        for view in (views[2 * axis], views[2 * axis + 1]):
            assert np.unique(view[np.isfinite(view)]) == pytest.approx([-half])
    assert np.isfinite(views[0]).sum() == 96 * 32  # 1.5 by 0.5 at 64 pixels a unit
    assert np.isfinite(views[4]).sum() == 64 * 96


def test_no_cracks_between_triangles_that_share_edges() -> None:
    rng = np.random.default_rng(3)
    sphere = trimesh.creation.icosphere(3)
    points = np.array(sphere.vertices) @ np.linalg.qr(rng.normal(size=(3, 3)))[0] * 1.3
    views = depth_views(points, np.array(sphere.faces), 256)
    for view in views:
        covered = np.isfinite(view)
        for row in covered[covered.any(axis=1)]:
            columns = np.flatnonzero(row)
            assert len(columns) == columns[-1] - columns[0] + 1


def test_a_fan_around_a_pixel_centre_leaves_no_hole() -> None:
    centre = pixel_centres(256)[130]
    angles = np.linspace(0, 2 * np.pi, 14)[:-1] + 0.1
    ring = np.stack([centre + 0.3 * np.cos(angles), centre + 0.3 * np.sin(angles), 0 * angles], axis=1)
    points = np.concatenate([[[centre, centre, 0.0]], ring])
    fan = np.array([[0, 1 + k, 1 + (k + 1) % 13] for k in range(13)])
    view = depth_views(points, fan, 256)[4]
    assert np.isfinite(view[120:141, 120:141]).all()


def test_undersizing_costs_twice_what_oversizing_does() -> None:
    large, small = box(1.5, 1.5, 1.5), box(1.0, 1.0, 1.0)
    undersized = ZBufferTarget(*large).distance(*small)
    oversized = ZBufferTarget(*small).distance(*large)
    assert undersized.raw > 1.3 * oversized.raw
    a, b = depth_views(*large), depth_views(*small)
    only_large = int((np.isfinite(a) & ~np.isfinite(b)).sum())
    assert undersized.raw - oversized.raw == pytest.approx(only_large)  # the depths they share cost the same


def test_normalized_figures_at_the_ends() -> None:
    here, triangles = box(0.5, 0.5, 0.5)
    there = here + np.array([1.5, 1.5, 0.0])  # apart in every view but those along x + y and x and y themselves
    outside = here + 10.0
    target = ZBufferTarget(here, triangles)
    assert target.distance(outside, triangles).normalized == 2.0
    nothing = ZBufferTarget(outside, triangles)
    assert nothing.distance(here, triangles).normalized == 1.0
    assert nothing.distance(outside, triangles).normalized == 0.0
    assert 1.0 < target.distance(there, triangles).normalized < 2.0


def test_a_growing_generated_object_gets_better_until_it_fits() -> None:
    points, triangles = box(1.4, 1.0, 0.8)
    target = ZBufferTarget(points, triangles)
    distances = [target.distance(points * f, triangles).normalized for f in (0.5, 0.7, 0.9, 1.0, 1.2, 1.5)]
    assert distances[:4] == sorted(distances[:4], reverse=True)
    assert distances[3] == 0.0
    assert distances[3:] == sorted(distances[3:])


def test_sheets_seen_edge_on_and_fragments_outside_the_window() -> None:
    sheet = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=np.float64)
    halves = np.array([[0, 1, 2], [0, 2, 3]])
    views = depth_views(sheet, halves)
    assert not np.isfinite(views[:4]).any()
    assert all(np.isfinite(view).any() for view in views[4:])
    assert not np.isfinite(depth_views(sheet + np.array([0, 0, 2.1]), halves)[4:6]).any()
    huge = depth_views(sheet * 1e6, halves)
    assert np.isfinite(huge[4]).all()


def test_refuses_what_does_not_fit() -> None:
    points, triangles = box(1, 1, 1)
    with pytest.raises(ShapewrightError, match="even"):
        depth_views(points, triangles, 33)
    with pytest.raises(ShapewrightError, match="shape"):
        zbuffer_distance(depth_views(points, triangles, 32), depth_views(points, triangles, 16))
