"""The trade-off behind a threshold of ``known``, as the training of a classifier measured it (ours).

A lower threshold accepts more objects of the classes, but also more objects of no class.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

THRESHOLDS: Final = tuple(number / 20 for number in range(21))
"""The thresholds that are measured."""


@dataclass(frozen=True)
class TradeOffPoint:
    """The shares that one threshold accepts and refuses.

    Args:
        threshold: objects whose ``known`` is below are answered with ``unknown``.
        accepted_known: share of the trial variations that are accepted. Most come from models that were learned, the
            others from models that were left out.
        refused_other: share of the objects of no class that are answered with ``unknown``.
    """

    threshold: float
    accepted_known: float
    refused_other: float

    def to_dict(self) -> dict[str, float]:
        """Return plain values, ready for JSON."""
        return {
            "threshold": self.threshold,
            "accepted_known": self.accepted_known,
            "refused_other": self.refused_other,
        }

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "TradeOffPoint":
        """Read :meth:`to_dict`; KeyError, TypeError or ValueError if it is something else."""
        return cls(float(values["threshold"]), float(values["accepted_known"]), float(values["refused_other"]))


def measure_trade_off(inside: Sequence[float], outside: Sequence[float]) -> tuple[TradeOffPoint, ...]:
    """Measure every threshold of :data:`THRESHOLDS`.

    Args:
        inside: ``known`` of objects of the classes.
        outside: ``known`` of objects of no class.
    """
    return tuple(
        TradeOffPoint(
            threshold,
            sum(known >= threshold for known in inside) / len(inside),
            sum(known < threshold for known in outside) / len(outside),
        )
        for threshold in THRESHOLDS
    )


def trade_off_key(*, geometry: bool) -> str:
    """Return the name of the trade-off among the figures of a training, with exemplars or by pictures alone."""
    return "trade_off" if geometry else "trade_off_pictures"


def trade_off_of(metrics: Mapping[str, Any], *, geometry: bool) -> tuple[TradeOffPoint, ...] | None:
    """Read the trade-off from the figures of a training; ``None`` if they have none.

    Args:
        metrics: the figures.
        geometry: whether the classifier has exemplars.

    Raises:
        KeyError, TypeError or ValueError: it is something else.
    """
    points = metrics.get(trade_off_key(geometry=geometry))
    return None if points is None else tuple(TradeOffPoint.from_dict(point) for point in points)
