"""Figures of a classifier on clean and on corrupted meshes."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np

from shapewright.classification.evidence import auroc
from shapewright.evaluation.conditions import Condition
from shapewright.evaluation.robustness import Robustness
from shapewright.evaluation.verdict import Verdict

SHARES: Final = ("accuracy", "accuracy_pictures", "auroc_known", "accepted_known", "refused_other")
"""Names of the figures from 0 to 1, the higher the better."""


@dataclass(frozen=True)
class ConditionFigures:
    """Figures of one condition; ``None`` where no mesh counts for a figure.

    Attributes:
        n: meshes of the classes that the classifier knows.
        n_other: other meshes.
        accuracy: share of the ``n`` whose most probable class is their own, whether they were accepted or not.
        accuracy_pictures: the same by the pictures alone.
        auroc_known: area under the ROC curve of ``known``, the ``n`` against the others.
        accepted_known: share of the ``n`` that were accepted as one of the classes.
        refused_other: share of the others that were not.
        skipped: meshes that were left out of all of these.
    """

    n: int
    n_other: int
    accuracy: float | None
    accuracy_pictures: float | None
    auroc_known: float | None
    accepted_known: float | None
    refused_other: float | None
    skipped: int

    @classmethod
    def of(cls, verdicts: Iterable[Verdict], *, skipped: int = 0) -> "ConditionFigures":
        """Sum up the verdicts of one condition.

        A classifier that has not learned what is unknown gives no ``known``; the figures about that are ``None``.
        """
        inside: list[Verdict] = []
        outside: list[Verdict] = []
        for verdict in verdicts:
            (outside if verdict.is_other else inside).append(verdict)
        positive = [one.known for one in inside if one.known is not None]
        negative = [one.known for one in outside if one.known is not None]
        return cls(
            n=len(inside),
            n_other=len(outside),
            accuracy=_share(inside, lambda one: one.is_right),
            accuracy_pictures=_share(inside, lambda one: one.picture_class == one.label),
            auroc_known=auroc(np.array(positive), np.array(negative)) if positive and negative else None,
            accepted_known=_share(inside, lambda one: one.is_known) if positive else None,
            refused_other=_share(outside, lambda one: not one.is_known) if negative else None,
            skipped=skipped,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return plain values, ready for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class RobustnessFigures:
    """Figures of all conditions.

    Attributes:
        clean: of the meshes as they are.
        corrupted: of each condition.
    """

    clean: ConditionFigures
    corrupted: Mapping[Condition, ConditionFigures]

    @classmethod
    def of(cls, measured: Robustness) -> "RobustnessFigures":
        """Sum up all verdicts."""

        def figures(condition: Condition | None) -> ConditionFigures:
            return ConditionFigures.of(measured.verdicts(condition), skipped=len(measured.skipped_under(condition)))

        return cls(figures(None), {condition: figures(condition) for condition in measured.conditions})

    @property
    def by_corruption(self) -> dict[str, dict[float, ConditionFigures]]:
        """The figures by the name of the corruption and its strength."""
        table: dict[str, dict[float, ConditionFigures]] = {}
        for condition, figures in self.corrupted.items():
            table.setdefault(condition.name, {})[condition.strength] = figures
        return table

    @property
    def mean(self) -> dict[str, float | None]:
        """The mean of each figure over all corruptions and strengths, each with the same weight."""
        return mean_figures(self.corrupted.values())

    @property
    def mean_error(self) -> float | None:
        """One minus the mean accuracy: the corruption error rate of ModelNet40-C (Sun et al. 2022).

        It is not divided by the error of a reference classifier, as ImageNet-C and PointCloud-C do.
        """
        accuracy = self.mean["accuracy"]
        return None if accuracy is None else 1.0 - accuracy

    def to_dict(self) -> dict[str, Any]:
        """Return plain values, ready for JSON."""
        return {
            "clean": self.clean.to_dict(),
            "per_corruption": {
                name: {f"{strength:g}": figures.to_dict() for strength, figures in row.items()}
                for name, row in self.by_corruption.items()
            },
            "mean_accuracy": self.mean["accuracy"],
            "mean_error": self.mean_error,
            "mean": self.mean,
        }


def mean_figures(conditions: Iterable[ConditionFigures]) -> dict[str, float | None]:
    """Return the mean of each share over some conditions."""
    chosen = list(conditions)
    return {name: mean_share(getattr(figures, name) for figures in chosen) for name in SHARES}


def mean_share(values: Iterable[float | None]) -> float | None:
    """Return the mean of those that are given; ``None`` if there are none."""
    given = [value for value in values if value is not None]
    return float(np.mean(given)) if given else None


def _share(verdicts: Sequence[Verdict], test: Callable[[Verdict], bool]) -> float | None:
    return float(np.mean([test(one) for one in verdicts])) if verdicts else None
