"""The kernels of the fast estimator compute what plain NumPy, or the geometry itself, says."""

import numpy as np
import pytest
import simple_shapes
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse
from scipy.spatial.transform import Rotation

from shapewright.distances.alignment import rotations_24
from shapewright.estimation import sampling_kernels
from shapewright.estimation.fast import matching_kernels, pose_kernels, system_kernels
from shapewright.estimation.fast.sparse_rows import SparseRows
from shapewright.mesh import TriangleMesh

SEEDS = st.integers(0, 2**32 - 1)


def sampled(mesh: TriangleMesh, count: int, first_share: float = 0.5):
    return sampling_kernels.sample_surface(mesh.vertices, mesh.faces, count, first_share)


# ---------------------------------------------------------------------- samples of a surface


@settings(max_examples=30, deadline=None)
@given(seed=SEEDS, share=st.floats(0.0, 1.0, exclude_max=True), count=st.integers(1, 500))
def test_samples_lie_on_their_triangles_each_of_which_has_its_share_of_area(seed, share, count):
    rng = np.random.default_rng(seed)
    n_triangles = int(rng.integers(1, 30))
    soup = rng.normal(size=(3 * n_triangles, 3)) * rng.choice([0.01, 1.0], (3 * n_triangles, 1))
    mesh = TriangleMesh(soup, np.arange(3 * n_triangles).reshape(-1, 3))
    chosen, weights, normals = sampled(mesh, count, share)
    assert (len(chosen), weights.shape, normals.shape) == (count, (count, 3), (count, 3))
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-12)
    assert weights.min() >= 0
    np.testing.assert_allclose(normals, mesh.face_normals[chosen], atol=1e-9)
    expected = count * mesh.face_areas / mesh.area
    assert np.abs(np.bincount(chosen, minlength=n_triangles) - expected).max() <= 1.0 + 1e-6
    points = np.empty((count, 3))
    sampling_kernels.place_samples(mesh.vertices, mesh.faces, chosen, weights, points)
    np.testing.assert_allclose(points, np.einsum("nk,nkd->nd", weights, mesh.triangles[chosen]), atol=1e-12)


def test_samples_of_one_triangle_are_spread_evenly_in_it():
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    points = np.empty((2000, 3))
    chosen, weights, _ = sampled(mesh, 2000)
    sampling_kernels.place_samples(mesh.vertices, mesh.faces, chosen, weights, points)
    quarters = np.array(
        [
            (points[:, 0] > 0.5).sum(),
            (points[:, 1] > 0.5).sum(),
            (points[:, :2].sum(axis=1) < 0.5).sum(),
        ]
    )
    np.testing.assert_allclose(quarters / 2000, 0.25, atol=0.01)


def test_triangles_without_area_get_no_samples_and_a_surface_without_area_has_none():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]])
    mesh = TriangleMesh(corners, np.array([[0, 0, 1], [0, 1, 2], [0, 1, 3]]))
    chosen, _, normals = sampled(mesh, 50)
    assert set(chosen.tolist()) == {1}
    assert np.isfinite(normals).all()
    lines = TriangleMesh(corners, np.array([[0, 0, 1], [0, 1, 3]]))
    assert [len(part) for part in sampled(lines, 50)] == [0, 0, 0]


# ---------------------------------------------------------------------- poses


@pytest.fixture(scope="module")
def lopsided() -> np.ndarray:
    """Points on a shape that only one rotation takes onto itself."""
    rng = np.random.default_rng(3)
    arms = [(3.0, 0, 0), (0, 2.0, 0), (0, 0, 1.2), (1.0, 1.0, 0.2)]
    return np.concatenate([rng.random((40, 1)) * np.array(arm) + 0.03 * rng.normal(size=(40, 3)) for arm in arms])


@pytest.mark.parametrize("number", [0, 5, 17])
def test_the_true_rotation_scores_best(lopsided, number):
    rotations = rotations_24()
    query = lopsided @ rotations[number].T
    scores = np.empty(24, dtype=np.float32)
    pose_kernels.score_rotations(
        np.ascontiguousarray(query.T, dtype=np.float32),
        lopsided.astype(np.float32),
        np.ascontiguousarray(rotations, dtype=np.float32),
        scores,
    )
    assert int(scores.argmin()) == number
    assert scores[number] < 1e-3
    assert np.sort(scores)[1] > 0.1


def test_a_score_is_the_mean_distance_both_ways(lopsided):
    query, model = lopsided[:70] + 0.1, lopsided[50:]
    rotation = Rotation.from_rotvec([0.3, -0.2, 0.5]).as_matrix()
    scores = np.empty(1, dtype=np.float32)
    pose_kernels.score_rotations(
        np.ascontiguousarray(query.T, dtype=np.float32),
        model.astype(np.float32),
        rotation[None].astype(np.float32),
        scores,
    )
    distances = np.linalg.norm(query[:, None] - (model @ rotation.T)[None], axis=2)
    assert scores[0] == pytest.approx(distances.min(axis=0).mean() + distances.min(axis=1).mean(), rel=1e-4)


@pytest.mark.parametrize("keeps_rotation", [False, True])
@pytest.mark.parametrize("keeps_scale", [False, True])
def test_closest_points_recover_a_similarity(lopsided, keeps_scale, keeps_rotation):
    true = Rotation.from_rotvec([0.5, -1.0, 2.0]).as_matrix()
    scale, translation = 1.7, np.array([3.0, -2.0, 0.5])
    query = scale * lopsided @ true.T + translation
    rotation, shift, found_scale, mean = pose_kernels.align_by_closest_points(
        query,
        lopsided,
        true if keeps_rotation else np.ascontiguousarray(Rotation.from_rotvec([0.05, 0.04, -0.06]).as_matrix() @ true),
        translation + 0.1,
        scale if keeps_scale else 1.6,
        60,
        keeps_scale,
        keeps_rotation,
    )
    np.testing.assert_allclose(rotation, true, atol=0.0 if keeps_rotation else 1e-6)
    np.testing.assert_allclose(shift, translation, atol=1e-5)
    assert found_scale == scale if keeps_scale else found_scale == pytest.approx(scale, rel=1e-6)
    assert mean < 1e-6


def test_closest_points_of_flat_things_are_aligned_by_a_proper_rotation():
    rng = np.random.default_rng(0)
    flat = np.column_stack([rng.random((50, 2)) * (2.0, 1.0), np.zeros(50)])
    mirrored = flat * (-1.0, 1.0, 1.0)
    rotation, _, scale, _ = pose_kernels.align_by_closest_points(
        flat, mirrored, np.eye(3), np.zeros(3), 1.0, 10, False, False
    )
    assert np.linalg.det(rotation) == pytest.approx(1.0)
    assert scale > 0


def test_a_single_point_is_left_where_it_is():
    point = np.zeros((5, 3))
    rotation, shift, scale, mean = pose_kernels.align_by_closest_points(
        np.ones((4, 3)), point, np.eye(3), np.zeros(3), 2.0, 5, False, False
    )
    np.testing.assert_array_equal(rotation, np.eye(3))
    np.testing.assert_array_equal(shift, np.zeros(3))
    assert (scale, mean) == (2.0, pytest.approx(np.sqrt(3.0)))


# ---------------------------------------------------------------------- matches


def closest(points, corners) -> np.ndarray:
    """The kernel's closest point of one triangle to each of some points."""
    count = len(points)
    normals = np.tile([0.0, 0.0, 1.0], (count, 1))
    places, place_normals = np.empty((count, 3)), np.empty((count, 3))
    matching_kernels.match_to_triangles(
        points, normals, corners[:1].copy(), normals[:1], np.zeros(1, dtype=np.int64), corners,
        np.array([[0, 1, 2]]), np.zeros((count, 1), dtype=np.int64), 0.1, 0.1, places, place_normals,
    )  # fmt: skip
    return places


def grid_distance(points, corners) -> np.ndarray:
    """Distance to many points of a triangle: never less than the true one, and hardly more."""
    first, second = np.meshgrid(np.linspace(0, 1, 101), np.linspace(0, 1, 101))
    inside = first + second <= 1.0 + 1e-12
    weights = np.stack([1 - first - second, first, second], axis=-1)[inside]
    return np.linalg.norm(points[:, None] - (weights @ corners)[None], axis=2).min(axis=1)


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS)
def test_the_closest_point_of_a_triangle_is_what_trimesh_finds(seed):
    rng = np.random.default_rng(seed)
    corners = rng.normal(size=(3, 3))
    points = 2.0 * rng.normal(size=(40, 3))
    expected = trimesh.triangles.closest_point(np.tile(corners, (40, 1, 1)), points)
    np.testing.assert_allclose(closest(points, corners), expected, atol=1e-9)


@pytest.mark.parametrize(
    "corners",
    [
        [[0, 0, 0], [0, 0, 0], [0, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [1, 0, 0]],
        [[1, 0, 0], [0, 0, 0], [0, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [0, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        [[1, 0, 0], [0, 0, 0], [2, 0, 0]],
        [[2, 0, 0], [1, 0, 0], [0, 0, 0]],
        [[0, 0, 0], [1, 1e-9, 0], [2, 0, 0]],
    ],
)
def test_a_triangle_without_area_is_the_line_or_point_that_it_is(corners):
    corners = np.array(corners, dtype=np.float64)
    points = 1.5 * np.random.default_rng(0).normal(size=(100, 3)) + (0.5, 0.0, 0.0)
    places = closest(points, corners)
    assert np.isfinite(places).all()
    distances = np.linalg.norm(places - points, axis=1)
    np.testing.assert_allclose(distances, grid_distance(points, corners), atol=5e-3)


def test_points_on_two_sheets_are_matched_with_the_sheet_that_faces_as_they_do():
    sheet = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    wall = np.array([[0.02, 0, 0], [0.02, 1, 0], [0.02, 0, 1]])
    vertices, faces = np.concatenate([sheet, wall]), np.array([[0, 1, 2], [3, 4, 5]])
    samples = np.array([[0.1, 0.3, 0.0], [0.02, 0.3, 0.1]])
    sample_normals = np.array([[0.0, 0, 1], [1.0, 0, 0]])
    point, near = np.array([[0.05, 0.3, 0.04]]), np.array([[0, 1]])
    for normal, expected in (([0.0, 0, 1], [0.05, 0.3, 0.0]), ([-1.0, 0, 0], [0.02, 0.3, 0.04])):
        places, normals = np.empty((1, 3)), np.empty((1, 3))
        matching_kernels.match_to_triangles(
            point, np.array([normal]), samples, sample_normals, np.arange(2), vertices, faces, near, 0.05, 0.1,
            places, normals,
        )  # fmt: skip
        np.testing.assert_allclose(places[0], expected, atol=1e-12)
        np.testing.assert_allclose(normals[0], normal, atol=1e-12)  # turned to the side of the point


def test_the_winding_of_samples_makes_no_difference():
    rng = np.random.default_rng(1)
    mesh = simple_shapes.goblet()
    faces, weights, normals = sampled(mesh, 400)
    samples = np.empty((400, 3))
    sampling_kernels.place_samples(mesh.vertices, mesh.faces, faces, weights, samples)
    points = samples[::4] + 0.05 * rng.normal(size=(100, 3))
    near = np.argsort(np.linalg.norm(points[:, None] - samples[None], axis=2), axis=1)[:, :6]
    found = []
    for signs in (1.0, rng.choice([-1.0, 1.0], (400, 1))):
        chosen, mean = np.empty(100, dtype=np.int64), np.empty((100, 3))
        turned = np.ascontiguousarray(signs * normals)
        matching_kernels.match_to_samples(points, normals[::4].copy(), samples, turned, near, 0.05, 0.1, chosen, mean)
        found.append((chosen, mean))
    np.testing.assert_array_equal(found[0][0], found[1][0])
    np.testing.assert_allclose(found[0][1], found[1][1], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(found[0][1], axis=1), 1.0)


# ---------------------------------------------------------------------- equations


def test_pairs_add_the_gradient_and_curvature_of_their_energy():
    """The energy of a pair is half its weight times out^2 + (along - spacing)^2, for the weight of where it is."""
    rng = np.random.default_rng(0)
    count, spacing, width, share = 30, 0.3, 0.5, 0.25
    rows = rng.integers(0, 7, count)
    offsets = rng.normal(size=(count, 3)) * 0.4
    normals = rng.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    metrics, forces = np.ones((7, 3, 3)), np.ones((7, 3))
    system_kernels.add_pairs(rows, offsets, normals, spacing, width, share, metrics, forces)
    expected_metrics, expected_forces = np.ones((7, 3, 3)), np.ones((7, 3))
    for row, offset, normal in zip(rows, offsets, normals, strict=True):
        out = offset @ normal
        tangent = offset - out * normal
        along = np.linalg.norm(tangent)
        keep = max(0.0, 1.0 - spacing / along) ** 2
        weight = share / (1.0 + (out**2 + keep * along**2) / width**2) ** 2
        projector = np.outer(normal, normal)
        metric = weight * (projector + keep * (np.eye(3) - projector))
        expected_metrics[row] += metric
        expected_forces[row] += metric @ offset
    np.testing.assert_allclose(metrics, expected_metrics, atol=1e-12)
    np.testing.assert_allclose(forces, expected_forces, atol=1e-12)


def test_a_pair_within_the_spacing_pulls_along_its_normal_only():
    metrics, forces = np.zeros((1, 3, 3)), np.zeros((1, 3))
    system_kernels.add_pairs(
        np.zeros(1, dtype=np.int64), np.array([[0.1, 0.0, 0.2]]), np.array([[0.0, 0.0, 1.0]]), 0.15, 1e6, 1.0,
        metrics, forces,
    )  # fmt: skip
    np.testing.assert_allclose(metrics[0], np.diag([0.0, 0.0, 1.0]), atol=1e-9)
    np.testing.assert_allclose(forces[0], [0.0, 0.0, 0.2], atol=1e-9)


def test_the_normal_equations_are_those_of_finite_differences():
    """Samples are made of control points that parameters move; the pose turns, shifts and grows them about a center."""
    rng = np.random.default_rng(0)
    made = SparseRows.of(sparse.csr_array(rng.random((12, 6)) * (rng.random((12, 6)) < 0.5)))
    control, slopes = rng.normal(size=(6, 3)), rng.normal(size=(2, 6, 3)) * (rng.random((2, 6, 1)) < 0.5)
    rotation, scale = Rotation.random(rng=rng).as_matrix(), 1.6
    translation, center = rng.normal(size=3), rng.normal(size=3)
    metrics, forces = rng.normal(size=(12, 3, 3)), rng.normal(size=(12, 3))
    metrics = metrics @ metrics.transpose(0, 2, 1)
    metrics[3], forces[3] = 0.0, 0.0  # a sample that nothing pulls

    def placed(step: np.ndarray) -> np.ndarray:
        points = scale * made.points(control + step[0] * slopes[0] + step[1] * slopes[1]) @ rotation.T + translation
        turn = Rotation.from_rotvec(step[2:5]).as_matrix()
        return center + np.exp(step[8]) * (points - center) @ turn.T + step[5:8]

    curvature, gradient = np.zeros((9, 9)), np.zeros(9)
    system_kernels.add_system(
        made.starts, made.columns, made.entries, *system_kernels.moved_columns(slopes), placed(np.zeros(9)),
        scale * rotation, center, metrics, forces, curvature, gradient,
    )  # fmt: skip
    jacobian = np.stack([(placed(step) - placed(-step)) / 2e-6 for step in 1e-6 * np.eye(9)], axis=2)
    expected = np.einsum("nac,nab,nbd->cd", jacobian, metrics, jacobian)
    np.testing.assert_allclose(curvature, np.tril(expected), atol=1e-6)
    np.testing.assert_allclose(gradient, np.einsum("nac,na->c", jacobian, forces), atol=1e-7)


def test_columns_that_move_a_point_are_listed_with_it():
    slopes = np.zeros((3, 4, 3))
    slopes[0, 1], slopes[2, 1], slopes[1, 3] = (1, 0, 0), (0, 2, 0), (0, 0, 3)
    starts, columns, moves = system_kernels.moved_columns(slopes)
    np.testing.assert_array_equal(starts, [0, 0, 2, 2, 3])
    np.testing.assert_array_equal(columns, [0, 2, 1])
    np.testing.assert_array_equal(moves, [(1, 0, 0), (0, 2, 0), (0, 0, 3)])


@settings(max_examples=30, deadline=None)
@given(seed=SEEDS)
def test_samples_of_a_surface_are_rows_over_its_control_points(seed):
    rng = np.random.default_rng(seed)
    matrix = sparse.csr_array(rng.normal(size=(8, 5)) * (rng.random((8, 5)) < 0.5))
    surface, control = SparseRows.of(matrix), rng.normal(size=(5, 3))
    vertices = matrix @ control
    np.testing.assert_allclose(surface.points(control), vertices, atol=1e-12)
    np.testing.assert_allclose(surface.first(3).points(control), vertices[:3], atol=1e-12)
    triangles = rng.integers(0, 8, (6, 3))
    faces, weights = rng.integers(0, 6, 20), rng.dirichlet(np.ones(3), 20)
    combined = surface.combined(faces, weights, triangles)
    assert len(combined) == 20
    expected = np.einsum("nk,nkd->nd", weights, vertices[triangles[faces]])
    np.testing.assert_allclose(combined.points(control), expected, atol=1e-12)


def test_the_nearest_of_some_neighbors_is_measured() -> None:
    rng = np.random.default_rng(5)
    points, others = rng.normal(size=(30, 3)), rng.normal(size=(50, 3))
    near = rng.integers(50, size=(30, 4))
    distances = np.empty(30)
    matching_kernels.nearest_distances(points, others, near, distances)
    expected = np.linalg.norm(points[:, None] - others[near], axis=2).min(axis=1)
    np.testing.assert_allclose(distances, expected)
