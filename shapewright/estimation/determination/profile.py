"""Profiles: what the fit loses when one parameter is held at other values, to check the quadratic approximation."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float, Int

from shapewright.estimation.determination.information import Information
from shapewright.estimation.determination.statuses import CHANGE, LEAST_EFFECT

Refit = Callable[[int, float], float]
"""Holds a parameter (by its column) at a value, refits all else from the fit, and returns the root mean square residual
in half extents."""
POINTS: Final = 9
"""Values of a profile, the ends of the range among them."""
AGREEMENT: Final = 2.0
"""Factor by which the movement of the surface may differ from what the Fisher information promises."""
_BORDERLINE: Final = 4.0


@dataclass(frozen=True, eq=False)
class Profile:
    """The root mean square residual along one parameter, all else refitted.

    Attributes:
        values: x, ascending; the fitted value among them.
        residuals: in half extents.
        predicted: what the quadratic approximation says.
        fitted: index of the fitted value.
    """

    values: Float[np.ndarray, " K"]
    residuals: Float[np.ndarray, " K"]
    predicted: Float[np.ndarray, " K"]
    fitted: int

    @property
    def movements(self) -> Float[np.ndarray, " K"]:
        """Root mean square movement of the surface that cannot be refitted away, by each value."""
        least = self.residuals[self.fitted] ** 2
        return np.asarray(np.sqrt(np.maximum(self.residuals**2 - least, 0.0)))

    @property
    def better(self) -> float | None:
        """The value with the smallest residual, if it is not the fitted one."""
        best = int(self.residuals.argmin())
        return None if self.residuals[best] >= self.residuals[self.fitted] else float(self.values[best])

    @property
    def is_quadratic(self) -> bool:
        """Whether the surface moves as the Fisher information promises, on both sides of the fit."""
        others = np.arange(len(self.values)) != self.fitted
        least = self.residuals[self.fitted] ** 2
        promised = np.sqrt(np.maximum(self.predicted**2 - least, 0.0))[others]
        seen = self.movements[others]
        larger, smaller = np.maximum(seen, LEAST_EFFECT), np.maximum(promised, LEAST_EFFECT)
        agreement = np.maximum(larger / smaller, smaller / larger)
        return bool((agreement <= AGREEMENT).all())

    def interval(self, movement: float) -> tuple[float, float]:
        """Return the values around the fitted one that move the surface by less, by linear interpolation.

        Args:
            movement: root mean square movement of the surface, in half extents.
        """
        moved = self.movements
        ends = []
        for step in (-1, 1):
            at = self.fitted
            while 0 <= at + step < len(moved) and moved[at + step] <= movement:
                at += step
            end = float(self.values[at])
            if 0 <= at + step < len(moved):
                share = (movement - moved[at]) / (moved[at + step] - moved[at])
                end += float(share * (self.values[at + step] - self.values[at]))
            ends.append(end)
        return ends[0], ends[1]


def profile(
    column: int,
    value: float,
    bounds: tuple[float, float],
    information: Information,
    residual: float,
    refit: Refit,
    points: int = POINTS,
) -> Profile:
    """Vary one parameter over its range, with all else refitted.

    Args:
        column: of the parameter, in the information.
        value: its fitted x.
        bounds: the ends of its range.
        information: of the fit.
        residual: root mean square residual of the fit, in half extents.
        refit: called for every value but the fitted one.
        points: values to try, evenly spread and with both ends; the fitted value is added.
    """
    grid = np.unique(np.append(np.linspace(*bounds, points), value))
    fitted = int(np.searchsorted(grid, value))
    residuals = np.array([residual if i == fitted else refit(column, float(x)) for i, x in enumerate(grid)])
    effect = information.effects[column] / information.ranges[column]
    predicted = np.sqrt(residual**2 + (effect * (grid - value)) ** 2)
    return Profile(grid, residuals, predicted, fitted)


def find_suspects(
    information: Information,
    values: Float[np.ndarray, " A"],
    lowest: Float[np.ndarray, " A"],
    highest: Float[np.ndarray, " A"],
) -> Int[np.ndarray, " K"]:
    """Return the parameters whose status hangs on the quadratic approximation, the most doubtful first.

    First come those with an effect within a factor of 4 of the limit, then those that seem to be flat and are not at an
    end: in the middle of a symmetry the first derivative is zero, though larger changes are seen.

    Args:
        information: about the parameters in this order.
        values: x.
        lowest: ends of the ranges.
        highest: the other ends.
    """
    doubt = np.abs(np.log(np.maximum(CHANGE * information.effects, 1e-12) / LEAST_EFFECT))
    inside = (values > lowest) & (values < highest)
    flat = CHANGE * information.effects < LEAST_EFFECT
    suspects = (doubt <= np.log(_BORDERLINE)) | (flat & inside)
    columns = np.flatnonzero(suspects)
    return columns[np.argsort(doubt[columns], kind="stable")]
