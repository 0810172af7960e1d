"""Meshes that are broken, extreme or beside the point: a clear refusal or a correct result."""

import numpy as np
import pytest
from command_line import shapewright
from fast_support import angle_deg, lever, placed, random_pose, signs

from shapewright.distances.alignment import Pose
from shapewright.errors import Cancelled, MeshError
from shapewright.estimation import Estimation, EstimationCancelled, EstimationSettings, estimate
from shapewright.estimation.dust import without_dust
from shapewright.estimation.residuals import measure_residuals
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel
from shapewright.progress import CallbackProgress

SMALL = EstimationSettings(surface_points=300, image_size=128)
TRUE = np.array([1.3, 0.8, 1.2, 1.0])
POSE = random_pose(7)


@pytest.fixture(scope="module")
def model() -> CompiledModel:
    return lever()


@pytest.fixture(scope="module")
def query(model: CompiledModel) -> TriangleMesh:
    return placed(model, TRUE, POSE)


def assert_found(found: Estimation, pose: Pose) -> None:
    np.testing.assert_allclose(found.values, TRUE, atol=0.05 * 1.5)
    assert angle_deg(found.pose.rotation, pose.rotation) < 4.0
    assert found.pose.scale == pytest.approx(pose.scale, rel=0.06)


def joined(*meshes: TriangleMesh) -> TriangleMesh:
    firsts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    faces = [mesh.faces + first for mesh, first in zip(meshes, firsts, strict=True)]
    return TriangleMesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def specks(center: np.ndarray, away: float, count: int = 20, size: float = 0.01) -> TriangleMesh:
    """Small triangles scattered about a place."""
    rng = np.random.default_rng(0)
    corners = center + away * rng.normal(size=(count, 1, 3)) + size * rng.normal(size=(count, 3, 3))
    return TriangleMesh(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


# ---------------------------------------------------------------------- refusals

LINE = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
ALL_FOUR = np.array([[0, 1, 2], [1, 2, 3], [0, 2, 3], [0, 1, 3]])


@pytest.mark.parametrize(
    ("vertices", "told"),
    [(np.zeros((4, 3)), "one point"), (np.full((4, 3), 7.0), "one point"), (LINE, "no area")],
    ids=["a point", "a point far off", "a line"],
)
def test_what_has_no_surface_is_refused(model: CompiledModel, vertices: np.ndarray, told: str) -> None:
    with pytest.raises(MeshError, match=told) as caught:
        estimate(TriangleMesh(vertices, ALL_FOUR), model, SMALL)
    assert caught.value.where


@pytest.mark.parametrize(
    ("vertices", "told"), [(np.zeros((4, 3)), "no face has an area"), (LINE, "no face has an area")]
)
def test_the_command_refuses_what_has_no_surface_and_names_the_file(tmp_path, vertices: np.ndarray, told: str) -> None:
    rows = "\n".join(" ".join(map(str, row)) for row in vertices.tolist())
    faces = "\n".join("3 " + " ".join(map(str, row)) for row in ALL_FOUR.tolist())
    path = tmp_path / "flat.off"
    path.write_text(f"OFF\n4 4 0\n{rows}\n{faces}\n")
    message = shapewright("estimate", path, "-m", "stool", "-o", tmp_path / "fit.glb", "--json").refused()
    assert "flat.off" in message
    assert told in message
    assert list(tmp_path.iterdir()) == [path]


# ---------------------------------------------------------------------- correct results


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_extreme_scales_are_found(model: CompiledModel, query: TriangleMesh, scale: float) -> None:
    found = estimate(query.transformed(np.eye(3), np.zeros(3), scale), model, SMALL)
    assert_found(found, Pose(POSE.rotation, POSE.translation, scale))


def test_inside_out_faces_make_no_difference(model: CompiledModel, query: TriangleMesh) -> None:
    some = np.random.default_rng(0).random(len(query.faces)) < 0.5
    faces = np.where(some[:, None], query.faces[:, ::-1], query.faces)
    assert_found(estimate(TriangleMesh(query.vertices, faces), model, SMALL), POSE)


@pytest.mark.parametrize(("away", "count"), [(10.0, 20), (1000.0, 1)], ids=["around", "one far speck"])
def test_dust_is_not_taken_for_the_object(model: CompiledModel, query: TriangleMesh, away: float, count: int) -> None:
    dusty = joined(query, specks(query.centroid, away, count))
    found = estimate(dusty, model, SMALL)
    assert_found(found, POSE)
    residuals = found.verdict.residuals
    assert len(residuals.query_to_fit) == len(dusty.vertices)
    assert residuals.query_to_fit[: len(query.vertices)].max() < 0.1
    assert residuals.query_to_fit[len(query.vertices) :].max() > 1.0
    assert residuals.followed_share > 0.95


def test_another_class_is_no_good_fit(query: TriangleMesh) -> None:
    found = estimate(query, signs(), SMALL)
    assert found.complete
    assert found.distances.surface > SMALL.surface_threshold
    assert found.verdict.residuals.followed_share < 0.8


def test_cancelled_at_once(model: CompiledModel, query: TriangleMesh) -> None:
    def cancel(fraction: float, message: str) -> None:
        raise Cancelled

    with pytest.raises(EstimationCancelled) as caught:
        estimate(query, model, SMALL, progress=CallbackProgress(cancel))
    assert caught.value.best is None


# ---------------------------------------------------------------------- large meshes


def sphere(sides: int) -> TriangleMesh:
    """A sphere of 2 * sides * sides triangles."""
    turn, height = np.meshgrid(np.arange(sides + 1) * 2 * np.pi / sides, np.arange(sides + 1) * np.pi / sides)
    points = np.stack([np.cos(turn) * np.sin(height), np.sin(turn) * np.sin(height), np.cos(height)], axis=-1)
    row, column = np.meshgrid(np.arange(sides), np.arange(sides), indexing="ij")
    first = (row * (sides + 1) + column).ravel()
    below = first + sides + 1
    faces = np.concatenate([np.stack([first, below, first + 1], 1), np.stack([first + 1, below, below + 1], 1)])
    return TriangleMesh(points.reshape(-1, 3), faces)


def test_two_million_faces_are_stopped_before_they_are_judged(model: CompiledModel) -> None:
    """The whole of it takes a dozen seconds; that it can be stopped between any two steps is what is tested."""
    large = sphere(1000)
    assert len(large.faces) == 2_000_000

    def report(fraction: float, message: str) -> None:
        if "closer fits" in message:
            raise Cancelled

    with pytest.raises(EstimationCancelled) as caught:
        estimate(large, model, SMALL, progress=CallbackProgress(report))
    assert caught.value.best is not None


def test_residuals_of_many_points_can_be_stopped_in_the_middle(query: TriangleMesh) -> None:
    calls = []

    def checkpoint() -> None:
        calls.append(None)
        if len(calls) == 4:
            raise Cancelled

    with pytest.raises(Cancelled):
        measure_residuals(sphere(150), query, checkpoint=checkpoint)
    assert len(calls) == 4


# ---------------------------------------------------------------------- dust


def test_only_what_is_far_and_small_is_dust(query: TriangleMesh) -> None:
    assert without_dust(query) is query
    near = joined(query, specks(query.centroid, 0.3))
    assert without_dust(near) is near
    second = joined(query, query.transformed(np.eye(3), np.array([50.0, 0, 0])))
    assert without_dust(second) is second
    swept = without_dust(joined(query, specks(query.centroid, 100.0)))
    np.testing.assert_array_equal(swept.vertices, query.vertices)
    np.testing.assert_array_equal(swept.faces, query.faces)


def test_a_thin_long_part_belongs_to_the_object_in_any_number_of_pieces(query: TriangleMesh) -> None:
    first = np.array([[0.0, 0, 0], [0.15, 0.001, 0], [0.15, -0.001, 0]]) + query.vertices.max(axis=0)
    corners = first + np.array([0.2, 0.0, 0.0]) * np.arange(100)[:, None, None]
    rod = TriangleMesh(corners.reshape(-1, 3), np.arange(300).reshape(-1, 3))
    whole = joined(query, rod)
    assert len(without_dust(whole).faces) == len(whole.faces)


def test_vertices_without_faces_are_dust() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [900, 0, 0]])
    assert len(without_dust(TriangleMesh(corners, np.array([[0, 1, 2]]))).vertices) == 3
