"""Hill climbing with diminishing steps (paper section 3.3, Algorithm 2)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.progress import NULL_PROGRESS, Progress


@dataclass(frozen=True, eq=False)
class Candidate:
    """Settled parameter values, their distance, and the pose it was measured at (None where the pose plays no part)."""

    values: Float[np.ndarray, " P"]
    distance: float
    pose: Pose | None = None


Values = Float[np.ndarray, "B P"]

Evaluate = Callable[[Float[np.ndarray, " P"], Candidate], Candidate]
"""Measures new values; the second argument is the incumbent, whose pose a realignment begins from."""


@dataclass(frozen=True)
class SearchSpace:
    """Where a climb may go.

    Args:
        settle: brings rows into the space; what depends on a changed value follows it.
        options: for each parameter the values it can have, none for a measure, which moves by steps.
    """

    settle: Callable[[Values], Values]
    options: tuple[tuple[float, ...], ...]

    def moved(self, values: Float[np.ndarray, " P"], column: int, x: float) -> Float[np.ndarray, " P"]:
        """Return the values with another x of one parameter, settled."""
        row = values.copy()
        row[column] = x
        settled: Float[np.ndarray, " P"] = self.settle(row[None])[0]
        return settled


@dataclass(frozen=True, eq=False)
class HillClimb:
    """Where a climb ended, how many passes over the parameters and how many measurements it took."""

    best: Candidate
    passes: int
    evaluations: int


def without_pose(distance: Callable[[Float[np.ndarray, " P"]], float]) -> Evaluate:
    """A plain distance of parameter values as something to climb on."""

    def evaluate(values: Float[np.ndarray, " P"], incumbent: Candidate) -> Candidate:
        return Candidate(values, distance(values), incumbent.pose)

    return evaluate


def hill_climb(
    evaluate: Evaluate,
    start: Candidate,
    space: SearchSpace,
    step_sizes: Sequence[float],
    *,
    progress: Progress = NULL_PROGRESS,
    on_improvement: Callable[[Candidate], None] | None = None,
    name: str = "distance",
) -> HillClimb:
    """Algorithm 2: move one parameter at a time by a step up or down, keep what lowers the distance.

    The printed loop condition is read as: passes at one step size go on for as long as a pass changed some
    parameter, then the next smaller step follows; the search ends after the smallest. New values are settled, which
    clamps them to their range, and an end of a range is taken only if it improves the distance.

    A choice has no steps (ours): each of its options is tried instead, in every pass.

    Values that cannot win are not measured: those equal to the incumbent after settling (so that a parameter that is
    not active costs nothing), and those that were measured from the incumbent's pose before. What was beaten at one
    pose may win at another; where the pose plays no part nothing is measured twice.

    Args:
        evaluate: measures values; :func:`without_pose` makes one of a plain distance.
        start: values with their distance (and pose).
        space: where the values may go.
        step_sizes: largest first, in units of x.
        progress: told before every measurement; the share of a step size that is done can only be guessed,
            but it never falls.
        on_improvement: called with every new incumbent, so that a caller has the best so far if ``progress``
            cancels.
        name: what the distance is called in messages.
    """
    best = start
    passes = evaluations = 0
    measured = {(_key(start.values), id(start.pose))}
    poses = [start.pose]  # kept alive: their identities are keys
    n_parameters = len(start.values)
    for rank, step in enumerate(step_sizes):
        passes_here = 0
        changed = n_parameters > 0
        while changed:
            changed = False
            for p in range(n_parameters):
                done = passes_here + p / n_parameters
                fraction = (rank + done / (done + 1.0)) / len(step_sizes)
                options = space.options[p]
                for move in options or (step, -step):
                    values = space.moved(best.values, p, move if options else best.values[p] + move)
                    key = _key(values)
                    if (key, id(best.pose)) in measured:
                        continue
                    measured.add((key, id(best.pose)))
                    progress.report(fraction, f"step {step:g}, {name} {best.distance:.4f}")
                    candidate = evaluate(values, best)
                    evaluations += 1
                    if candidate.distance < best.distance:
                        best = candidate
                        changed = True
                        measured.add((key, id(best.pose)))
                        poses.append(best.pose)
                        if on_improvement is not None:
                            on_improvement(best)
            passes_here += 1
        passes += passes_here
    progress.report(1.0, f"{name} {best.distance:.4f}")
    return HillClimb(best, passes, evaluations)


def _key(values: Float[np.ndarray, " P"]) -> bytes:
    """Equal for values that differ by rounding alone, as a step up and down again does."""
    return (np.round(values, 9) + 0.0).tobytes()
