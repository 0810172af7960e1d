"""Starts, least squares and the polish: each ends nearer than it began, within the ranges, and keeps what is known."""

from dataclasses import replace

import numpy as np
import pytest
import simple_shapes
from fast_support import angle_deg, candidate_at, lever, placed, random_pose, rigid, signs, target_of

from shapewright.errors import Cancelled, MeshError
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import FINE, FittedModel
from shapewright.estimation.fast.least_squares import Effort, fit
from shapewright.estimation.fast.measure import drawn, fine_distance, outline_distance
from shapewright.estimation.fast.polish import Polish
from shapewright.estimation.fast.search import APPROACHES, APPROACHES_OF_SEVERAL, Known, Search
from shapewright.estimation.fast.settling import Settling
from shapewright.estimation.fast.starts import find_starts, spread
from shapewright.estimation.fast.target import Target, normalized
from shapewright.mesh import TriangleMesh

TRUE = np.array([1.3, 0.8, 1.2, 1.0])
POSE = random_pose(11, 0.35, 0.2)
SURFACE = Effort(rounds=12, points=800, steps=FINE, damping=1e-4)
OUTLINES = Effort(rounds=8, points=400, steps=FINE, outline=400)


@pytest.fixture(scope="module")
def model() -> FittedModel:
    return FittedModel(lever())


@pytest.fixture(scope="module")
def truth(model: FittedModel) -> Candidate:
    return candidate_at(model, TRUE, POSE)


@pytest.fixture(scope="module")
def target(model: FittedModel) -> Target:
    return target_of(placed(model.compiled, TRUE, POSE))


def off(truth: Candidate, target: Target, *, values=(0.1, -0.08, -0.1), turn=0.1, shift=0.05, growth=0.1) -> Candidate:
    """Return the truth after a step; values in shares of their ranges."""
    columns = truth.model.free_columns(truth.values)[0]
    step = np.array([*values, turn, -turn, turn, shift, -shift, shift, growth])
    return truth.moved(columns, step, target.center)


def assert_true(found: Candidate, tolerance: float = 0.01) -> None:
    np.testing.assert_allclose(found.values, TRUE, atol=1.5 * tolerance)
    assert angle_deg(found.rotation, POSE.rotation) < 100 * tolerance
    assert found.scale == pytest.approx(POSE.scale, rel=tolerance)
    np.testing.assert_allclose(found.translation, POSE.translation, atol=tolerance)


# ---------------------------------------------------------------------- the query


def test_the_query_is_sampled_evenly_and_its_first_samples_too(target: Target) -> None:
    mesh = TriangleMesh(target.vertices, target.triangles)
    from shapewright.distances.triangles import TriangleDistance

    assert TriangleDistance(mesh)(target.points).max() < 1e-12
    np.testing.assert_allclose(target.normals, mesh.face_normals[target.faces], atol=1e-12)
    some = target.points[:500]
    np.testing.assert_allclose(some.mean(axis=0), target.points.mean(axis=0), atol=0.05)
    near = target.tree.query(target.points[:1000], k=2)[0][:, 1]
    assert 0.5 < target.spacing(len(target.points)) / near.mean() < 3.0
    for frame in target.frames:
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-9)
        assert np.linalg.det(frame) == pytest.approx(1.0)


def test_the_distance_of_a_candidate_is_that_of_its_mesh(model: FittedModel, target: Target) -> None:
    from shapewright.distances.zbuffer import ZBufferTarget

    candidate = candidate_at(model, [0.9, 1.1, 0.7, 0.0], random_pose(3, 0.4))
    mesh = placed(model.compiled, candidate.values, candidate.pose)
    expected = ZBufferTarget(target.vertices, target.triangles, 128).distance(mesh.vertices, mesh.faces).normalized
    assert fine_distance(target, candidate).zbuffer == pytest.approx(expected, abs=1e-6)
    assert outline_distance(target, candidate).zbuffer == pytest.approx(expected, abs=1e-6)


def test_a_query_without_area_is_refused() -> None:
    line = TriangleMesh(np.array([[-1.0, 0, 0], [0, 0, 0], [1, 0, 0]]), np.array([[0, 1, 2]]))
    with pytest.raises(MeshError, match="no area"):
        target_of(line)


# ---------------------------------------------------------------------- starts


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_start_is_near_the_truth_whatever_the_pose(model: FittedModel, seed: int) -> None:
    pose = random_pose(seed, 0.3, 0.3)
    target = target_of(placed(model.compiled, TRUE, pose))
    rows = model.compiled.random_values(np.random.default_rng(seed), 30)
    starts = find_starts(target, model, rows, 5)
    assert [one.misfit for one in starts] == sorted(one.misfit for one in starts)
    assert len(starts) == 5
    assert min(angle_deg(one.rotation, pose.rotation) for one in starts) < 25.0
    assert starts[0].misfit < 0.1


def test_starts_keep_to_what_is_known(model: FittedModel, target: Target, truth: Candidate) -> None:
    rows = model.compiled.random_values(np.random.default_rng(0), 10)
    starts = find_starts(target, model, rows, 5, known_rotations=POSE.rotation[None], known_scale=POSE.scale)
    assert {one.scale for one in starts} == {POSE.scale}
    assert min(angle_deg(one.rotation, POSE.rotation) for one in starts) < 20.0
    exact = find_starts(target, model, rows, 5, known_rotations=POSE.rotation[None], keeps_rotation=True)
    for one in exact:
        np.testing.assert_array_equal(one.rotation, POSE.rotation)


def test_every_model_keeps_starts_of_its_own_and_no_orientation_has_many(model: FittedModel, truth: Candidate) -> None:
    other = candidate_at(FittedModel(rigid()), np.zeros(0), POSE)
    good = [replace(truth, misfit=0.01 * k, rotation=random_pose(k).rotation) for k in range(1, 6)]
    bad = [replace(other, misfit=0.1 * k) for k in range(1, 6)]
    chosen = spread([*good, *bad], 4, 2)
    assert [one.misfit for one in chosen] == pytest.approx([0.01, 0.02, 0.03, 0.04, 0.1, 0.2])
    assert len(spread(bad, 4, 2)) == 2  # all have one orientation, and the same options


def test_candidates_of_one_orientation_go_on_with_different_options(model: FittedModel, truth: Candidate) -> None:
    other = replace(truth, values=model.settle(np.array([1.3, 0.8, 1.2, 0.0])))
    everything = [replace(one, misfit=0.01 * k) for k in range(1, 4) for one in (truth, other)]
    assert [one.values[3] for one in spread(everything, 10, 0)] == [1.0, 0.0, 1.0, 0.0]
    assert len(spread(everything, 10, 0, of_one_turn=1)) == 1


def test_a_comparison_ends_where_the_first_views_show_that_it_is_farther(target: Target, truth: Candidate) -> None:
    near, far = drawn(truth), drawn(replace(truth, translation=truth.translation + 0.3))
    best, worse = target.compared(*near), target.compared(*far)
    assert normalized(best) < 0.01 < normalized(worse)
    assert target.compared(*far, better_than=best) is None
    np.testing.assert_array_equal(target.compared(*near, better_than=worse), best)


# ---------------------------------------------------------------------- least squares


@pytest.mark.parametrize("effort", [SURFACE, OUTLINES], ids=["surface", "outlines"])
def test_least_squares_find_pose_and_values_together(target: Target, truth: Candidate, effort: Effort) -> None:
    begun = off(truth, target)
    found = fit(target, begun, effort)
    assert_true(found, 0.01 if effort is SURFACE else 0.05)
    before = fit(target, begun, replace(effort, rounds=0))
    if effort.outline:
        assert found.zbuffer < 0.5 * before.zbuffer
    else:
        assert found.misfit < 0.3 * before.misfit


def test_what_is_known_stays_exactly(target: Target, truth: Candidate) -> None:
    begun = off(truth, target, turn=0.0, growth=0.0)
    both = fit(target, begun, SURFACE, keeps_scale=True, keeps_rotation=True)
    assert both.scale == POSE.scale
    np.testing.assert_allclose(both.rotation, POSE.rotation, atol=1e-15)
    assert_true(both)
    begun = off(truth, target, growth=0.0)
    assert fit(target, begun, SURFACE, keeps_scale=True).scale == POSE.scale


def test_the_ranges_are_kept_although_the_query_is_beyond_them(model: FittedModel) -> None:
    compiled = model.compiled
    longest = compiled.values_from_mapping({"foot": 2.0, "tower": 2.0, "width": 1.0, "flag": 1.0})
    stretched = placed(compiled, longest, random_pose(0)).vertices * (1.6, 1.0, 1.3)
    mesh = TriangleMesh(0.15 * stretched, compiled.instance(longest).faces)
    target = target_of(mesh)
    begun = candidate_at(model, [1.9, 1.9, 1.0, 1.0], random_pose(0, 0.15))
    found = fit(target, begun, SURFACE, keeps_scale=True)
    lowest, highest = (bounds[0] for bounds in compiled.space.ranges(found.values[None]))
    assert (found.values >= lowest).all()
    assert (found.values <= highest).all()
    np.testing.assert_array_equal(model.settle(found.values), found.values)


def test_no_round_makes_the_answer_worse(target: Target, truth: Candidate) -> None:
    """The best round is returned: far from the truth, where steps may well lead astray, it is still no worse."""
    for seed in range(4):
        begun = replace(truth, rotation=random_pose(seed).rotation)
        at_start = fit(target, begun, replace(SURFACE, rounds=0))
        assert fit(target, begun, SURFACE).misfit <= at_start.misfit


def test_an_instance_without_area_is_returned_as_it_is(
    model: FittedModel, target: Target, truth: Candidate, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(FittedModel, "samples", lambda *_: None)
    assert fit(target, truth, SURFACE) is truth


def test_a_model_without_parameters_is_only_moved() -> None:
    model = FittedModel(rigid())
    pose = random_pose(5, 0.4, 0.1)
    target = target_of(placed(model.compiled, [], pose))
    begun = candidate_at(model, [], pose).moved(np.zeros(0, dtype=int), np.full(7, 0.08), target.center)
    found = fit(target, begun, SURFACE)
    assert angle_deg(found.rotation, pose.rotation) < 0.5
    assert found.scale == pytest.approx(pose.scale, rel=0.01)


def test_every_round_of_least_squares_can_be_stopped(target: Target, truth: Candidate) -> None:
    calls = []

    def checkpoint() -> None:
        calls.append(None)
        if len(calls) == 3:
            raise Cancelled

    with pytest.raises(Cancelled):
        fit(target, truth, SURFACE, checkpoint=checkpoint)
    assert len(calls) == 3


# ---------------------------------------------------------------------- polish


def nothing() -> None:
    pass


def test_the_polish_comes_nearer_and_keeps_the_ranges(target: Target, truth: Candidate) -> None:
    begun = fit(target, off(truth, target), replace(OUTLINES, rounds=1))
    polish = Polish.begin(target, begun)
    before = polish.best.zbuffer
    best = [before]
    for _ in range(6):
        found = polish.round(nothing)
        assert polish.gain == pytest.approx(best[-1] - found.zbuffer)
        best.append(found.zbuffer)
        np.testing.assert_array_equal(found.model.settle(found.values), found.values)
    assert best == sorted(best, reverse=True)
    assert best[-1] < 0.7 * before
    assert outline_distance(target, polish.best).zbuffer == polish.best.zbuffer


def test_the_polish_keeps_what_is_known(target: Target, truth: Candidate) -> None:
    begun = fit(target, off(truth, target, turn=0.0, growth=0.0), replace(OUTLINES, rounds=1), keeps_scale=True,
                keeps_rotation=True)  # fmt: skip
    polish = Polish.begin(target, begun, keeps_scale=True, keeps_rotation=True)
    found = polish.round(nothing)
    assert found.scale == begun.scale
    np.testing.assert_array_equal(found.rotation, begun.rotation)
    assert not polish.is_done


def test_a_stopped_polish_holds_its_best(target: Target, truth: Candidate) -> None:
    polish = Polish.begin(target, fit(target, off(truth, target), replace(OUTLINES, rounds=1)))
    before = polish.best.zbuffer
    left = [4]

    def checkpoint() -> None:
        left[0] -= 1
        if left[0] == 0:
            raise Cancelled

    with pytest.raises(Cancelled):
        polish.round(checkpoint)
    assert polish.best.zbuffer <= before
    assert polish.evaluations <= 1 + 2 * 3


def test_the_polish_ends_when_no_axis_has_a_step_left(target: Target, truth: Candidate) -> None:
    measured = fit(target, truth, replace(OUTLINES, rounds=2))
    polish = Polish.begin(target, measured, first_step=5e-4)
    rounds = iter(range(100))
    while not polish.is_done:
        assert next(rounds) < 99
        polish.round(nothing)
    again = polish.evaluations
    polish.round(nothing)
    assert polish.evaluations == again
    assert polish.gain == 0.0


# ---------------------------------------------------------------------- beginning again


class CountedSearch(Search):
    """A search that counts how often it begins; at first it may only start from one candidate that is far off."""

    hopeless = 0
    begun = 0

    def _begin(self) -> list[Candidate]:
        self.begun += 1
        return self.hopeless_starts() if self.begun <= self.hopeless else super()._begin()

    def hopeless_starts(self) -> list[Candidate]:
        model = self.models[0]
        far = candidate_at(model, [0.5, 2.0, 0.5, 1.0], random_pose(5, 0.02, 0.9))
        self._keep("start", outline_distance(self.target, far))
        return [far]


def searched(models: list[FittedModel], query: TriangleMesh, hopeless: int = 0) -> CountedSearch:
    search = CountedSearch(target_of(query), models, [Known()] * len(models), lambda fraction, message: None)
    search.hopeless = hopeless
    search.run(np.random.default_rng(0))
    return search


def test_a_solved_query_is_not_searched_again(model: FittedModel) -> None:
    search = searched([model], placed(model.compiled, TRUE, POSE))
    assert search.begun == 1
    assert search.settled is not None


def test_a_search_whose_starts_lead_nowhere_begins_again(model: FittedModel) -> None:
    search = searched([model], placed(model.compiled, TRUE, POSE), hopeless=1)
    assert search.begun == 2
    assert search.settled is not None
    assert_true(search.settled.candidate)


def test_a_query_that_no_model_follows_is_given_up_in_the_end(model: FittedModel) -> None:
    rng = np.random.default_rng(3)
    spikes = TriangleMesh(rng.uniform(-1.0, 1.0, (120, 3)), np.arange(120).reshape(-1, 3))
    for models, times in (([model], APPROACHES), ([model, FittedModel(signs())], APPROACHES_OF_SEVERAL)):
        search = searched(models, spikes)
        assert search.settled is None
        assert 2 <= search.begun <= times, "fits that are equally far may agree"
        assert search.finished == {"start", "fit", "polish"}


def test_beginnings_that_agree_are_the_last_and_settle_options_once(
    model: FittedModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A query with a part that the model lacks: it is never solved, and each beginning finds the same fit."""
    settled: list[float] = []
    settle = Settling.settle
    monkeypatch.setattr(Settling, "settle", lambda self, best: settled.append(best.distance) or settle(self, best))
    whole = placed(model.compiled, TRUE, POSE)
    low, high = whole.bounds
    knob = simple_shapes.box((0.12 * float((high - low).max()),) * 3, 0.5 * (low + high) + [0.0, 0.0, 0.1])
    search = searched([model], simple_shapes.joined([whole, knob]))
    assert not search.settled.distance < 1e-3
    assert search.begun == 2
    assert len(settled) == 1


def test_a_later_beginning_without_any_start_changes_nothing(model: FittedModel) -> None:
    class Exhausted(CountedSearch):
        def _begin(self) -> list[Candidate]:
            found = super()._begin()
            return found if self.begun == 1 else []

    rng = np.random.default_rng(3)
    target = target_of(TriangleMesh(rng.uniform(-1.0, 1.0, (120, 3)), np.arange(120).reshape(-1, 3)))
    search = Exhausted(target, [model], [Known()], lambda fraction, message: None)
    search.run(rng)
    assert search.begun == APPROACHES
    assert search.finished == {"start", "fit", "polish"}


def test_a_model_without_parameters_has_one_beginning() -> None:
    rng = np.random.default_rng(3)
    spikes = TriangleMesh(rng.uniform(-1.0, 1.0, (120, 3)), np.arange(120).reshape(-1, 3))
    assert searched([FittedModel(rigid())], spikes).begun == 1
