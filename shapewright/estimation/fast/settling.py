"""Options by surfaces: the last choice of each option, where the model follows its query (ours).

A small part, or one half hidden in another, hardly changes a depth image. Where the surfaces lie on each other, the
mean distance between them tells such choices apart: a wrong one leaves several times the distance of the right one.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from shapewright.estimation.fast.branches import other_choices
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.deviation import POINTS, mutual_deviation
from shapewright.estimation.fast.fitted_model import FINE
from shapewright.estimation.fast.least_squares import Effort
from shapewright.estimation.fast.target import Target

FOLLOWS: Final = 0.006
"""Mean distance from the query to a fit, in half extents, below which the model follows the query."""
_CLEARLY: Final = ((0.0004, 0.9), (np.inf, 0.97))
"""Below the first number, a choice is taken if it brings the mean distance between the surfaces down to this share.
Small distances are mostly those between the triangles of two equal shapes."""
_EQUAL: Final = 1e-4
"""Mean distance between the surfaces of two equal shapes that are cut differently, in half extents."""
_CHANGES: Final = 8
_CHILDREN: Final = 4
_REPEATS: Final = 3
_FEW: Final = 1000
_HOPEFUL: Final = 2.0
"""A choice whose distance is larger by no more than this factor is fitted once more before it is given up."""
_GLANCE: Final = Effort(rounds=4, points=700, steps=FINE, damping=1e-3, neighbors=4, width=0.08)
_SURFACES: Final = Effort(rounds=10, points=1500, steps=FINE, damping=1e-4)
_OUTLINES: Final = Effort(
    rounds=8, points=1500, steps=FINE, damping=1e-4, outline=1000, outline_weight=1.0, outline_width=0.05
)
"""Outlines that weigh no more than surfaces: they bring thin parts back that closest points have lost."""


@dataclass(frozen=True, eq=False)
class Settled:
    """A fit by surfaces.

    Attributes:
        candidate: the fit.
        there: mean distance from the query to it, in half extents.
        distance: mean distance between the surfaces, both ways.
    """

    candidate: Candidate
    there: float
    distance: float

    @property
    def follows(self) -> bool:
        """Whether the model follows the query here."""
        return self.there < FOLLOWS


@dataclass(frozen=True, eq=False)
class Settling:
    """How options are settled.

    Attributes:
        target: the query.
        fit: makes a least-squares fit with an effort.
        map: does work for several candidates at the same time.
        rng: for random beginnings.
    """

    target: Target
    fit: Callable[[Candidate, Effort], Candidate]
    map: Callable[[Callable[[Candidate], Settled], Iterable[Candidate]], list[Settled]]
    rng: np.random.Generator

    def fitted(self, candidates: Iterable[Candidate]) -> list[Settled]:
        """Fit candidates by surfaces alone, the nearest first."""
        return _sorted(self.map(lambda one: self._measured(one, _SURFACES), candidates))

    def settle(self, best: Settled) -> Settled:
        """Change options for as long as another choice brings the surfaces clearly nearer to each other."""
        began = best = self.converged(best)
        hopeless: set[tuple[int, float]] = set()
        for _ in range(_CHANGES):
            choices = [one for one in other_choices(best.candidate, self.rng) if _choice(best, one) not in hopeless]
            glances = self.map(lambda one: self._measured(one, _GLANCE, _FEW), choices)
            hopeless |= _hopeless(best, choices, glances)
            children = self.fitted(one.candidate for one in _sorted(glances)[:_CHILDREN])
            if not children:
                break
            child = children[0]
            wanted = best.distance * next(share for limit, share in _CLEARLY if best.distance <= limit)
            if wanted < child.distance < _HOPEFUL * best.distance:
                child = self.converged(child)
            if child.distance > wanted:
                break
            best = child
        return best if best is began else self.converged(best)

    def converged(self, best: Settled) -> Settled:
        """Fit by outlines and surfaces in turns, for as long as that brings the surfaces nearer."""
        for _ in range(_REPEATS):
            if best.distance < _EQUAL:
                break
            found = self.map(lambda one: self._measured(self.fit(one, _OUTLINES), _SURFACES), [best.candidate])[0]
            if found.distance >= best.distance:
                break
            gains = found.distance < 0.95 * best.distance
            best = found
            if not gains:
                break
        return best

    def _measured(self, candidate: Candidate, effort: Effort, count: int = POINTS) -> Settled:
        found = self.fit(candidate, effort)
        measured = mutual_deviation(self.target, found, count)
        there, back = (np.inf, np.inf) if measured is None else measured
        return Settled(found, there, 0.5 * (there + back))


def _choice(best: Settled, changed: Candidate) -> tuple[int, float]:
    """Return the column of the option that was changed, and its new value."""
    model = changed.model
    column = int(np.flatnonzero(model.is_option & (changed.values != best.candidate.values))[0])
    return column, float(changed.values[column])


def _hopeless(best: Settled, choices: Sequence[Candidate], glances: Sequence[Settled]) -> set[tuple[int, float]]:
    """Return the choices that no beginning brings near: other options make no difference to that."""
    nearest: dict[tuple[int, float], float] = {}
    for changed, glance in zip(choices, glances, strict=True):
        choice = _choice(best, changed)
        nearest[choice] = min(nearest.get(choice, np.inf), glance.distance)
    return {choice for choice, distance in nearest.items() if distance > _HOPEFUL * best.distance}


def _sorted(found: Iterable[Settled]) -> list[Settled]:
    return sorted(found, key=lambda one: one.distance)
