"""Compiled kernel of the weighted sample elimination (Yuksel 2015)."""

import heapq
from typing import no_type_check

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
@no_type_check
def eliminate(weights, starts, neighbors, shares, count):
    """Take the point with the largest weight away, and its share from its neighbors, until ``count`` are left.

    Of equal weights the first one goes.

    Args:
        weights: (M,) how crowded each point is; changed.
        starts: (M + 1,) where the neighbors of each point begin.
        neighbors, shares: (K,) the neighbors, each of them once, and what each weight owes to the point.
        count: how many to leave.

    Returns:
        (M,) bool, which points are left.
    """
    left = np.ones(len(weights), np.bool_)
    heap = [(-weights[i], i) for i in range(len(weights))]
    heapq.heapify(heap)
    for _ in range(len(weights) - count):
        key, gone = heapq.heappop(heap)
        while key != -weights[gone]:  # it has lost neighbors since
            heapq.heappush(heap, (-weights[gone], gone))
            key, gone = heapq.heappop(heap)
        left[gone] = False
        for k in range(starts[gone], starts[gone + 1]):
            if left[neighbors[k]]:
                weights[neighbors[k]] -= shares[k]
    return left
