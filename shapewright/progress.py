"""Progress that is injected: long loops report to it, callers decide what becomes of the report."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

from shapewright.errors import Cancelled


@runtime_checkable
class Progress(Protocol):
    """What a long computation reports to.

    Implementations may throttle. ``report`` may raise :class:`shapewright.errors.Cancelled`, so callers keep
    nothing half-written across a report.
    """

    def report(self, fraction: float, message: str) -> None:
        """Tell that ``fraction`` (0 to 1) of the work is done and what is being done now."""


class NullProgress:
    """Ignores every report; the default of all long computations."""

    def report(self, fraction: float, message: str) -> None:
        """Do nothing."""


NULL_PROGRESS = NullProgress()


@dataclass(frozen=True)
class CallbackProgress:
    """Hands every report to a function; raise ``Cancelled`` inside it to stop the work."""

    callback: Callable[[float, str], None]

    def report(self, fraction: float, message: str) -> None:
        """Call the function."""
        self.callback(fraction, message)


@dataclass(frozen=True)
class PartialProgress:
    """A part of a larger job: maps 0..1 onto ``start``..``end`` of its parent."""

    parent: Progress
    start: float
    end: float

    def report(self, fraction: float, message: str) -> None:
        """Report the share of the whole job to the parent."""
        bounded = min(max(fraction, 0.0), 1.0)
        self.parent.report(self.start + bounded * (self.end - self.start), message)


@dataclass
class LimitedProgress:
    """Hands reports on until a limit is reached, then cancels the work; the clock is the caller's.

    Attributes:
        parent: told everything before the limit.
        is_over: whether the limit is reached.
        reached: whether the work was cancelled for it.
    """

    parent: Progress
    is_over: Callable[[], bool]
    reached: bool = field(default=False, init=False)

    def report(self, fraction: float, message: str) -> None:
        """Report to the parent.

        Raises:
            Cancelled: the limit is reached, or the parent cancels.
        """
        if self.is_over():
            self.reached = True
            raise Cancelled("the time is up")
        self.parent.report(fraction, message)
