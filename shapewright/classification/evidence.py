"""Putting evidence together: pictures, distances to exemplars, and whether a mesh is of any class at all (ours).

A class's *score* is ``log(q + floor) - weight * d``: q is the mean over the views of its probability where ``none`` has
a share, d the panorama distance of its nearest exemplar. It is high only if the pictures look like the class, like no
other, and the geometry is near. Much that is none of the classes looks like some of them (like tables, say), so each
class has a shift of its own, which comes off its score. The class is the most probable one, given that it is one of
them; the highest score tells, through a logistic curve that procedural models alone have set, whether the mesh is
*known*. Geometry weighs less in the score than in the choice of the class: scans are far from every exemplar, and
nearer to their class all the same. Scores of scans are lower altogether, so they have a curve of their own: *unknown*
is to mean the object and not the scanner.
"""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Bool, Float

GEOMETRY_WEIGHT: Final = 5.0
"""How much of a log-probability a unit of panorama distance is worth where the class is chosen. From 0 to 10 little
changes; point clouds ask for more."""
KNOWN_WEIGHT: Final = 3.0
"""The same in the score, which tells what is known."""
FLOOR: Final = 1e-3
"""No single source of evidence rules a class out."""
KNOWN_THRESHOLD: Final = 0.5
"""A mesh whose ``known`` is below is answered with ``unknown``."""
REFUSED: Final = 0.86
"""Share of objects of no class, among those that a classifier is tried on, that are answered with ``unknown``."""
_LEAST_OF_A_KIND: Final = 3
"""Objects of the class, and of none, without which a class has no shift."""
_TRUSTED: Final = 20
"""Objects of no class whose threshold counts half."""
UNKNOWN: Final = "unknown"
"""The answer for a mesh of none of the classes."""
OTHER: Final = "other"
"""What meshes of none of the classes are called where their true class is known."""


@dataclass(frozen=True)
class KnownCurve:
    """From the best score to the probability that a mesh is of one of the classes.

    Args:
        slope: of the logistic curve, positive.
        intercept: added to slope * score.
        shifts: of each class, by its number: how much higher than usual its scores must be. Classes beyond, which were
            added later, have none.
    """

    slope: float
    intercept: float
    shifts: tuple[float, ...] = ()

    def shifted(self, scores: Float[np.ndarray, "*N C"]) -> Float[np.ndarray, "*N C"]:
        """Return scores less the shifts of their classes, as :meth:`probability` takes them."""
        shifts = np.zeros(scores.shape[-1])
        shifts[: len(self.shifts)] = self.shifts
        return np.asarray(scores - shifts)

    def probability(self, score: float) -> float:
        """The curve's value at the highest score, shifted."""
        return float(1.0 / (1.0 + np.exp(-(self.slope * score + self.intercept))))

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {"slope": self.slope, "intercept": self.intercept, "shifts": list(self.shifts)}

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> "KnownCurve":
        """From :meth:`to_dict`; KeyError, TypeError or ValueError if it is something else."""
        slope, shifts = float(values["slope"]), tuple(float(one) for one in values.get("shifts", ()))
        if not slope > 0:
            raise ValueError(f"the slope of a curve is {slope}")
        return cls(slope, float(values["intercept"]), shifts)


@dataclass(frozen=True)
class KnownCurves:
    """The curves of one sort of evidence.

    Args:
        whole: for meshes that show no trace of a scanner.
        rough: for point clouds, noisy meshes and scans of one side.
    """

    whole: KnownCurve
    rough: KnownCurve

    def shifted(self, scores: Float[np.ndarray, "*N C"], *, is_rough: bool) -> Float[np.ndarray, "*N C"]:
        """Return scores less the shifts of their classes, on the scale of whole meshes.

        So scores of scans and of whole meshes can be compared, and :meth:`probability` takes both.
        """
        if not is_rough:
            return self.whole.shifted(scores)
        log_odds = self.rough.slope * self.rough.shifted(scores) + self.rough.intercept
        return np.asarray((log_odds - self.whole.intercept) / self.whole.slope)

    def probability(self, score: float) -> float:
        """The probability for the highest score, shifted."""
        return self.whole.probability(score)

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {"whole": self.whole.to_dict(), "rough": self.rough.to_dict()}

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> "KnownCurves":
        """From :meth:`to_dict`, or from a single curve, as earlier trainings wrote it; errors as there."""
        if "whole" not in values:
            single = KnownCurve.from_dict(values)
            return cls(single, single)
        return cls(KnownCurve.from_dict(values["whole"]), KnownCurve.from_dict(values["rough"]))


def class_scores(
    open_probabilities: Float[np.ndarray, "*N C"], distances: Float[np.ndarray, "*N C"] | None = None
) -> Float[np.ndarray, "*N C"]:
    """Score of each class; see the module's text.

    Args:
        open_probabilities: means over the views, where ``none`` has a share.
        distances: panorama distances of the nearest exemplars; without, the pictures alone count.
    """
    scores = np.log(open_probabilities.astype(np.float64) + FLOOR)
    return np.asarray(scores if distances is None else scores - KNOWN_WEIGHT * distances)


def class_probabilities(
    probabilities: Float[np.ndarray, " C"], distances: Float[np.ndarray, " C"] | None = None
) -> Float[np.ndarray, " C"]:
    """Probabilities of the classes by all evidence, given that it is one of them.

    Args:
        probabilities: of the pictures, means over the views.
        distances: panorama distances of the nearest exemplars, if there are any.
    """
    if distances is None:
        return np.asarray(probabilities / probabilities.sum())
    values = np.log(probabilities.astype(np.float64) + FLOOR) - GEOMETRY_WEIGHT * distances
    weights = np.exp(values - values.max())
    return np.asarray(weights / weights.sum())


def fit_known_curve(scores: Float[np.ndarray, "M C"], is_known: Bool[np.ndarray, " M"]) -> KnownCurve:
    """Fit a logistic curve of ``is_known`` to the highest shifted score, and move it.

    A class's shift goes from the threshold of all classes toward the one that objects with the highest score in that
    class ask for, the farther the more objects of no class there are among them. The curve is moved up to where it
    refuses :data:`REFUSED` of the objects of no class, if it refuses fewer.

    Args:
        scores: of each object and class.
        is_known: whether an object is of one of the classes.
    """
    class_count = scores.shape[1]
    highest, nearest = scores.max(axis=1), scores.argmax(axis=1)
    usual = _threshold(*_fitted_curve(highest, is_known))
    shifts = np.zeros(class_count)
    for number in range(class_count if class_count > 1 else 0):
        among = nearest == number
        others = int((among & ~is_known).sum())
        if min(others, int((among & is_known).sum())) >= _LEAST_OF_A_KIND:
            own = _threshold(*_fitted_curve(highest[among], is_known[among]))
            shifts[number] = (own - usual) * others / (others + _TRUSTED)
    highest = (scores - shifts).max(axis=1)
    slope, intercept = _fitted_curve(highest, is_known)
    refusing = -slope * float(np.quantile(highest[~is_known], REFUSED)) + _log_odds(KNOWN_THRESHOLD)
    return KnownCurve(slope, min(intercept, refusing), tuple(float(one) for one in shifts))


def _fitted_curve(scores: Float[np.ndarray, " M"], is_known: Bool[np.ndarray, " M"]) -> tuple[float, float]:
    """Return slope and intercept of a logistic curve; both kinds have the same weight.

    A small pull toward slope 1 keeps the curve sane where the kinds do not overlap; a few objects are pulled more.
    """
    from scipy.optimize import minimize  # only training fits; loading scipy would double the time to the first answer

    weight = np.where(is_known, 0.5 / max(is_known.sum(), 1), 0.5 / max((~is_known).sum(), 1))
    sign = np.where(is_known, 1.0, -1.0)
    pull = 0.01 + 1.0 / len(scores)

    def loss(parameters: np.ndarray) -> float:
        slope, intercept = np.exp(parameters[0]), parameters[1]
        return float(weight @ np.logaddexp(0.0, -sign * (slope * scores + intercept)) + pull * parameters[0] ** 2)

    middle = (scores[is_known].mean() + scores[~is_known].mean()) / 2
    found = minimize(loss, np.array([0.0, -middle]), method="Nelder-Mead")
    return float(np.exp(found.x[0])), float(found.x[1])


def _threshold(slope: float, intercept: float) -> float:
    """Return the score at which a curve is one half."""
    return -intercept / slope


def _log_odds(probability: float) -> float:
    return float(np.log(probability / (1.0 - probability)))


def auroc(positive: Float[np.ndarray, " P"], negative: Float[np.ndarray, " N"]) -> float:
    """Area under the ROC curve: the chance that a positive has a higher score than a negative (ties count half)."""
    order = np.sort(negative)
    below = np.searchsorted(order, positive, side="left")
    not_above = np.searchsorted(order, positive, side="right")
    return float((below + not_above).mean() / 2 / len(negative))
