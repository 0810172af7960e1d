"""A limit on the time of a computation; the library itself has no clock."""

import time
from dataclasses import dataclass

from shapewright.errors import Cancelled
from shapewright.progress import Progress


@dataclass(frozen=True)
class Deadline:
    """Hands reports on until a moment, then cancels.

    Args:
        parent: told everything before the moment.
        monotonic_s: the moment, on the clock of :func:`time.monotonic`.
    """

    parent: Progress
    monotonic_s: float

    def report(self, fraction: float, message: str) -> None:
        """Report, or raise Cancelled if the moment is past."""
        if time.monotonic() >= self.monotonic_s:
            raise Cancelled("the time is up")
        self.parent.report(fraction, message)
