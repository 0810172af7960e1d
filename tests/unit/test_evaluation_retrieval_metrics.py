"""Figures of rankings: worked examples, and what must hold of any ranking."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shapewright.errors import EvaluationError
from shapewright.evaluation.retrieval_metrics import (
    average_precision,
    figures_of,
    first_relevant,
    interpolated_precision,
    mean_figures,
    precision_recall,
    relevance,
    tier,
)

RANKINGS = st.lists(st.booleans(), min_size=1, max_size=40).filter(any).map(np.array)


def ranking(text: str) -> np.ndarray:
    return np.array([letter == "x" for letter in text])


def test_a_worked_example() -> None:
    found = ranking("x.x..x...x")  # relevant at places 1, 3, 6, 10
    recall, precision = precision_recall(found)
    np.testing.assert_allclose(recall, [0.25, 0.5, 0.75, 1.0])
    np.testing.assert_allclose(precision, [1 / 1, 2 / 3, 3 / 6, 4 / 10])
    assert average_precision(found) == pytest.approx((1 + 2 / 3 + 1 / 2 + 2 / 5) / 4)
    # the largest precision at recall 0, 0.1, 0.2 | 0.3 .. 0.5 | 0.6, 0.7 | 0.8 .. 1
    curve = [1.0] * 3 + [2 / 3] * 3 + [1 / 2] * 2 + [2 / 5] * 3
    np.testing.assert_allclose(interpolated_precision(found), curve)
    assert first_relevant(found)
    assert tier(found) == 2 / 4  # of the first four places
    assert tier(found, 2) == 3 / 4  # of the first eight


def test_interpolation_looks_ahead() -> None:
    found = ranking(".xx")  # precision 1/2 at recall 1/2, then 2/3
    np.testing.assert_allclose(interpolated_precision(found, 3), [2 / 3, 2 / 3, 2 / 3])
    assert average_precision(found) == pytest.approx((1 / 2 + 2 / 3) / 2)
    assert not first_relevant(found)


def test_levels_that_are_recalls_are_met_exactly() -> None:
    found = ranking("x.x.x.x.x.x.x.x.x.x.")  # ten relevant ones at the odd places
    expected = [1.0, *(j / (2 * j - 1) for j in range(1, 11))]
    np.testing.assert_allclose(interpolated_precision(found), expected)


def test_a_mean_counts_every_class_alike() -> None:
    mean = mean_figures({"a": figures_of(ranking("xxxx")), "b": figures_of(ranking(".x"))})
    assert (mean.n, mean.average_precision, mean.first_relevant) == (5, 0.75, 0.5)
    assert (mean.first_tier, mean.second_tier) == (0.5, 1.0)
    assert mean.to_dict()["precision_at_recall"] == [0.75] * 11


def test_nothing_relevant_is_no_ranking() -> None:
    for figure in (average_precision, interpolated_precision, first_relevant, tier, figures_of):
        with pytest.raises(EvaluationError, match="relevant"):
            figure(ranking("..."))
    with pytest.raises(EvaluationError, match="no class"):
        mean_figures({})
    with pytest.raises(EvaluationError, match="levels"):
        interpolated_precision(ranking("x"), 1)
    with pytest.raises(EvaluationError, match=r"scores\[1\]"):
        relevance(np.array([0.0, np.nan]), ranking("x."), ["a", "b"])


@given(RANKINGS)
def test_perfect_is_1_and_worst_is_the_reverse_of_perfect(found: np.ndarray) -> None:
    perfect, worst = np.sort(found)[::-1], np.sort(found)
    assert average_precision(perfect) == 1.0
    assert (interpolated_precision(perfect) == 1.0).all()
    assert (tier(perfect), first_relevant(perfect)) == (1.0, True)
    assert average_precision(worst) - 1e-12 <= average_precision(found) <= 1.0
    assert average_precision(worst) >= found.sum() / len(found) / found.sum()


@given(RANKINGS, st.data())
def test_a_relevant_object_that_moves_up_makes_every_figure_better_or_leaves_it(found: np.ndarray, data) -> None:
    swaps = np.flatnonzero(~found[:-1] & found[1:])
    if len(swaps) == 0:
        return
    place = data.draw(st.sampled_from(swaps.tolist()))
    better = found.copy()
    better[[place, place + 1]] = True, False
    assert average_precision(better) > average_precision(found)
    assert (interpolated_precision(better) >= interpolated_precision(found) - 1e-12).all()
    assert tier(better) >= tier(found)


@given(RANKINGS)
def test_a_curve_never_rises_and_ends_at_the_last_precision(found: np.ndarray) -> None:
    curve = interpolated_precision(found, 21)
    assert (np.diff(curve) <= 0).all()
    assert curve[-1] == precision_recall(found)[1][-1]
    assert curve[0] == precision_recall(found)[1].max()


@given(st.lists(st.tuples(st.integers(-50, 50), st.booleans()), min_size=1, max_size=30))
def test_only_the_order_of_scores_counts(items: list[tuple[int, bool]]) -> None:
    scores = np.array([score for score, _ in items], dtype=np.float64)
    relevant = np.array([is_relevant for _, is_relevant in items])
    names = [f"{number:02}" for number in range(len(items))]
    ordered = relevance(scores, relevant, names)
    np.testing.assert_array_equal(relevance(np.exp(scores / 10) * 3 + 7, relevant, names), ordered)
    shuffled = np.random.default_rng(0).permutation(len(items))
    again = relevance(scores[shuffled], relevant[shuffled], [names[row] for row in shuffled])
    np.testing.assert_array_equal(again, ordered)
