"""Putting evidence together: what must hold of scores, probabilities and of the curve of what is known."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from shapewright.classification.evidence import (
    FLOOR,
    KNOWN_THRESHOLD,
    REFUSED,
    KnownCurve,
    KnownCurves,
    auroc,
    class_probabilities,
    class_scores,
    fit_known_curve,
)

SHARES = arrays.arrays(np.float64, 5, elements=st.floats(0.001, 1.0))
DISTANCES = arrays.arrays(np.float64, 5, elements=st.floats(0.0, 3.0))
PLACES = st.integers(0, 4)
SCORES = st.lists(st.integers(0, 6).map(float), min_size=1, max_size=25)


@given(SHARES, DISTANCES, PLACES, st.floats(0.01, 0.5))
def test_more_likely_pictures_and_a_nearer_exemplar_raise_a_score(shares, distances, place, step) -> None:
    before = class_scores(shares, distances)
    likelier, nearer = shares.copy(), distances.copy()
    likelier[place] += step
    nearer[place] -= step
    others = np.arange(5) != place
    for after in (class_scores(likelier, distances), class_scores(shares, nearer)):
        assert after[place] > before[place]
        assert np.array_equal(after[others], before[others])
    assert class_scores(likelier)[place] > class_scores(shares)[place]


@given(arrays.arrays(np.float32, (3, 4), elements=st.floats(0, 1, width=32)))
def test_scores_are_bounded_below_and_of_many_meshes_at_once(shares) -> None:
    scores = class_scores(shares)
    assert np.all(scores >= np.log(FLOOR) - 1e-9)
    for row, one in zip(scores, shares, strict=True):
        assert np.allclose(class_scores(one), row)


@given(SHARES, DISTANCES, PLACES, st.floats(0.01, 0.5))
def test_probabilities_sum_to_1_and_follow_the_evidence(shares, distances, place, step) -> None:
    shares = shares / shares.sum()
    before = class_probabilities(shares, distances)
    assert before.sum() == pytest.approx(1.0)
    assert np.all(before >= 0)
    nearer = distances.copy()
    nearer[place] -= step
    after = class_probabilities(shares, nearer)
    assert after.sum() == pytest.approx(1.0)
    assert after[place] >= before[place]
    assert np.all(np.delete(after, place) <= np.delete(before, place) + 1e-12)


@given(SHARES, st.floats(0.0, 3.0))
def test_distances_that_are_all_equal_say_nothing(shares, distance) -> None:
    shares = shares / shares.sum()
    even = class_probabilities(shares, np.full(5, distance))
    assert np.allclose(even, (shares + FLOOR) / (1 + 5 * FLOOR))
    assert np.allclose(class_probabilities(shares), shares)


@given(
    middle=st.floats(-6.0, 0.0),
    gap=st.floats(1.0, 6.0),
    seed=st.integers(0, 1000),
    counts=st.tuples(st.integers(5, 60), st.integers(5, 60)),
)
@settings(deadline=None, max_examples=40)
def test_the_curve_separates_and_is_one_half_between(middle, gap, seed, counts) -> None:
    rng = np.random.default_rng(seed)
    known = middle + gap / 2 + rng.uniform(-0.1, 0.1, counts[0])
    unknown = middle - gap / 2 + rng.uniform(-0.1, 0.1, counts[1])
    is_known = np.arange(sum(counts)) < counts[0]
    curve = fit_known_curve(np.concatenate([known, unknown])[:, None], is_known)
    assert curve.slope > 0
    assert curve.probability(middle) == pytest.approx(0.5, abs=0.2), "whatever their numbers"
    assert min(curve.probability(float(score)) for score in known) > 0.5
    assert max(curve.probability(float(score)) for score in unknown) < 0.5


@pytest.mark.parametrize("distance", [1.0, 2.0, 4.0])
def test_the_curve_of_kinds_that_overlap_refuses_most_objects_of_no_class(distance: float) -> None:
    rng = np.random.default_rng(0)
    known, unknown = rng.normal(distance / 2, 1.0, 4000), rng.normal(-distance / 2, 1.0, 4000)
    curve = fit_known_curve(np.concatenate([known, unknown])[:, None], np.arange(8000) < 4000)
    assert curve.slope == pytest.approx(distance, rel=0.25), "the log odds of two such normal distributions"
    refused = np.mean([curve.probability(float(score)) < KNOWN_THRESHOLD for score in unknown])
    assert refused >= REFUSED - 0.01
    if distance < 2.5:
        assert refused == pytest.approx(REFUSED, abs=0.01)
    else:
        assert curve.intercept == pytest.approx(0.0, abs=0.2), "the honest curve refuses more than that anyway"


def test_a_class_that_others_look_like_asks_for_higher_scores() -> None:
    """Objects of no class score two higher in the second class than in the first, so its threshold is higher, too."""
    rng = np.random.default_rng(0)
    of_class, is_known = np.repeat([0, 1], 400), np.arange(800) % 2 == 0
    scores = np.full((800, 2), -20.0)
    scores[np.arange(800), of_class] = rng.normal(np.where(is_known, 4.0, 2.0 * of_class), 0.3)
    curve = fit_known_curve(scores, is_known)
    assert curve.shifts[1] - curve.shifts[0] == pytest.approx(1.0, abs=0.2), "half as much, as it lies in the middle"
    kept = (of_class == 0) | is_known
    few = fit_known_curve(scores[kept], is_known[kept])
    assert few.shifts[1] == 0.0, "no object of no class looks like it"


def test_a_few_objects_make_nobody_certain() -> None:
    """Ten objects that do not overlap would be told apart by a curve as steep as can be."""
    scores = np.array([-0.4, -0.3, *[-2.5, -2.2, -2.0] * 2, -1.9, -1.8])[:, None]
    curve = fit_known_curve(scores, np.arange(10) < 2)
    assert 0.5 < curve.probability(-0.3) < curve.probability(0.0) < 0.9999


def test_classes_that_were_added_later_have_no_shift() -> None:
    curve = KnownCurve(1.0, 0.0, (0.5, -0.25))
    assert np.allclose(curve.shifted(np.zeros((2, 3))), [[-0.5, 0.25, 0.0]] * 2)


@given(st.floats(0.01, 50.0), st.floats(-50.0, 50.0), st.floats(-10.0, 10.0), st.floats(0.0, 5.0))
def test_the_curve_rises_and_survives_a_file(slope, intercept, score, step) -> None:
    curve = KnownCurve(slope, intercept, (0.5, score))
    assert 0.0 <= curve.probability(score) <= curve.probability(score + step) <= 1.0
    assert KnownCurve.from_dict(json.loads(json.dumps(curve.to_dict()))) == curve


def test_a_scan_has_a_curve_of_its_own_where_the_file_has_one() -> None:
    whole, rough = KnownCurve(2.0, 1.0, (0.1,)), KnownCurve(3.0, 4.0)
    curves = KnownCurves.from_dict(json.loads(json.dumps(KnownCurves(whole, rough).to_dict())))
    assert (curves.whole, curves.rough) == (whole, rough)
    scores = np.array([-2.0, -1.0])
    for curve, is_rough in ((whole, False), (rough, True)):
        best = float(curves.shifted(scores, is_rough=is_rough).max())
        assert curves.probability(best) == pytest.approx(curve.probability(float(curve.shifted(scores).max())))
    earlier = KnownCurves.from_dict({"slope": 2.0, "intercept": 1.0})
    assert earlier.whole == earlier.rough == KnownCurve(2.0, 1.0)


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"slope": 1.0},
        {"slope": "steep", "intercept": 0},
        {"slope": None, "intercept": 0},
        {"slope": 1.0, "intercept": 0.0, "shifts": ["far"]},
        {"slope": 0.0, "intercept": 0.0},
    ],
)
def test_a_damaged_curve_is_refused(values) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        KnownCurve.from_dict(values)


@given(SCORES, SCORES)
def test_the_area_is_the_share_of_pairs_in_order(positive: list[float], negative: list[float]) -> None:
    pairs = [(p > n) + 0.5 * (p == n) for p in positive for n in negative]
    assert auroc(np.array(positive), np.array(negative)) == pytest.approx(np.mean(pairs))


@given(SCORES, SCORES)
def test_exchanging_the_kinds_turns_the_area_around(positive: list[float], negative: list[float]) -> None:
    one, other = np.array(positive), np.array(negative)
    assert auroc(one, other) + auroc(other, one) == pytest.approx(1.0)
