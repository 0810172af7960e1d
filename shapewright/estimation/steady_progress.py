"""Progress that never goes back, for a work of several phases."""

from collections.abc import Mapping

from shapewright.progress import PartialProgress, Progress


class SteadyProgress:
    """Hands reports on with a fraction that never falls, and can repeat the last one.

    Repeating lets a long inner loop give its caller the chance to cancel without knowing how far the work is.
    """

    def __init__(self, parent: Progress) -> None:
        self._parent = parent
        self._fraction = 0.0
        self._message = "starting"

    def report(self, fraction: float, message: str) -> None:
        """Report at least the fraction of before."""
        self._fraction = max(self._fraction, min(max(fraction, 0.0), 1.0))
        self._message = message
        self._parent.report(self._fraction, message)

    def repeat(self) -> None:
        """Report the same again."""
        self._parent.report(self._fraction, self._message)


class Titled:
    """Puts the name of a phase before every message."""

    def __init__(self, parent: Progress, title: str) -> None:
        self._parent = parent
        self._title = title

    def report(self, fraction: float, message: str) -> None:
        """Report with the title."""
        self._parent.report(fraction, f"{self._title}: {message}")


def phases(parent: Progress, weights: Mapping[str, float]) -> dict[str, Progress]:
    """One progress for each phase; ``weights`` are their expected shares of the time, in order, in any unit.

    The names of the phases become the titles of their messages.
    """
    total = sum(weights.values())
    result: dict[str, Progress] = {}
    start = 0.0
    for title, weight in weights.items():
        end = start + weight / total
        result[title] = Titled(PartialProgress(parent, start, end), title)
        start = end
    return result
