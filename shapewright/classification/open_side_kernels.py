"""How much of a cloud of points is seen from afar: compiled kernels (ours)."""

from typing import Final, no_type_check

import numba
import numpy as np

PIXELS: Final = 64
"""Along each side of the picture, which the unit sphere fills."""
THICKNESS: Final = 0.06
"""How far behind the front of its pixel a point may lie, in the unit of the points."""


@numba.njit(cache=True, nogil=True, parallel=True)
@no_type_check
def find_seen_shares(points, axes, shares):
    """Find the share of the points that lie in front, seen from either end of the third row of each frame.

    Args:
        points: (N, 3).
        axes: (D, 3, 3).
        shares: (D, 2), filled.
    """
    for number in numba.prange(len(axes)):
        _find_from_both_ends(points, axes[number], shares[number])


@numba.njit(cache=True, nogil=True)
@no_type_check
def _find_from_both_ends(points, axis, shares):
    half = np.float32(0.5 * PIXELS)
    places = np.empty(len(points), dtype=np.int64)
    heights = np.empty(len(points), dtype=np.float32)
    highest = np.full(PIXELS * PIXELS, np.float32(-2.0), dtype=np.float32)
    lowest = np.full(PIXELS * PIXELS, np.float32(2.0), dtype=np.float32)
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        column = int((axis[0, 0] * x + axis[0, 1] * y + axis[0, 2] * z + np.float32(1.0)) * half)
        row = int((axis[1, 0] * x + axis[1, 1] * y + axis[1, 2] * z + np.float32(1.0)) * half)
        place = min(max(row, 0), PIXELS - 1) * PIXELS + min(max(column, 0), PIXELS - 1)
        height = axis[2, 0] * x + axis[2, 1] * y + axis[2, 2] * z
        places[i], heights[i] = place, height
        highest[place] = max(highest[place], height)
        lowest[place] = min(lowest[place], height)
    above, below = 0, 0
    for i in range(len(points)):
        above += heights[i] > highest[places[i]] - np.float32(THICKNESS)
        below += heights[i] < lowest[places[i]] + np.float32(THICKNESS)
    shares[0], shares[1] = above / len(points), below / len(points)
