"""Rows of values in which a parameter is active, as near to the base model as that goes."""

import numpy as np
from jaxtyping import Float

from shapewright.modeling.parameter_space import ParameterSpace

_TRIED = 256


def active_row(
    space: ParameterSpace, column: int, base: Float[np.ndarray, " P"] | None = None
) -> Float[np.ndarray, " P"] | None:
    """Return a settled row in which a parameter is active, or ``None`` if none was found.

    Args:
        space: the parameters.
        column: of the parameter.
        base: the row to change as little as possible; the base model's if not given.
    """
    row = space.base_values() if base is None else np.array(base, dtype=np.float64)
    _fulfil(space, column, row)
    settled = space.settle(row[None])
    if space.active(settled)[0, column]:
        return np.asarray(settled[0])
    tried = space.random_values(np.random.default_rng(0), _TRIED)  # conditions that contradict what limits allow
    found = tried[space.active(tried)[:, column]]
    return np.asarray(found[0]) if len(found) else None


def distinct_values(space: ParameterSpace, column: int, row: Float[np.ndarray, " P"]) -> Float[np.ndarray, "B P"]:
    """Return the row with a parameter at each of its options, or at both ends of the range it has there."""
    parameter = space.parameters[column]
    options = [x for x, _ in parameter.named_options()]
    rows = np.repeat(row[None], len(options) or 2, axis=0)
    rows[:, column] = options or (parameter.minimum, parameter.maximum)
    return np.asarray(space.settle(rows))


def _fulfil(space: ParameterSpace, column: int, row: Float[np.ndarray, " P"]) -> None:
    """Move what the activity of a parameter depends on, the parameters before it, just as far as needed."""
    wanted = {column}
    for i in range(column, -1, -1):  # a parameter depends on those before it only, so each is looked at once
        if i not in wanted:
            continue
        for condition in space.parameters[i].active_when:
            other = space.columns[condition.parameter]
            wanted.add(other)
            low = max(condition.minimum, space.minimum[other])
            high = min(condition.maximum, space.maximum[other])
            if space.parameters[other].options:
                low, high = np.ceil(low), np.floor(high)
            row[other] = min(max(row[other], low), high)
