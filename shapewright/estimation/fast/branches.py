"""Branches of a candidate: every other choice of every option, and the poses that look alike from afar (ours)."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.target import Target

DRAWS: Final = 2
"""Random beginnings of what a choice makes active, beside the base values."""
_HALF_TURNS: Final = tuple(np.diag(signs) for signs in ((1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)))


def other_choices(candidate: Candidate, rng: np.random.Generator) -> Iterator[Candidate]:
    """Yield the candidate with one option changed, for every other value that the other options leave.

    What the new choice makes active begins at its base value, and at random ones; everything else is inherited.
    """
    model = candidate.model
    space = model.compiled.space
    active = space.active(candidate.values[None])[0]
    lowest, highest = (bounds[0] for bounds in space.ranges(candidate.values[None]))
    for column in np.flatnonzero(model.is_option & active):
        for value in model.options[column]:
            if value == candidate.values[column] or not lowest[column] <= value <= highest[column]:
                continue
            values = candidate.values.copy()
            values[column] = value
            changed = candidate.with_values(values)
            if changed.values[column] != value:
                continue
            yield changed
            fresh = space.active(changed.values[None])[0] & ~active
            fresh[column] = False
            if fresh.any():
                fixed = {model.compiled.model.parameters[column].name: value}
                for drawn in model.compiled.random_values(rng, DRAWS, fixed):
                    yield changed.with_values(np.where(fresh, drawn, changed.values))


def other_poses(candidate: Candidate, target: Target) -> Iterator[Candidate]:
    """Yield the candidate after half a turn about each axis of its model, unless the model looks the same then.

    Head to tail, upside down, and both: the orientations that closest points take for each other.
    """
    same = candidate.model.compiled.model.symmetry.rotations()
    for turn in _HALF_TURNS:
        if any(np.allclose(turn, rotation, atol=1e-6) for rotation in same):
            continue
        center = (target.center - candidate.translation) @ candidate.rotation / candidate.scale  # in model space
        rotation = candidate.rotation @ turn
        yield replace(
            candidate,
            rotation=rotation,
            translation=target.center - candidate.scale * (rotation @ center),
            misfit=np.inf,
            zbuffer=np.inf,
            curvature=None,
        )
