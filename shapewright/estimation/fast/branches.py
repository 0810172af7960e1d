"""Options as branches: every other choice of every option is fitted for a moment, and the best are pursued (ours)."""

from collections.abc import Callable, Iterator

import numpy as np

from shapewright.estimation.fast.candidate import Candidate

Fit = Callable[[Candidate], Candidate]


def other_choices(candidate: Candidate) -> Iterator[Candidate]:
    """Yield the candidate with one option changed, for every other value that the other options leave.

    What the new choice makes active begins at its base value; everything else is inherited.
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
            if changed.values[column] == value:
                yield changed
