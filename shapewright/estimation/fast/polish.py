"""The last stage: a pattern search on the z-buffer distance itself (ours).

Least squares bring the surfaces together; the z-buffer distance also asks for outlines, and decides which result is the
answer. The search goes along the principal axes of the least squares' curvature, so that a step along any of them moves
the surface by as much, and what trades against each other (lengths and the scale) moves together.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.measure import drawn
from shapewright.estimation.fast.target import Target, normalized

FIRST_STEP = 0.01
"""Root mean square move of the surface that each axis begins with, in units of the normalized query."""
LEAST_STEP = 2e-4
_LONGEST = 0.25
_GROWS, _SHRINKS = 1.5, 0.4


@dataclass(eq=False)
class Polish:
    """A pattern search that can be continued round by round.

    Attributes:
        best: the best so far.
        sums: its comparison, view by view.
        gain: what the last round won.
        evaluations: how often the distance was measured.
    """

    target: Target
    best: Candidate
    sums: Float[np.ndarray, "7 2"]
    columns: Int[np.ndarray, " D"]
    directions: Float[np.ndarray, "N K"]
    steps: Float[np.ndarray, " K"]
    signs: Float[np.ndarray, " K"]
    gain: float = np.inf
    evaluations: int = 0

    @classmethod
    def begin(
        cls,
        target: Target,
        candidate: Candidate,
        *,
        first_step: float = FIRST_STEP,
        keeps_scale: bool = False,
        keeps_rotation: bool = False,
    ) -> "Polish":
        """Prepare the search around a candidate that least squares left behind."""
        assert candidate.curvature is not None
        columns = candidate.model.free_columns(candidate.values)[0]
        directions = _axes(candidate, columns, keeps_scale, keeps_rotation)
        reach = np.abs(directions[: len(columns)]).max(axis=0, initial=1e-9)
        steps = np.minimum(first_step, _LONGEST / reach)
        points, triangles = drawn(candidate)
        sums = target.compared(points, triangles)
        assert sums is not None
        measured = replace(candidate, zbuffer=normalized(sums))
        return cls(target, measured, sums, columns, directions, steps, np.ones(len(steps)), evaluations=1)

    @property
    def is_done(self) -> bool:
        """Whether no axis has a step left."""
        return not bool((self.steps >= LEAST_STEP).any())

    def round(self, checkpoint: Callable[[], None]) -> Candidate:
        """Try every axis once, in either direction; return the best so far.

        Args:
            checkpoint: called before each axis; may raise to stop, ``best`` holds what was found.
        """
        before = self.best.zbuffer
        for axis in np.argsort(self.steps, kind="stable")[::-1]:
            if self.steps[axis] >= LEAST_STEP:
                checkpoint()
                self._try(int(axis))
        self.gain = before - self.best.zbuffer
        return self.best

    def _try(self, axis: int) -> None:
        for sign in (self.signs[axis], -self.signs[axis]):
            step = sign * self.steps[axis] * self.directions[:, axis]
            candidate = self.best.moved(self.columns, step, self.target.center)
            sums = self.target.compared(*drawn(candidate), better_than=self.sums)
            self.evaluations += 1
            if sums is not None and normalized(sums) < self.best.zbuffer:
                self.best, self.sums = replace(candidate, zbuffer=normalized(sums)), sums
                self.signs[axis] = sign
                self.steps[axis] *= _GROWS
                return
        self.steps[axis] *= _SHRINKS


def _axes(
    candidate: Candidate, columns: Int[np.ndarray, " D"], keeps_scale: bool, keeps_rotation: bool
) -> Float[np.ndarray, "N K"]:
    """Return the axes as columns, each as long as moves the surface by 1."""
    curvature = candidate.curvature
    assert curvature is not None
    count = len(columns)
    full = np.zeros((count + 7, count + 7))
    known = {int(column): place for place, column in enumerate(curvature.columns)}
    old = [known.get(int(column), -1) for column in columns] + [len(curvature.columns) + k for k in range(7)]
    found = np.flatnonzero(np.array(old) >= 0)
    places = np.array(old)[found]
    full[np.ix_(found, found)] = curvature.matrix[np.ix_(places, places)]
    mean = np.trace(full) / len(full)
    full[np.diag_indices(len(full))] += 1e-6 * mean
    free = np.ones(count + 7, dtype=bool)
    free[-1] = not keeps_scale
    free[count : count + 3] = not keeps_rotation
    values, vectors = np.linalg.eigh(full[np.ix_(free, free)])
    axes = np.zeros((count + 7, len(values)))
    axes[free] = vectors / np.sqrt(np.maximum(values, 1e-12))
    return axes
