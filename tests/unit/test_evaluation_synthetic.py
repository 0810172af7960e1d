"""Synthetic queries, what counts as recovered, and the figures of both; the estimators here are made up."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from made_up_estimator import base_answer, parameters_of
from scipy.spatial.transform import Rotation
from small_dataset import slab

from models_store.library.shipped import load_shipped
from shapewright.distances.alignment import Pose
from shapewright.errors import Cancelled, EvaluationError
from shapewright.estimation import Distances, EstimationSettings, Query, Ratio, Stage
from shapewright.evaluation.corruptions import CORRUPTIONS
from shapewright.evaluation.datasets import Skipped
from shapewright.evaluation.estimated import Answer, Case, Estimated, estimate_cases
from shapewright.evaluation.estimation_cases import Damage, SyntheticCases
from shapewright.evaluation.estimation_figures import against, estimation_figures
from shapewright.evaluation.recovery import comparable, recover, symmetry_rotations
from shapewright.evaluation.recovery_figures import recoveries, recovery_figures
from shapewright.evaluation.synthetic import SCALES, Truth, draw_query, models_in_turn
from shapewright.modeling import CompiledModel, Symmetry, compile_model
from shapewright.modeling.parameter import Parameter
from shapewright.progress import CallbackProgress


@cache
def compiled(name: str) -> CompiledModel:
    return compile_model(load_shipped(name))


def answer_of(model: CompiledModel, values: np.ndarray, pose: Pose, zbuffer: float = 0.01) -> Answer:
    distances = Distances(0.1, 0.02, zbuffer, 100 * zbuffer)
    stages = (
        Stage("panorama", values, pose, Distances(0.1, 0.06, 2 * zbuffer, 1.0)),
        Stage("zbuffer", values, pose, distances),
    )
    return Answer(model.model.name, 3, values, parameters_of(model, values), pose, distances, stages, (), (), 2.0, 1.5)


def truth_of(name: str, seed: int = 0, **fixed: float) -> Truth:
    model = compiled(name)
    values = model.random_values(np.random.default_rng(seed), 1, fixed)
    pose = Pose(Rotation.random(rng=np.random.default_rng(seed)).as_matrix(), np.array([3.0, -1.0, 2.0]), 4.0)
    return Truth(model, values[0], model.space.active(values)[0], pose)


def perfect(truth: Truth, **changes: object) -> Answer:
    return replace(answer_of(truth.compiled, truth.values, truth.pose), **changes)


def active_parameters(truth: Truth) -> list[Parameter]:
    return [p for p, active in zip(truth.compiled.model.parameters, truth.active, strict=True) if active]


# ---------------------------------------------------------------- drawing


def test_every_model_has_its_turn_and_more_queries_begin_with_the_same() -> None:
    models = [compiled(name) for name in ("stool", "table", "sword")]
    chosen = [model.model.name for model in models_in_turn(models, 8, seed=4)]
    assert sorted(Counter(chosen).values()) == [2, 3, 3]
    assert [model.model.name for model in models_in_turn(models, 5, seed=4)] == chosen[:5]
    orders = {tuple(model.model.name for model in models_in_turn(models, 3, seed=seed)) for seed in range(20)}
    assert len(orders) == 6
    with pytest.raises(EvaluationError, match="no model"):
        models_in_turn([], 3, seed=0)


def test_a_query_is_the_posed_instance_of_its_values() -> None:
    model = compiled("stool")
    drawn, again, other = (draw_query(model, 3, number) for number in (5, 5, 6))
    np.testing.assert_array_equal(drawn.mesh.vertices, again.mesh.vertices)
    np.testing.assert_array_equal(drawn.truth.values, again.truth.values)
    assert not np.allclose(drawn.truth.pose.rotation, other.truth.pose.rotation)
    truth = drawn.truth
    np.testing.assert_array_equal(model.settle(truth.values[None])[0], truth.values)
    assert SCALES[0] <= truth.pose.scale <= SCALES[1]
    posed = truth.pose.apply(model.instance(truth.values).vertices)
    np.testing.assert_allclose(
        drawn.mesh.bounds, [posed.min(axis=0), posed.max(axis=0)], atol=2e-3 * np.ptp(posed, axis=0).max()
    )
    assert set(truth.options) == {
        p.name for p, on in zip(model.model.parameters, truth.active, strict=True) if p.options and on
    }
    assert drawn.units is None


def test_rotations_are_uniform_and_scales_log_uniform() -> None:
    model = compile_model(slab())
    poses = [draw_query(model, 0, number).truth.pose for number in range(60)]
    axes = np.stack([pose.rotation[:, 2] for pose in poses])
    assert np.abs(axes.mean(axis=0)).max() < 0.3
    logs = np.log10([pose.scale for pose in poses])
    assert logs.min() < -1.5
    assert logs.max() > 1.5
    assert abs(logs.mean()) < 0.5


def test_a_known_scale_is_that_of_the_unit_which_the_query_names() -> None:
    model = compiled("stool")
    drawn = [draw_query(model, 0, number, known_scale=True) for number in range(12)]
    assert len({one.units for one in drawn}) > 1
    for one in drawn:
        query = Query(one.mesh, units=one.units)
        assert query.scale_of(model.model.unit_m) == pytest.approx(one.truth.pose.scale)
    nameless = compile_model(replace(model.model, unit_m=None))
    with pytest.raises(EvaluationError, match="how many meters"):
        draw_query(nameless, 0, 0, known_scale=True)


# ---------------------------------------------------------------- recovery


def test_the_truth_itself_is_recovered() -> None:
    for name in ("table_round", "glass_with_stem", "fish"):
        truth = truth_of(name)
        found = recover(truth, perfect(truth))
        assert found.model_right
        assert found.options_all_right
        assert found.pose_right
        assert found.pose_offered
        assert all(parameter.error == 0.0 for parameter in found.parameters)
        assert all(option.right for option in found.options)
        assert len(found.parameters) == found.active_parameters
        measures = [
            p for p, on in zip(truth.compiled.model.parameters, truth.active, strict=True) if on and not p.options
        ]
        assert [parameter.name for parameter in found.parameters] == [p.name for p in measures]


def test_nothing_counts_where_the_model_is_wrong() -> None:
    truth = truth_of("table")
    found = recover(truth, perfect(truth, model="table_round"))
    assert not found.model_right
    assert (found.parameters, found.options, found.pose_right) == ((), (), None)
    assert found.active_parameters > 0


def test_a_parameter_counts_only_where_the_options_that_decide_over_it_are_right() -> None:
    model = compiled("table_round").model
    dependent = next(p for p in model.parameters if p.active_when)
    condition = dependent.active_when[0]
    truth = truth_of("table_round", 1, **{condition.parameter: float(np.ceil(condition.minimum))})
    columns = truth.compiled.space.columns
    if not truth.active[columns[dependent.name]]:
        pytest.fail("the fixed value makes it active")
    values = truth.values.copy()
    values[columns[condition.parameter]] += 1.0 if values[columns[condition.parameter]] < 2 else -1.0
    counted = comparable(truth, values)
    assert not counted[columns[dependent.name]]
    assert counted[columns[condition.parameter]]
    found = recover(truth, perfect(truth, values=values))
    assert not found.options_all_right
    assert [option.right for option in found.options if option.name == condition.parameter] == [False]
    assert dependent.name not in [parameter.name for parameter in found.parameters]


def test_errors_are_shares_of_the_whole_range_and_intervals_are_compared_with_the_truth() -> None:
    truth = truth_of("glass_with_stem")
    i = int(np.flatnonzero(truth.active)[0])
    parameter = truth.compiled.model.parameters[i]
    extent, true = parameter.maximum - parameter.minimum, float(truth.values[i])
    values = truth.values.copy()
    values[i] += 0.04 * extent
    estimates = list(parameters_of(truth.compiled, values))
    for interval, covered in (
        ((true - 0.01, true + 0.03 * extent), True),
        ((true + 0.01 * extent, true + 0.07 * extent), False),
    ):
        estimates[i] = replace(estimates[i], status="determined", interval=interval)
        found = recover(truth, perfect(truth, values=values, parameters=tuple(estimates))).parameters[0]
        assert found.error == pytest.approx(0.04)
        assert found.status == "determined"
        assert found.covered is covered
        assert found.half_width == pytest.approx((interval[1] - interval[0]) / 2 / extent)


def test_ratios_are_right_within_five_percent_whatever_the_scale() -> None:
    truth = truth_of("glass_with_stem")
    over, under = (truth.compiled.model.parameters[i] for i in (0, 3))
    right = truth.values[0] * (over.base_value or 0) / (truth.values[3] * (under.base_value or 0))
    ratios = [
        Ratio(over.name, under.name, "a : b", right * factor, None, "determined") for factor in (1.04, 0.96, 1.06)
    ]
    ratios.append(Ratio(over.name, under.name, "a : b", 9.0 * right, None, "not_determined"))
    assert recover(truth, perfect(truth, ratios=tuple(ratios))).ratios_right == (True, True, False)


def test_a_pose_is_right_up_to_the_symmetry_of_the_model_and_of_the_instance() -> None:
    def turned(truth: Truth, axis: str, angle_deg: float) -> bool | None:
        turn = Rotation.from_euler(axis, angle_deg, degrees=True).as_matrix()
        pose = Pose(truth.pose.rotation @ turn, truth.pose.translation, truth.pose.scale)
        return recover(truth, perfect(truth, pose=pose)).pose_right

    table, glass, fish = truth_of("table"), truth_of("glass_with_stem"), truth_of("fish")
    assert turned(table, "z", 180.0)
    assert not turned(table, "z", 90.0)
    assert turned(glass, "z", 30.0)
    assert turned(glass, "z", 15.0)  # round, though its mesh has twelve sides
    assert not turned(glass, "x", 180.0)
    for axis in "xyz":
        assert not turned(fish, axis, 180.0)  # head to tail
        assert turned(fish, axis, 3.0)


def test_a_pose_must_be_in_place_and_of_the_right_size_but_may_share_a_factor_with_the_model() -> None:
    truth = truth_of("table")
    pose = truth.pose
    instance = truth.compiled.instance(truth.values)
    length = pose.scale * float(np.linalg.norm(np.ptp(instance.vertices, axis=0)))
    shifted = Pose(pose.rotation, pose.translation + np.array([0.2 * length, 0, 0]), pose.scale)
    larger = Pose(pose.rotation, pose.translation, 1.2 * pose.scale)
    for wrong in (shifted, larger):
        found = recover(truth, perfect(truth, pose=wrong))
        assert not found.pose_right
    turned = Pose(pose.rotation @ Rotation.from_euler("x", 180, degrees=True).as_matrix(), pose.translation, pose.scale)
    found = recover(truth, perfect(truth, pose=turned, other_poses=(pose,)))
    assert not found.pose_right
    assert found.pose_offered


@pytest.mark.parametrize(
    ("symmetry", "count"),
    [(Symmetry(), 1), (Symmetry(("y",)), 1), (Symmetry(("x", "y")), 2), (Symmetry(("x", "y", "z")), 4),
     (Symmetry((), "z", 12), 12), (Symmetry(("x", "y"), "z", 12), 24)],
)  # fmt: skip
def test_the_rotations_of_a_symmetry_are_products_of_its_maps(symmetry: Symmetry, count: int) -> None:
    rotations = symmetry_rotations(symmetry)
    assert len(rotations) == count
    np.testing.assert_allclose(rotations[0], np.eye(3))
    np.testing.assert_allclose(np.linalg.det(rotations), 1.0)
    products = np.einsum("aij,bjk->abik", rotations, rotations).reshape(-1, 3, 3)
    away = np.abs(products[:, None] - rotations[None]).max(axis=(2, 3)).min(axis=1)
    np.testing.assert_allclose(away, 0.0, atol=1e-9)


# ---------------------------------------------------------------- figures


def estimated(truth: Truth, answer: Answer, number: int = 0) -> Estimated:
    return Estimated(f"{number}", truth.compiled.model.class_name, truth, answer)


def test_figures_of_layers_distances_and_stages() -> None:
    truth = truth_of("stool")
    answers = [answer_of(truth.compiled, truth.values, truth.pose, zbuffer) for zbuffer in (0.05, 0.2, 0.3, 0.8)]
    answers[3] = replace(answers[3], layer=1, seconds=10.0)
    figures = estimation_figures([estimated(truth, answer) for answer in answers])
    assert figures["n"] == 4
    assert figures["layer_share"] == {"1": 0.25, "2": 0.0, "3": 0.75}
    assert figures["zbuffer_median"] == pytest.approx(0.25)
    assert (figures["under_0_1"], figures["under_0_35"]) == (0.25, 0.75)
    assert figures["seconds_median"] == 2.0
    assert figures["seconds_p95"] > 8.0
    assert figures["per_class"]["stool"]["n"] == 4
    assert list(figures["distances_by_stage"]) == ["panorama", "zbuffer"]
    assert figures["distances_by_stage"]["panorama"]["zbuffer"]["p50"] == pytest.approx(0.5)
    assert figures["distances_by_stage"]["zbuffer"]["surface"]["n"] == 4


def test_figures_of_recovery() -> None:
    truth = truth_of("glass_with_stem")
    count = int(truth.active.sum())
    ranges = truth.compiled.maximum - truth.compiled.minimum
    off = truth.values + 0.1 * ranges
    judged = tuple(
        replace(p, status="determined" if i else "not_determined", interval=(p.value - 0.5, p.value + 0.5))
        for i, p in enumerate(parameters_of(truth.compiled, truth.values))
    )
    good = perfect(truth, parameters=judged)
    bad = replace(answer_of(truth.compiled, off, truth.pose, 0.9))
    wrong = perfect(truth, model="glass_with_stem_cone")
    members = [estimated(truth, answer, number) for number, answer in enumerate((good, bad, wrong))]
    found = recoveries(members)
    figures = recovery_figures(members, found)
    assert figures["within_5_percent"] == 0.5
    assert figures["within_5_percent_determined"] == 1.0
    assert figures["determined_share"] == pytest.approx((count - 1) / count)
    assert figures["model_right"] == pytest.approx(2 / 3)
    assert figures["pose_right"] == 0.5
    assert figures["options_right"] is None  # the glass has none
    assert figures["within_5_percent_ratios"] is None
    assert figures["interval_coverage"] == 1.0
    assert figures["interval_coverage_hardest_quarter"] is None  # the hardest of three has no intervals
    assert figures["parameters"] == 2 * count
    assert figures["parameters_active"] == 3 * count
    per_parameter = figures["per_parameter"]["glass_with_stem"]
    assert len(per_parameter) == count
    assert all(row["n"] == 2 and row["error_median"] == pytest.approx(0.05) for row in per_parameter.values())
    assert recovery_figures(members, found, model_known=True)["model_right"] is None


def test_the_hardest_quarter_is_that_of_the_largest_distances() -> None:
    truth = truth_of("glass_with_stem")
    members = []
    for number in range(8):
        low, high = (-1.0, 1.0) if number < 6 else (1.0, 2.0)  # misses the true value of the two worst
        judged = tuple(
            replace(p, interval=(p.value + low, p.value + high)) for p in parameters_of(truth.compiled, truth.values)
        )
        distances = Distances(0.1, 0.02, 0.1 * number, 1.0)
        members.append(estimated(truth, perfect(truth, parameters=judged, distances=distances), number))
    figures = recovery_figures(members, recoveries(members))
    assert figures["interval_coverage"] == 0.75
    assert figures["interval_coverage_hardest_quarter"] == 0.0


def test_two_estimators_are_compared_query_by_query() -> None:
    truth = truth_of("stool")

    def run(distances: Sequence[float], seconds: float) -> list[Estimated]:
        answers = [answer_of(truth.compiled, truth.values, truth.pose, zbuffer) for zbuffer in distances]
        return [estimated(truth, replace(a, processor_seconds=seconds), k) for k, a in enumerate(answers)]

    compared = against(run((0.1, 0.2, 0.3), 1.0), run((0.1, 0.3, 0.2), 100.0))
    assert compared == {"n": 3, "zbuffer_no_worse": pytest.approx(2 / 3), "processor_ratio_median": 100.0}


# ---------------------------------------------------------------- many queries


def synthetic_cases(count: int, damage: Damage | None = None) -> SyntheticCases:
    models = [compiled("stool"), compiled("sword_dagger")]
    names = {model.model.class_name: (model.model.name,) for model in models}
    return SyntheticCases(models_in_turn(models, count, 0), names, seed=2, damage=damage)


MODELS = ("stool", "sword_dagger")


@pytest.mark.parametrize("jobs", [1, 2])
def test_cases_are_estimated_in_their_order_and_refused_meshes_are_named(jobs: int) -> None:
    cases = synthetic_cases(5)
    tiny = Query(compiled("stool").instance(compiled("stool").base_values(), 0))
    flat = replace(tiny.mesh, faces=tiny.mesh.faces[:2])
    given = [*cases(), Skipped("unread.off", "cannot be read"), Case("flat.off", "stool", Query(flat), ("stool",))]
    done = estimate_cases(
        given,
        len(given),
        {name: compiled(name) for name in MODELS},
        EstimationSettings(),
        estimate_query=base_answer,
        jobs=jobs,
    )
    assert [one.name for one in done.estimated] == [one.name for one in given[:5]]
    assert done.skipped == (Skipped("unread.off", "cannot be read"), Skipped("flat.off", "too few faces"))
    for one in done.estimated:
        assert one.answer.model == one.name.rsplit("-", 1)[0]
        assert 0.0 < one.answer.distances.zbuffer < 1.0
        assert one.truth is not None
        assert one.answer.seconds >= 0.0


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_progress_can_cancel(jobs: int) -> None:
    def report(fraction: float, message: str) -> None:
        if fraction > 0.3:
            raise Cancelled

    cases = synthetic_cases(6)
    with pytest.raises(Cancelled):
        estimate_cases(
            cases(),
            len(cases),
            {name: compiled(name) for name in MODELS},
            EstimationSettings(),
            estimate_query=base_answer,
            jobs=jobs,
            progress=CallbackProgress(report),
        )


def test_cases_come_again_by_name_and_are_damaged_alike() -> None:
    damage = Damage(CORRUPTIONS["noise"], 0.005, seed=9)
    cases = synthetic_cases(4, damage)
    every = list(cases())
    assert len(cases) == len(every) == 4
    wanted = every[2]
    assert isinstance(wanted, Case)
    (again,) = cases([wanted.name])
    assert isinstance(again, Case)
    np.testing.assert_array_equal(again.query.mesh.vertices, wanted.query.mesh.vertices)
    clean = list(synthetic_cases(4)())[2]
    assert isinstance(clean, Case)
    assert not np.isclose(clean.query.mesh.area, wanted.query.mesh.area, rtol=1e-6)
    assert clean.truth is not None
    assert wanted.truth is not None
    np.testing.assert_array_equal(clean.truth.values, wanted.truth.values)


def test_a_corruption_that_leaves_no_faces_is_refused() -> None:
    with pytest.raises(EvaluationError, match="with faces, got 'points'") as caught:
        Damage(CORRUPTIONS["points"], 2048.0, seed=0)
    assert caught.value.where == "corruption"
