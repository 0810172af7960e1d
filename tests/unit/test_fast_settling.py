"""Options by surfaces: choices that hardly change a depth image are told apart where the surfaces lie on each other."""

from dataclasses import replace

import numpy as np
import pytest
from fast_support import candidate_at, lever, placed, random_pose, signs, target_of

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.deviation import NEAR, mutual_deviation
from shapewright.estimation.fast.fitted_model import FittedModel
from shapewright.estimation.fast.least_squares import Effort, fit
from shapewright.estimation.fast.settling import FOLLOWS, Settled, Settling
from shapewright.estimation.fast.target import Target
from shapewright.mesh import TriangleMesh

POSE = random_pose(11, 0.35, 0.2)


def settling(target: Target) -> Settling:
    def fitted(candidate: Candidate, effort: Effort) -> Candidate:
        return fit(target, candidate, effort)

    def each(work, candidates):
        return [work(one) for one in candidates]

    return Settling(target, fitted, each, np.random.default_rng(0))


@pytest.mark.parametrize(("true", "begun"), [(0.0, 1.0), (1.0, 0.0)])
def test_a_small_part_is_found_to_be_there_or_not(true: float, begun: float) -> None:
    model = FittedModel(lever())
    values = np.array([1.3, 0.8, 1.2, true])
    target = target_of(placed(model.compiled, values, POSE))
    begin = candidate_at(model, [1.3, 0.8, 1.2, begun], POSE)
    work = settling(target)
    first = work.fitted([begin])[0]
    found = work.settle(first)
    assert found.candidate.values[3] == true
    assert found.distance < 0.5 * first.distance
    np.testing.assert_allclose(found.candidate.values, values, atol=0.03)


def test_several_options_are_changed_one_after_the_other() -> None:
    model = FittedModel(signs())
    target = target_of(placed(model.compiled, [2.0, 1.0], POSE))
    work = settling(target)
    found = work.settle(work.fitted([candidate_at(model, [3.0, 0.0], POSE)])[0])
    np.testing.assert_array_equal(found.candidate.values, [2.0, 1.0])


def test_right_options_stay() -> None:
    model = FittedModel(lever())
    values = np.array([0.9, 1.4, 0.8, 1.0])
    target = target_of(placed(model.compiled, values, POSE))
    work = settling(target)
    first = work.fitted([candidate_at(model, values, POSE)])[0]
    assert first.follows
    assert work.settle(first).distance <= first.distance


def test_the_nearest_fit_comes_first() -> None:
    model = FittedModel(signs())
    target = target_of(placed(model.compiled, [1.0, 1.0], POSE))
    found = settling(target).fitted([candidate_at(model, [2.0, 0.0], POSE), candidate_at(model, [1.0, 1.0], POSE)])
    assert [one.candidate.values[0] for one in found] == [1.0, 2.0]


def test_a_model_that_cannot_follow_is_known() -> None:
    model = FittedModel(lever())
    mesh = placed(model.compiled, [1.3, 0.8, 1.2, 1.0], POSE)
    bent = mesh.vertices.copy()
    bent[:, 1] += 0.08 * np.sin(8.0 * bent[:, 0])
    found = settling(target_of(TriangleMesh(bent, mesh.faces))).fitted(
        [candidate_at(model, [1.3, 0.8, 1.2, 1.0], POSE)]
    )
    assert not found[0].follows
    assert not Settled(found[0].candidate, FOLLOWS, 0.0).follows


# ---------------------------------------------------------------------- distances between surfaces


def test_equal_surfaces_are_no_distance_apart_and_moved_ones_are() -> None:
    model = FittedModel(lever())
    values = [1.3, 0.8, 1.2, 1.0]
    target = target_of(placed(model.compiled, values, POSE))
    true = candidate_at(model, values, POSE)
    there, back = mutual_deviation(target, true)
    assert max(there, back) < 1e-5
    for shift in (0.01, 0.02):
        there, back = mutual_deviation(
            target, replace(true, translation=true.translation + np.array([0.0, 0.0, shift]))
        )
        assert 0.1 * shift < there < shift
        assert 0.1 * shift < back < shift
    far = mutual_deviation(target, replace(true, translation=true.translation + 5.0))
    np.testing.assert_allclose(far, NEAR)


def test_each_direction_sees_what_the_other_one_lacks() -> None:
    model = FittedModel(lever())
    pose = POSE
    without, with_flag = [1.3, 0.8, 1.2, 0.0], [1.3, 0.8, 1.2, 1.0]
    there, back = mutual_deviation(
        target_of(placed(model.compiled, with_flag, pose)), candidate_at(model, without, pose)
    )
    assert there > 100 * back
    there, back = mutual_deviation(
        target_of(placed(model.compiled, without, pose)), candidate_at(model, with_flag, pose)
    )
    assert back > 100 * there
