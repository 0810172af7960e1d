"""Algorithm 2 on functions whose minima are known."""

import numpy as np
import pytest
from chair_model import armchair
from hypothesis import given, settings
from hypothesis import strategies as st

from shapewright.distances.alignment import Pose
from shapewright.errors import Cancelled
from shapewright.estimation.hill_climbing import Candidate, HillClimb, SearchSpace, hill_climb, without_pose
from shapewright.modeling import compile_model
from shapewright.progress import CallbackProgress

STEPS = (1.0, 0.5, 0.25, 0.1, 0.01)


def climb(function, start, low, high, steps=STEPS, **options) -> HillClimb:
    start = np.asarray(start, dtype=np.float64)
    space = SearchSpace(lambda rows: np.clip(rows, low, high), ((),) * len(start))
    begin = Candidate(start, function(start))
    return hill_climb(without_pose(function), begin, space, steps, **options)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.floats(-2, 4), st.floats(0, 2)), min_size=1, max_size=4))
def test_finds_the_minimum_of_a_bowl_within_the_smallest_step(pairs) -> None:
    goal = np.array([pair[0] for pair in pairs])
    seen: list[np.ndarray] = []

    def bowl(values: np.ndarray) -> float:
        seen.append(values)
        return float(((values - goal) ** 2).sum())

    incumbents: list[float] = []
    end = climb(bowl, [p[1] for p in pairs], 0.0, 2.0, on_improvement=lambda c: incumbents.append(c.distance))
    np.testing.assert_allclose(end.best.values, np.clip(goal, 0, 2), atol=0.006)
    assert incumbents == sorted(incumbents, reverse=True)
    assert len(set(incumbents)) == len(incumbents)
    assert end.best.distance == bowl(end.best.values)
    assert all((values >= 0).all() and (values <= 2).all() for values in seen)
    assert end.evaluations == len(seen) - 2


def test_values_are_never_measured_twice_without_a_pose() -> None:
    seen: list[tuple[float, ...]] = []

    def ridge(values: np.ndarray) -> float:
        seen.append(tuple(values.round(9)))
        return float(abs(values[0] - values[1]) + 0.1 * abs(values.sum() - 1.3))

    climb(ridge, [0.2, 1.7, 0.4], 0.0, 2.0)
    assert len(set(seen)) == len(seen)


def test_follows_the_printed_order_of_moves() -> None:
    visited: list[tuple[float, ...]] = []

    def distance(values: np.ndarray) -> float:
        visited.append(tuple(values))
        return float(abs(values[0] - 3.0) + abs(values[1]))

    climb(distance, [0.0, 0.0], -5.0, 5.0, steps=(1.0,))
    expected = [(0, 0), (1, 0), (1, 1), (1, -1), (2, 0), (2, 1), (2, -1), (3, 0), (3, 1), (3, -1), (4, 0)]
    assert visited == [tuple(map(float, row)) for row in expected]


def test_the_end_of_a_range_is_taken_only_if_it_is_better() -> None:
    worse_at_the_end = climb(lambda v: float((v[0] - 1.6) ** 2), [1.6], 0.5, 2.0, steps=(1.0,))
    assert worse_at_the_end.best.values[0] == 1.6
    better_at_the_end = climb(lambda v: float(-v[0]), [1.6], 0.5, 2.0, steps=(1.0,))
    assert better_at_the_end.best.values[0] == 2.0


def test_options_are_tried_instead_of_steps_and_inactive_values_cost_nothing() -> None:
    compiled = compile_model(armchair())
    columns = compiled.space.columns
    options = tuple(tuple(x for x, _ in parameter.named_options()) for parameter in compiled.model.parameters)
    goal = compiled.values_from_mapping({"back": 3, "armrests": 0, "leg_length": 1.6, "ring_height": 1.4})
    seen: list[np.ndarray] = []

    def distance(values: np.ndarray) -> float:
        seen.append(values)
        return float(np.abs(values - goal).sum() + (values[columns["back"]] == 2))  # a hill between the options

    start = compiled.base_values()
    end = hill_climb(
        without_pose(distance), Candidate(start, distance(start)), SearchSpace(compiled.settle, options), STEPS
    )
    np.testing.assert_allclose(end.best.values, goal, atol=0.006)
    rows = np.array(seen)
    np.testing.assert_array_equal(compiled.settle(rows), rows)
    assert len(np.unique(rows.round(9), axis=0)) == len(rows)
    without = rows[rows[:, columns["armrests"]] == 0]
    assert (without[:, columns["arm_height"]] == 1).all()


def test_no_parameters_and_nothing_to_gain() -> None:
    end = climb(lambda v: 1.0, [], 0.0, 1.0)
    assert (end.evaluations, end.best.distance) == (0, 1.0)
    flat = climb(lambda v: 1.0, [0.5, 0.5], 0.0, 1.0)
    assert flat.passes == len(STEPS)
    assert flat.best.values.tolist() == [0.5, 0.5]


def test_progress_never_falls_and_cancelling_leaves_the_best_so_far() -> None:
    reports: list[float] = []
    best: list[Candidate] = []

    def report(fraction: float, message: str) -> None:
        reports.append(fraction)
        assert "step" in message
        if len(reports) == 30:
            raise Cancelled

    def valley(values: np.ndarray) -> float:
        return float(((values - 1.234) ** 2).sum())

    with pytest.raises(Cancelled):
        climb(valley, [0.0] * 3, -9.0, 9.0, progress=CallbackProgress(report), on_improvement=best.append)
    assert reports == sorted(reports)
    assert best
    assert best[-1].distance == min(candidate.distance for candidate in best) < valley(np.zeros(3))


def test_what_was_beaten_at_one_pose_may_win_at_another() -> None:
    """The middle value is the start, is beaten, and is best of all from the pose that beat it."""
    first, second = Pose(), Pose(translation=np.ones(3))
    distances = {(0.0, first): 3.0, (1.0, first): 2.0, (0.0, second): 1.0}

    def evaluate(values: np.ndarray, incumbent: Candidate) -> Candidate:
        assert incumbent.pose is not None
        distance = distances.get((float(values[0]), incumbent.pose), 9.0)
        return Candidate(values, distance, second)

    space = SearchSpace(lambda rows: np.clip(rows, 0.0, 1.0), ((),))
    end = hill_climb(evaluate, Candidate(np.zeros(1), 3.0, first), space, (1.0,))
    assert (end.best.values.tolist(), end.best.distance) == ([0.0], 1.0)
