"""Positions that occur more than once."""

import numpy as np
from jaxtyping import Float, Int


def first_at_place(positions: Float[np.ndarray, "N 3"]) -> Int[np.ndarray, " N"]:
    """Return, for each position, the index of the first one that is exactly the same."""
    order = np.lexsort(positions.T)  # stable: of equal positions the first stays first
    ordered = positions[order]
    differs = np.ones(len(order), dtype=bool)
    differs[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[np.flatnonzero(differs)[np.cumsum(differs) - 1]]
    return first
