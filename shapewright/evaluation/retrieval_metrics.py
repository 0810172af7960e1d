"""How good a ranking is, told from which of its places hold a relevant object.

A ranking is an array of truth values, the best place first. Every relevant object is somewhere in it, as retrieval
here orders the whole collection. Definitions after C. D. Manning, P. Raghavan and H. Schütze, *Introduction to
Information Retrieval* (2008), section 8.4, and for the tiers P. Shilane et al., *The Princeton Shape Benchmark*
(2004), section 4.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Bool, Float

from shapewright.errors import EvaluationError

LEVELS: Final = 11
"""Recall levels of an interpolated curve: 0, 0.1, ..., 1."""


def relevance(
    scores: Float[np.ndarray, " N"], relevant: Bool[np.ndarray, " N"], names: Sequence[str]
) -> Bool[np.ndarray, " N"]:
    """Order what is relevant by falling score, equal scores by name.

    Raises:
        EvaluationError: a score that is not a number.
    """
    if np.isnan(scores).any():
        raise EvaluationError("a score is not a number", where=f"scores[{int(np.isnan(scores).argmax())}]")
    order = sorted(range(len(scores)), key=lambda row: (-scores[row], names[row]))
    return np.asarray(relevant[order], dtype=bool)


def precision_recall(ranking: Bool[np.ndarray, " N"]) -> tuple[Float[np.ndarray, " R"], Float[np.ndarray, " R"]]:
    """Recall and precision after each relevant object: j / R, and j / its place.

    Raises:
        EvaluationError: nothing is relevant.
    """
    places = _places(ranking)
    hits = np.arange(1, len(places) + 1)
    return hits / len(places), hits / places


def average_precision(ranking: Bool[np.ndarray, " N"]) -> float:
    """The mean over the relevant objects of the precision at their places, not interpolated (Manning, eq. 8.8).

    Raises:
        EvaluationError: nothing is relevant.
    """
    return float(precision_recall(ranking)[1].mean())


def interpolated_precision(ranking: Bool[np.ndarray, " N"], levels: int = LEVELS) -> Float[np.ndarray, " L"]:
    """The largest precision at any recall of at least each level; levels are spread evenly over 0 to 1.

    Raises:
        EvaluationError: nothing is relevant, or fewer than two levels.
    """
    if levels < 2:
        raise EvaluationError("a curve has at least two levels", where="levels")
    recall, precision = precision_recall(ranking)
    best_from = np.maximum.accumulate(precision[::-1])[::-1]
    # in whole numbers, as 3 / 10 of 10 objects is the third of them
    first = -(-np.arange(levels) * len(recall) // (levels - 1))
    return np.asarray(best_from[np.maximum(first, 1) - 1])


def first_relevant(ranking: Bool[np.ndarray, " N"]) -> bool:
    """Whether the first place holds a relevant object; its mean over queries is *nearest neighbour*."""
    _places(ranking)
    return bool(ranking[0])


def tier(ranking: Bool[np.ndarray, " N"], multiple: int = 1) -> float:
    """Share of the R relevant objects among the first ``multiple * R`` places: first tier, second tier, ...

    Raises:
        EvaluationError: nothing is relevant.
    """
    count = len(_places(ranking))
    return float(ranking[: multiple * count].sum() / count)


@dataclass(frozen=True, eq=False)
class RetrievalFigures:
    """Figures of one ranking, or their means over several."""

    n: int
    average_precision: float
    first_relevant: float
    first_tier: float
    second_tier: float
    curve: Float[np.ndarray, " L"]

    def to_dict(self) -> dict[str, Any]:
        """Figures ready for JSON."""
        return {
            "n": self.n,
            "average_precision": self.average_precision,
            "nearest_neighbour": self.first_relevant,
            "first_tier": self.first_tier,
            "second_tier": self.second_tier,
            "precision_at_recall": self.curve.tolist(),
        }


def figures_of(ranking: Bool[np.ndarray, " N"], levels: int = LEVELS) -> RetrievalFigures:
    """All figures of one ranking; ``n`` is how many objects are relevant.

    Raises:
        EvaluationError: nothing is relevant.
    """
    return RetrievalFigures(
        n=int(ranking.sum()),
        average_precision=average_precision(ranking),
        first_relevant=float(first_relevant(ranking)),
        first_tier=tier(ranking),
        second_tier=tier(ranking, 2),
        curve=interpolated_precision(ranking, levels),
    )


def mean_figures(per_class: Mapping[str, RetrievalFigures]) -> RetrievalFigures:
    """The mean over the classes, each counting alike; its average precision is the *mean average precision*.

    Raises:
        EvaluationError: there are none.
    """
    if not per_class:
        raise EvaluationError("there is no class to take a mean of", where="per_class")
    found = list(per_class.values())
    return RetrievalFigures(
        n=sum(one.n for one in found),
        average_precision=float(np.mean([one.average_precision for one in found])),
        first_relevant=float(np.mean([one.first_relevant for one in found])),
        first_tier=float(np.mean([one.first_tier for one in found])),
        second_tier=float(np.mean([one.second_tier for one in found])),
        curve=np.mean([one.curve for one in found], axis=0),
    )


def _places(ranking: Bool[np.ndarray, " N"]) -> np.ndarray:
    places = np.flatnonzero(ranking) + 1
    if len(places) == 0:
        raise EvaluationError("nothing in this ranking is relevant", where="ranking")
    return places
