"""Laws of the corruptions, over every one and over each alone."""

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree
from simple_shapes import box, crossing_sheets, goblet, joined, stool

from shapewright.distances.rasterize import depth_views
from shapewright.distances.surface import uniform_points
from shapewright.errors import EvaluationError, MeshError
from shapewright.evaluation.corruptions import CORRUPTIONS, Corruption
from shapewright.evaluation.corruptions.corruption import diagonal
from shapewright.evaluation.corruptions.holes import RADII
from shapewright.evaluation.corruptions.noise import LONGEST_EDGE
from shapewright.evaluation.corruptions.outliers import MARGIN, SIZE
from shapewright.evaluation.corruptions.uneven import MOST_FACES, SHARE
from shapewright.evaluation.depth_scans import STEEPEST
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges

SHAPES = {
    "box": box((3.0, 1.0, 0.4), (5.0, -2.0, 1.0)),
    "goblet": goblet(),
    "stool": stool(),
    "soup": crossing_sheets(),
}
NOISE, HOLES, DECIMATED, HALF = (CORRUPTIONS[name] for name in ("noise", "holes", "decimated", "half"))
FLIPPED, CLUSTERED, UNEVEN, POINTS = (CORRUPTIONS[name] for name in ("flipped", "clustered", "uneven", "points"))
OUTLIERS, DUST, GROUND = (CORRUPTIONS[name] for name in ("outliers", "dust", "ground"))
STITCHED, CLOSED, VOXELS = (CORRUPTIONS[name] for name in ("stitched", "closed", "voxels"))
ADDING = (OUTLIERS, DUST, GROUND)


def sphere(radius: float = 1.0) -> TriangleMesh:
    fine = cut_edges(box(), 0.1)
    return TriangleMesh(radius * fine.vertices / np.linalg.norm(fine.vertices, axis=1)[:, None], fine.faces).cleaned()


def corrupted(corruption: Corruption, mesh: TriangleMesh, strength: float | None = None, seed: int = 0):
    return corruption(mesh, strength, np.random.default_rng(seed))


def arrays(outcome: TriangleMesh | PointCloud) -> list[np.ndarray]:
    return [outcome.points] if isinstance(outcome, PointCloud) else [outcome.vertices, outcome.faces]


def scattered(outcome: TriangleMesh | PointCloud, count: int, seed: int) -> np.ndarray:
    if isinstance(outcome, PointCloud):
        return outcome.points
    return uniform_points(outcome, count, rng=np.random.default_rng(seed))


def farthest(start: TriangleMesh, end: TriangleMesh, quantile: float = 1.0) -> float:
    """Return the distance from a surface to another, as a share of the diagonal of the second."""
    tree = cKDTree(scattered(end, 40_000, 1))
    return float(np.quantile(tree.query(scattered(start, 2000, 2))[0], quantile)) / diagonal(end)


def volume(mesh: TriangleMesh) -> float:
    a, b, c = mesh.triangles.transpose(1, 0, 2)
    return float((a * np.cross(b, c)).sum()) / 6.0


def euler_number(mesh: TriangleMesh) -> int:
    edges = np.unique(np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    return len(mesh.vertices) - len(edges) + len(mesh.faces)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("name", CORRUPTIONS)
def test_a_seed_gives_one_outcome_near_the_shape_and_leaves_the_original_alone(name: str, shape: str) -> None:
    corruption, mesh = CORRUPTIONS[name], SHAPES[shape]
    vertices, faces = mesh.vertices.copy(), mesh.faces.copy()
    first, second = corrupted(corruption, mesh), corrupted(corruption, mesh)
    assert corruption.has_faces == isinstance(first, TriangleMesh)
    for one, other in zip(arrays(first), arrays(second), strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(mesh.vertices, vertices)
    np.testing.assert_array_equal(mesh.faces, faces)
    if name != "decimated":  # which has nothing random
        others = arrays(corrupted(corruption, mesh, seed=1))
        assert any(not np.array_equal(one, other) for one, other in zip(arrays(first), others, strict=True))
    if corruption in ADDING:
        original = mesh.cleaned()
        np.testing.assert_array_equal(first.vertices[: len(original.vertices)], original.vertices)
        np.testing.assert_array_equal(first.faces[: len(original.faces)], original.faces)
    else:
        away = cKDTree(scattered(mesh, 4000, 2)).query(scattered(first, 500, 3))[0]
        assert np.median(away) < 0.03 * diagonal(mesh)


@pytest.mark.parametrize("name", CORRUPTIONS)
def test_each_has_three_strengths_in_its_range_and_refuses_what_is_outside(name: str) -> None:
    corruption = CORRUPTIONS[name]
    assert corruption.name == name
    mild, middle, strong = corruption.strengths
    assert mild < middle < strong or mild > middle > strong
    assert corruption.default == middle
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
    np.testing.assert_allclose(scaled.bounds / factor - 1.0, plain.bounds, atol=0.01)
    if CORRUPTIONS[name].has_faces:
        assert scaled.area / factor**2 == pytest.approx(plain.area, rel=0.02)


@pytest.mark.parametrize("name", CORRUPTIONS)
def test_what_has_no_area_is_refused(name: str) -> None:
    faces = np.array([[0, 1, 2], [1, 2, 3]])
    for end in (0.0, 1.0):
        line = TriangleMesh(np.linspace(0.0, end, 4)[:, None] * np.array([1.0, 2.0, 3.0]), faces)
        with pytest.raises(MeshError):
            corrupted(CORRUPTIONS[name], line)


@pytest.mark.parametrize("name", CORRUPTIONS)
def test_soup_with_faces_without_area_is_taken_at_every_strength(name: str) -> None:
    rng = np.random.default_rng(0)
    corners = rng.random((60, 1, 3)) + rng.normal(0.0, 0.2, (60, 3, 3))
    corners[:20, 2] = corners[:20, 1]
    soup = TriangleMesh(corners.reshape(-1, 3), np.arange(180).reshape(-1, 3))
    for strength in (*CORRUPTIONS[name].strengths, CORRUPTIONS[name].least, CORRUPTIONS[name].most):
        try:
            outcome = corrupted(CORRUPTIONS[name], soup, strength)
        except MeshError:
            assert strength not in CORRUPTIONS[name].strengths
        else:
            assert np.isfinite(arrays(outcome)[0]).all()


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


@pytest.mark.parametrize("strength", FLIPPED.strengths)
def test_flipped_turns_the_share_of_faces_and_moves_nothing(strength: float) -> None:
    ball = sphere()
    turned = corrupted(FLIPPED, ball, strength)
    np.testing.assert_array_equal(turned.vertices, ball.vertices)
    cosines = (turned.face_normals * ball.face_normals).sum(axis=1)
    np.testing.assert_allclose(np.abs(cosines), 1.0)
    assert (cosines < 0).sum() == round(strength * len(ball.faces))


@pytest.mark.parametrize("strength", CLUSTERED.strengths)
def test_clustered_vertices_lie_on_a_grid_near_where_they_were(strength: float) -> None:
    ball = sphere()
    merged = corrupted(CLUSTERED, ball, strength)
    side = 2.0 / strength
    cells = (merged.vertices - merged.vertices[0]) / side
    np.testing.assert_allclose(cells, np.rint(cells), atol=1e-6)
    assert len(np.unique(np.rint(cells), axis=0)) == len(merged.vertices)
    away = cKDTree(ball.vertices).query(merged.vertices)[0]
    assert away.max() <= 0.5 * np.sqrt(3.0) * side
    assert len(np.unique(np.sort(merged.faces, axis=1), axis=0)) == len(merged.faces)
    assert len(merged.faces) < len(ball.faces)


def test_clustering_makes_one_sheet_of_a_thin_plate() -> None:
    plate = cut_edges(box((1.0, 1.0, 0.001)), 0.05)
    assert corrupted(CLUSTERED, plate, 24.0).area == pytest.approx(1.0, rel=0.2)


@pytest.mark.parametrize("strength", OUTLIERS.strengths)
def test_outliers_are_small_and_all_about_the_object(strength: float) -> None:
    mesh = SHAPES["goblet"].cleaned()
    debris = corrupted(OUTLIERS, mesh, strength).triangles[len(mesh.faces) :]
    length = diagonal(mesh)
    assert len(debris) == strength
    assert np.ptp(debris, axis=1).max() <= SIZE * length
    low, high = mesh.bounds
    reach = (MARGIN + 0.5 * SIZE) * length
    assert (debris >= low - reach).all()
    assert (debris <= high + reach).all()
    places = (debris.mean(axis=1) - low + MARGIN * length) / (high - low + 2 * MARGIN * length)
    np.testing.assert_allclose(places.mean(axis=0), 0.5, atol=1.5 / np.sqrt(strength))


@pytest.mark.parametrize("strength", DUST.strengths)
def test_dust_lies_outside_the_box_and_as_far_as_asked_for(strength: float) -> None:
    mesh = SHAPES["stool"].cleaned()
    low, high = mesh.bounds
    counts = set()
    for seed in range(20):
        dusty = corrupted(DUST, mesh, strength, seed)
        clumps = dusty.triangles[len(mesh.faces) :]
        gaps = np.maximum(low - clumps, clumps - high).max(axis=2).min(axis=1)  # of each face from the box
        assert (gaps > 0.0).all()
        size = dusty.vertices[len(mesh.vertices) :]
        apart = cKDTree(size).query_pairs(0.05 * diagonal(mesh), output_type="ndarray")
        assert len(apart) > 0
        counts.add(len(clumps))
        first = clumps[: min(len(clumps), 76)].reshape(-1, 3)  # a hull of 40 points of a ball has 76 triangles
        gap = np.maximum(low - first, first - high).max(axis=1).min()
        assert gap == pytest.approx(strength * diagonal(mesh))
    assert counts == {76, 152, 228}


@pytest.mark.parametrize("strength", GROUND.strengths)
def test_ground_is_a_square_at_a_side_of_the_box(strength: float) -> None:
    mesh = SHAPES["box"].cleaned()
    low, high = mesh.bounds
    sides = set()
    for seed in range(40):
        sheet = corrupted(GROUND, mesh, strength, seed).triangles[len(mesh.faces) :].reshape(-1, 3)
        axis = int(np.ptp(sheet, axis=0).argmin())
        assert np.ptp(sheet[:, axis]) == 0.0
        assert sheet[0, axis] in (low[axis], high[axis])
        sides.add((axis, sheet[0, axis] == high[axis]))
        corners = sheet[np.linalg.norm(sheet - sheet.mean(axis=0), axis=1).argmax()] - sheet.mean(axis=0)
        assert np.linalg.norm(corners) == pytest.approx(0.5 * np.sqrt(2.0) * strength * 3.0, rel=1e-6)
        np.testing.assert_allclose(np.delete(sheet.mean(axis=0) - (low + high) / 2, axis), 0.0, atol=1e-9)
    assert len(sides) == 6


def test_ground_has_the_area_that_is_asked_for() -> None:
    mesh = SHAPES["box"].cleaned()
    assert corrupted(GROUND, mesh, 2.0).area - mesh.area == pytest.approx(36.0)


@pytest.mark.parametrize("shape", ["stool", "goblet"])
def test_stitched_scans_cover_the_surface_and_are_off_by_no_more_than_asked_for(shape: str) -> None:
    mesh = SHAPES[shape]
    still = corrupted(STITCHED, mesh, 0.0)
    assert farthest(still, mesh) < 0.01
    assert farthest(mesh, still, 0.95) < 0.02
    assert still.area > 1.2 * mesh.area  # views overlap, and the sheet of the goblet is seen from two sides
    before = farthest(still, mesh, 0.9)
    for strength in STITCHED.strengths:
        off = corrupted(STITCHED, mesh, strength)
        assert farthest(off, mesh) < 2.0 * strength + 0.01
        assert farthest(off, mesh, 0.9) > before
        before = farthest(off, mesh, 0.9)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("strength", CLOSED.strengths)
def test_closed_surfaces_are_watertight_and_about_a_voxel_outside(shape: str, strength: float) -> None:
    mesh = SHAPES[shape]
    skin = corrupted(CLOSED, mesh, strength)
    voxel = float(np.ptp(mesh.bounds, axis=0).max()) / strength / diagonal(mesh)
    assert volume(skin) > 0.0
    assert farthest(mesh, skin, 0.9) < 2.5 * voxel + 0.01  # the rest is enclosed, such as the ends of the stool's legs
    sides = np.sort(skin.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(sides, axis=0, return_counts=True)[1] % 2 == 0).all()


def test_closing_fills_small_holes_and_melts_what_is_inside() -> None:
    ball = sphere()
    pole = ball.triangles.mean(axis=1)[:, 2] > 0.999
    open_ball = joined([TriangleMesh(ball.vertices, ball.faces[~pole]), box((0.3, 0.3, 0.3))])
    skin = corrupted(CLOSED, open_ball, 40.0)
    assert skin.is_watertight
    assert euler_number(skin) == 2
    assert volume(skin) == pytest.approx(4.0 / 3.0 * np.pi * 1.04**3, rel=0.05)


@pytest.mark.parametrize("strength", VOXELS.strengths)
def test_voxels_are_closed_steps_along_the_axes(strength: float) -> None:
    ball = sphere()
    steps = corrupted(VOXELS, ball, strength)
    side = 2.0 / strength
    np.testing.assert_allclose(np.sort(np.abs(steps.face_normals), axis=1), [[0.0, 0.0, 1.0]] * len(steps.faces))
    np.testing.assert_allclose(steps.face_areas, 0.5 * side**2)
    cells = (steps.vertices - steps.vertices[0]) / side
    np.testing.assert_allclose(cells, np.rint(cells), atol=1e-6)
    sides = np.sort(steps.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(sides, axis=0, return_counts=True)[1] % 2 == 0).all()
    radii = np.linalg.norm(steps.vertices, axis=1)
    assert radii.min() > 1.0 - 2.0 * side  # it has no inner wall
    assert radii.max() < 1.0 + np.sqrt(3.0) * side
    assert 4.0 / 3.0 * np.pi < volume(steps) < 4.0 / 3.0 * np.pi * (1.0 + 2.0 * side) ** 3


@pytest.mark.parametrize("strength", UNEVEN.strengths)
def test_uneven_crowds_vertices_on_a_part_and_keeps_the_surface(strength: float) -> None:
    mesh = box()
    even, uneven = corrupted(UNEVEN, mesh, 1.0), corrupted(UNEVEN, mesh, strength)
    assert uneven.area == pytest.approx(mesh.area)
    assert uneven.is_watertight
    np.testing.assert_allclose(np.abs(uneven.vertices).max(axis=1), 0.5)
    added = len(uneven.vertices) / len(even.vertices)
    assert added == pytest.approx(1.0 + SHARE * (strength - 1.0), rel=0.15)
    assert np.linalg.norm(uneven.vertex_mean) > np.linalg.norm(even.vertex_mean) + 0.05
    assert np.linalg.norm(uneven.centroid) < 1e-6


def test_uneven_makes_many_faces_fewer_first() -> None:
    ball = TriangleMesh.from_trimesh(trimesh.creation.icosphere(5))
    assert len(ball.faces) > 3 * MOST_FACES
    crowded = corrupted(UNEVEN, ball, 4.0)
    assert farthest(crowded, ball) < 0.01
    assert np.linalg.norm(crowded.vertex_mean) > 0.2
    dense = crowded.vertices @ crowded.vertex_mean > 0
    assert dense.mean() > 0.6


@pytest.mark.parametrize("strength", POINTS.strengths)
def test_points_lie_all_over_the_surface(strength: float) -> None:
    mesh = box()
    cloud = corrupted(POINTS, mesh, strength)
    assert cloud.points.shape == (strength, 3)
    np.testing.assert_allclose(np.abs(cloud.points).max(axis=1), 0.5)
    on_sides = (np.abs(np.abs(cloud.points) - 0.5) < 1e-12).mean(axis=0)
    np.testing.assert_allclose(on_sides, 1.0 / 3.0, atol=0.06)


def test_a_summary_says_what_the_strength_means() -> None:
    assert HOLES.summary == "holes: share of the area that is missing (0.1, 0.2, 0.4)"
