"""What the fast estimator says of its fits, and its last fit by surfaces alone."""

from dataclasses import replace

import numpy as np
import pytest

from shapewright.estimation import EstimationSettings, Query
from shapewright.estimation.determination.factors import IntervalFactors
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.deviation import candidate_deviation, mutual_deviation
from shapewright.estimation.fast.fitted_model import FittedModel
from shapewright.estimation.fast.following import FOLLOWED, SCATTERED, follow_surface
from shapewright.estimation.fast.judging import determine_fit, measure_sensitivity
from shapewright.estimation.fast.measure import fine_distance
from shapewright.estimation.fast.target import Target
from shapewright.estimation.prepared_query import PreparedQuery
from shapewright.evaluation.corruptions import CORRUPTIONS
from shapewright.modeling import Recorder, compile_model, group

FACTORS = IntervalFactors(0.5)


def true_fit(compiled, values, *, query=None):
    """A query and the fit that is true; the query is the instance, or a mesh in the same place."""
    values = compiled.settle(np.asarray(values, dtype=float)[None])[0]
    prepared = PreparedQuery(Query(query or compiled.instance(values)), EstimationSettings())
    pose = prepared.to_file.inverse()
    target = Target(prepared.mesh, prepared.zbuffer, np.random.default_rng(0))
    return target, Candidate(FittedModel(compiled), values, pose.rotation, pose.translation, pose.scale)


def box_with(build):
    recorder = Recorder("box", "block")
    build(recorder)
    return compile_model(recorder.build())


def length(most):
    def build(recorder):
        recorder.parameter("length", "Length", 0.5, most, unit="m", base_value=1.0)
        recorder.parameter("height", "Height", 0.5, 2.0, unit="m", base_value=2.0)
        whole = group(recorder.box(1.0, 1.0, 2.0).whole, frame="world")
        recorder.scale(whole, 1.0, "u", size="length")
        recorder.scale(whole, 1.0, "z", size="height")

    return build


@pytest.fixture(scope="module")
def glass(library_models):
    compiled = compile_model(library_models["glass_with_stem"])
    return compiled, compiled.random_values(np.random.default_rng(0), 1)[0]


@pytest.fixture(scope="module")
def noisy(glass):
    compiled, values = glass
    mesh = CORRUPTIONS["noise"](compiled.instance(values), 0.005, np.random.default_rng(0))
    return true_fit(compiled, values, query=mesh)


def test_a_known_scale_determines_lengths_and_a_free_one_their_ratios(glass):
    target, candidate = true_fit(*glass)
    known = determine_fit(target, candidate, scale_known=True, factors=FACTORS)
    free = determine_fit(target, candidate, scale_known=False, factors=FACTORS)
    judged = [status for status in known.statuses if status not in (None, "inactive")]
    assert judged.count("determined") >= 0.6 * len(judged)
    assert free.statuses.count("determined_up_to_scale") > 0
    assert known.statuses.count("determined_up_to_scale") == 0
    parameters = candidate.model.compiled.model.parameters
    values = dict(zip([p.name for p in parameters], candidate.values, strict=True))
    bases = {p.name: p.base_value or 1.0 for p in parameters}
    assert free.ratios
    for ratio in free.ratios:
        low, high = ratio.interval
        true = values[ratio.numerator] * bases[ratio.numerator] / values[ratio.denominator] / bases[ratio.denominator]
        assert low <= true <= high


def test_the_truth_leaves_hardly_any_residual_and_no_gradient(glass):
    target, candidate = true_fit(*glass)
    sensitivity = measure_sensitivity(target, candidate)
    assert sensitivity.mean_residual < 1e-4
    assert sensitivity.jacobian.shape[1] == len(sensitivity.gradient) + 7
    off = measure_sensitivity(target, replace(candidate, values=candidate.model.settle(0.9 * candidate.values)))
    assert off.mean_residual > 5e-3
    assert np.linalg.norm(sensitivity.gradient) < 0.02 * np.linalg.norm(off.gradient)


def test_noise_averages_out_of_intervals(glass, noisy):
    """The intervals are wider than without noise, but by far less than the size of single residuals would make them."""
    target, candidate = noisy
    left = candidate_deviation(target, candidate)
    assert left.systematic < SCATTERED * left.mean
    found = determine_fit(target, candidate, scale_known=True, factors=FACTORS)
    clean = determine_fit(*true_fit(*glass), scale_known=True, factors=FACTORS)
    assert found.statuses.count("determined") < clean.statuses.count("determined")
    assert (found.half_widths[list(found.columns)] > clean.half_widths[list(clean.columns)]).all()
    assert found.statuses.count("determined") > 0


def test_parameters_that_undo_each_other_are_not_determined():
    def build(recorder):
        recorder.parameter("neck", "Neck", 0.5, 2.0, unit="m", base_value=1.0)
        recorder.parameter("stem", "Stem", 0.5, 2.0, unit="m", base_value=1.0)
        recorder.parameter("width", "Width", 0.5, 2.0, unit="m", base_value=1.0)
        box = recorder.box(1.0, 1.0, 3.0)
        recorder.scale(group(box.whole, frame="world"), 1.0, "u", size="width")
        recorder.drag(box.top, 1.0, length="neck")
        recorder.drag(box.top, 1.0, length="stem")

    found = determine_fit(*true_fit(box_with(build), [1.0, 1.2, 0.9]), scale_known=True, factors=FACTORS)
    assert found.statuses == ("not_determined", "not_determined", "determined")
    (combination,) = found.combinations
    assert combination.weights == pytest.approx({"neck": 1.0, "stem": 1.0}, rel=0.05)


def test_a_query_beyond_the_range_pulls_its_value_to_the_end():
    longer = box_with(length(3.0))
    query = longer.instance(longer.settle(np.array([[2.3, 1.0]]))[0])
    found = determine_fit(*true_fit(box_with(length(2.0)), [2.0, 1.0], query=query), scale_known=True, factors=FACTORS)
    assert found.statuses[0] == "at_range_end"
    inside = determine_fit(*true_fit(box_with(length(3.0)), [2.0, 1.0]), scale_known=True, factors=FACTORS)
    assert inside.statuses == ("determined", "determined")


def test_an_instance_without_area_is_not_judged(glass):
    target, candidate = true_fit(*glass)
    flat = FittedModel(candidate.model.compiled)
    flat.surfaces = {n: replace(rows, entries=0.0 * rows.entries) for n, rows in candidate.model.surfaces.items()}
    assert determine_fit(target, replace(candidate, model=flat), scale_known=True, factors=FACTORS) is None
    assert candidate_deviation(target, replace(candidate, model=flat)) is None
    assert mutual_deviation(target, replace(candidate, model=flat)) is None


def test_the_last_fit_takes_noise_for_noise(noisy):
    """A z-buffer distance falls as a fit swells with the noise; distances along normals stay with the shape."""
    target, true = noisy
    off = 0.04 * true.model.widths * np.where(np.arange(len(true.values)) % 2, 1.0, -1.0) * ~true.model.is_option
    began = fine_distance(target, replace(true, values=true.model.settle(true.values + off)))
    least = follow_surface(target, began, keeps_scale=True).zbuffer
    for share in (0.2, 0.55):  # closest points pull a thin tube to its neighbor, and only depth images show it
        lost = follow_surface(target, replace(began, zbuffer=share * least), keeps_scale=True)
        assert lost.zbuffer == share * least, "a fit that is so much farther by depth has lost its query"
    for pretended in (began.zbuffer, 0.7 * least):
        found = follow_surface(target, replace(began, zbuffer=pretended), keeps_scale=True)
        assert found.zbuffer == fine_distance(target, found).zbuffer, "the distance is the real one"
        determined = determine_fit(target, found, scale_known=True, factors=FACTORS)
        columns = [column for column, status in enumerate(determined.statuses) if status == "determined"]
        shares = np.abs(found.values - true.values)[columns] / true.model.widths[columns]
        assert np.median(shares) < 0.02
        assert candidate_deviation(target, found).systematic < FOLLOWED


def test_the_last_fit_leaves_an_answer_that_the_model_cannot_follow(glass):
    """What is systematic is no noise: the z-buffer distance decides."""
    compiled, values = glass
    crooked = compiled.instance(values)
    bent = crooked.vertices.copy()
    bent[:, 0] += 0.15 * np.ptp(bent[:, 2]) * np.sin(4.0 * (bent[:, 2] - bent[:, 2].min()) / np.ptp(bent[:, 2]))
    target, candidate = true_fit(compiled, values, query=replace(crooked, vertices=bent))
    answer = replace(candidate, zbuffer=0.0)
    assert follow_surface(target, answer) is answer
    measured = fine_distance(target, candidate)
    assert follow_surface(target, measured).zbuffer <= measured.zbuffer
