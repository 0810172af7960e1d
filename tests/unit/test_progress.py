"""Progress that is handed on, up to a limit."""

import pytest

from shapewright.errors import Cancelled
from shapewright.progress import CallbackProgress, LimitedProgress


def test_reports_pass_until_the_limit_is_reached() -> None:
    said: list[tuple[float, str]] = []
    limited = LimitedProgress(CallbackProgress(lambda *report: said.append(report)), lambda: len(said) >= 2)
    limited.report(0.1, "one")
    limited.report(0.2, "two")
    assert not limited.reached
    with pytest.raises(Cancelled):
        limited.report(0.3, "three")
    assert limited.reached
    assert said == [(0.1, "one"), (0.2, "two")]


def test_a_parent_that_cancels_is_not_a_limit_that_was_reached() -> None:
    def cancel(fraction: float, message: str) -> None:
        raise Cancelled

    limited = LimitedProgress(CallbackProgress(cancel), lambda: False)
    with pytest.raises(Cancelled):
        limited.report(0.1, "one")
    assert not limited.reached
