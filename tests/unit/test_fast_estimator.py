"""The fast estimator from query to answer, on small models: what made a query is found again."""

from collections.abc import Sequence

import numpy as np
import pytest
from chair_model import armchair
from ell_generator import EllGenerator
from fast_support import angle_deg, lever, placed, random_pose, rigid, signs

from shapewright.distances.alignment import Pose
from shapewright.errors import Cancelled, EstimationError
from shapewright.estimation import Estimation, EstimationCancelled, EstimationSettings, Query, estimate
from shapewright.estimation.fast import pool
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel, compile_model
from shapewright.progress import NULL_PROGRESS, CallbackProgress, Progress

SMALL = EstimationSettings(surface_points=300)
TRUE = np.array([1.3, 0.8, 1.2, 1.0])


def run(
    query: TriangleMesh | Query, models: CompiledModel | Sequence[CompiledModel], progress: Progress = NULL_PROGRESS
) -> Estimation:
    return estimate(query, models, SMALL, progress=progress)


@pytest.fixture(scope="module")
def model() -> CompiledModel:
    return lever()


@pytest.fixture(scope="module")
def rivals(model: CompiledModel) -> list[CompiledModel]:
    return [signs(), model]


POSE = random_pose(7, 40.0, 300.0)


@pytest.fixture(scope="module")
def query(model: CompiledModel) -> TriangleMesh:
    return placed(model, TRUE, POSE)


@pytest.fixture(scope="module")
def reports() -> list[tuple[float, str]]:
    return []


@pytest.fixture(scope="module")
def found(query: TriangleMesh, rivals: list[CompiledModel], reports: list[tuple[float, str]]) -> Estimation:
    return run(query, rivals, CallbackProgress(lambda *report: reports.append(report)))


def assert_found(found: Estimation, values: np.ndarray, pose: Pose) -> None:
    np.testing.assert_allclose(found.values, values, atol=0.02 * 1.5)  # 2 % of the ranges
    assert angle_deg(found.pose.rotation, pose.rotation) < 1.0
    assert found.pose.scale == pytest.approx(pose.scale, rel=0.02)
    assert found.distances.zbuffer < 0.03
    assert found.layer == 3
    assert found.complete


# ---------------------------------------------------------------------- what is found


def test_the_model_of_a_class_its_values_and_its_pose_are_found(
    found: Estimation, query: TriangleMesh, model: CompiledModel
) -> None:
    assert found.model is model.model
    assert found.estimator == "fast"
    assert_found(found, TRUE, POSE)
    np.testing.assert_allclose(found.mesh.bounds, query.bounds, atol=0.03 * np.ptp(query.vertices))
    assert [one.model.name for one in found.tried] == ["lever", "sign"]
    assert all(one.distances is not None for one in found.tried)
    assert found.tried[0].distances.zbuffer == pytest.approx(found.distances.zbuffer)
    assert found.tried[0].distances.zbuffer < found.tried[1].distances.zbuffer


def test_the_answer_says_how_it_was_found_and_how_well(found: Estimation) -> None:
    assert [stage.name for stage in found.stages] == ["start", "fit", "polish"]
    distances = [stage.distances.zbuffer for stage in found.stages]
    assert distances == sorted(distances, reverse=True)
    assert found.verdict.layer == 3
    assert found.verdict.residuals.followed_share > 0.98
    assert found.verdict.residuals.invented_share < 0.02
    assert [part.name for part in found.verdict.residuals.by_part]
    by_name = {parameter.name: parameter for parameter in found.parameters}
    assert by_name["flag"].option == "with"
    for name in ("foot", "tower", "width"):
        low, high = by_name[name].interval
        assert low < by_name[name].value < high
    assert found.ratios


def test_progress_never_falls_and_ends_at_one(found: Estimation, reports: list[tuple[float, str]]) -> None:
    fractions = [fraction for fraction, _ in reports]
    assert fractions == sorted(fractions)
    assert (fractions[0], fractions[-1]) == (0.0, 1.0)
    assert any("z-buffer distance" in message for _, message in reports)


def test_the_same_seed_gives_the_same_result_on_any_number_of_processors(
    query: TriangleMesh, rivals: list[CompiledModel], found: Estimation, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = pool._processors()
    monkeypatch.setattr(pool, "_processors", lambda: 1 if here > 1 else 3)
    again = run(query, rivals)
    assert again.to_dict() == found.to_dict()


@pytest.mark.parametrize("seed", [1, 2])
def test_any_pose_and_scale(model: CompiledModel, seed: int) -> None:
    values = model.random_values(np.random.default_rng(seed), 1)[0]
    pose = random_pose(seed, 10.0 ** (2 * seed - 3), 5.0)
    assert_found(run(placed(model, values, pose), model), values, pose)


def test_options_are_found() -> None:
    chair = compile_model(armchair())
    values = chair.values_from_mapping(
        {"back": 3, "armrests": 1, "leg_length": 1.4, "arm_height": 1.2, "ring_height": 0.6}
    )
    found = run(placed(chair, values, random_pose(4)), chair)
    options = {parameter.name: parameter.option for parameter in found.parameters if parameter.option}
    assert options == {"back": "no back", "armrests": "with"}
    assert found.distances.zbuffer < 0.05


def test_a_model_of_options_alone() -> None:
    model = signs()
    values, pose = np.array([2.0, 1.0]), random_pose(2, 0.01)
    found = run(placed(model, values, pose), model)
    assert_found(found, values, pose)
    assert found.ratios == found.combinations == ()
    assert {parameter.interval for parameter in found.parameters} == {None}


def test_a_model_without_parameters() -> None:
    model, pose = rigid(), random_pose(3, 7.0, 20.0)
    found = run(placed(model, [], pose), model)
    assert_found(found, np.zeros(0), pose)
    assert found.parameters == found.ratios == ()


# ---------------------------------------------------------------------- what is known


def test_known_units_fix_the_scale_and_lengths_are_in_them(model: CompiledModel) -> None:
    pose = random_pose(9, 10.0, 50.0)  # a unit of the model is a centimeter, the file is in millimeters
    found = run(Query(placed(model, TRUE, pose), units="mm"), model)
    assert found.pose.scale == pytest.approx(10.0, rel=1e-9)
    assert_found(found, TRUE, pose)
    by_name = {parameter.name: parameter for parameter in found.parameters}
    assert by_name["foot"].unit == "mm"
    assert by_name["foot"].displayed_value == pytest.approx(1.3 * 30.0, abs=0.5)
    assert by_name["foot"].status == "determined"
    in_inches = run(Query(placed(model, TRUE, Pose(pose.rotation, pose.translation, 1 / 2.54)), units="in"), model)
    foot = next(parameter for parameter in in_inches.parameters if parameter.name == "foot")
    assert (foot.unit, foot.displayed_value) == ("in", pytest.approx(1.3 * 30.0 / 25.4, abs=0.02))


def test_a_known_rotation_is_kept(model: CompiledModel) -> None:
    pose = random_pose(5, 3.0)
    found = run(Query(placed(model, TRUE, pose), rotation=pose.rotation), model)
    np.testing.assert_allclose(found.pose.rotation, pose.rotation, atol=1e-12)
    assert_found(found, TRUE, pose)


def test_a_known_vertical_narrows_the_search(model: CompiledModel) -> None:
    from scipy.spatial.transform import Rotation

    up = Rotation.from_euler("xz", [90.0, 0.0], degrees=True) * Rotation.from_euler("z", 130.0, degrees=True)
    pose = Pose(up.as_matrix(), np.zeros(3), 2.0)
    query = Query(placed(model, TRUE, pose), up="-y")
    assert query.allows(pose.rotation)
    found = run(query, model)
    assert query.allows(found.pose.rotation)
    assert_found(found, TRUE, pose)


def test_a_wrong_unit_is_not_hidden(model: CompiledModel) -> None:
    """Ten times too large for any instance: the scale is kept, and the verdict says how badly that fits."""
    found = run(Query(placed(model, TRUE, random_pose(9, 10.0)), units="cm"), model)
    assert found.pose.scale == pytest.approx(1.0)
    assert found.verdict.residuals.followed_share < 0.5


# ---------------------------------------------------------------------- cancelling


def cancelling(part: str, after: int = 0) -> Progress:
    """Cancel at a report whose message has a part, or some reports later."""
    reached = 0

    def report(fraction: float, message: str) -> None:
        nonlocal reached
        reached += reached > 0 or part in message
        if reached > after:
            raise Cancelled

    return CallbackProgress(report)


def test_cancelled_before_the_query_is_prepared_there_is_no_answer(
    query: TriangleMesh, rivals: list[CompiledModel]
) -> None:
    with pytest.raises(EstimationCancelled) as caught:
        run(query, rivals, cancelling("preparing the query"))
    assert caught.value.best is None


@pytest.fixture(scope="module")
def crooked(query: TriangleMesh) -> TriangleMesh:
    """A query that no model follows: bent, so that everything is tried."""
    vertices = query.vertices.copy()
    across = vertices[:, 0] - vertices[:, 0].mean()
    vertices[:, 1] += 0.2 * np.ptp(across) * np.sin(7.0 * across / np.ptp(across))
    return TriangleMesh(vertices, query.faces)


@pytest.mark.parametrize(
    ("part", "after"),
    [
        ("first orientations", 0),
        ("first fits", 0),
        ("closer fits", 1),
        ("surfaces", 1),
        ("options", 2),
        ("dense fits", 1),
        ("polish", 3),
        ("judging", 1),
    ],
)
def test_cancelled_at_any_moment_the_best_so_far_is_the_answer(
    crooked: TriangleMesh, rivals: list[CompiledModel], part: str, after: int
) -> None:
    with pytest.raises(EstimationCancelled) as caught:
        run(crooked, rivals, cancelling(part, after))
    best = caught.value.best
    assert best is not None
    assert not best.complete
    compiled = next(one for one in rivals if one.model is best.model)
    np.testing.assert_array_equal(compiled.settle(best.values[None])[0], best.values)
    assert len(best.tried) == len(rivals)
    expected = placed(compiled, best.values, best.pose)
    np.testing.assert_allclose(best.mesh.vertices, expected.vertices, atol=1e-9 * POSE.scale)
    assert [stage.name for stage in best.stages] == ["start", "fit", "polish"][: len(best.stages)]
    assert all(parameter.status is not None for parameter in best.parameters if not parameter.option)
    best.to_dict()


def test_an_error_in_a_thread_of_the_search_reaches_the_caller(
    query: TriangleMesh, model: CompiledModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise FloatingPointError("no solution")

    monkeypatch.setattr("shapewright.estimation.fast.search.outline_distance", fail)
    with pytest.raises(FloatingPointError, match="no solution"):
        run(query, model)


def test_only_compiled_models_are_taken(query: TriangleMesh) -> None:
    with pytest.raises(EstimationError, match=r"models\[0\].*EllGenerator"):
        estimate(query, EllGenerator("length"), SMALL)
