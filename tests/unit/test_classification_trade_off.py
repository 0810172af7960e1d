"""What thresholds of ``known`` accept and refuse."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shapewright.classification.trade_off import THRESHOLDS, TradeOffPoint, measure_trade_off, trade_off_of

shares = st.lists(st.floats(0.0, 1.0), min_size=1, max_size=20)


def test_shares_are_counted_at_each_threshold() -> None:
    points = {point.threshold: point for point in measure_trade_off([0.2, 0.5, 0.9, 0.95], [0.1, 0.6])}
    assert tuple(points) == THRESHOLDS
    assert points[0.5] == TradeOffPoint(0.5, 0.75, 0.5)
    assert points[0.95] == TradeOffPoint(0.95, 0.25, 1.0)


@given(shares, shares)
def test_a_higher_threshold_accepts_less_and_refuses_more(inside: list[float], outside: list[float]) -> None:
    points = measure_trade_off(inside, outside)
    accepted, refused = [p.accepted_known for p in points], [p.refused_other for p in points]
    assert (accepted[0], refused[0]) == (1.0, 0.0)
    assert accepted == sorted(accepted, reverse=True)
    assert refused == sorted(refused)


def test_a_trade_off_survives_a_file() -> None:
    points = measure_trade_off([0.8], [0.3])
    metrics = json.loads(json.dumps({"trade_off": [point.to_dict() for point in points]}))
    assert trade_off_of(metrics, geometry=True) == points
    assert trade_off_of(metrics, geometry=False) is None, "an older file, or one without exemplars"


@pytest.mark.parametrize("damaged", [7, [7], [{}], [{"threshold": "low", "accepted_known": 1, "refused_other": 0}]])
def test_a_damaged_trade_off_is_refused(damaged: object) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        trade_off_of({"trade_off": damaged}, geometry=True)
