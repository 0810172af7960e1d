"""The side that a scan was seen from: a direction along which nothing hides anything (ours).

What one picture of a depth camera shows is whole along its line of sight and a shell full of gaps from anywhere else.
From the front it looks as the whole object does, so that is where a classifier looks more often.
"""

from functools import cache
from typing import Final, no_type_check

import numba
import numpy as np
from jaxtyping import Float, Float32

from shapewright.rendering.views import even_views

DIRECTIONS: Final = 100
"""Directions that are tried, over the whole sphere; neighbors are about 20 degrees apart."""
LEAST_SEEN: Final = 0.88
"""Share of the points that must be in front. Of closed surfaces half is, and of thin plates as well."""
_ASKED: Final = 3_000
"""Points that are looked at, at most."""
_PIXELS: Final = 64
"""Along each side of the picture, which the unit sphere fills."""
_THICKNESS: Final = 0.06
"""How far behind the front of its pixel a point may lie, in the unit of the points."""


def open_side(points: Float32[np.ndarray, "N 3"]) -> Float[np.ndarray, "3"] | None:
    """Return the direction from which most is seen, if that is nearly everything.

    The opposite direction is as good a guess: nothing tells the front of a shell from its back.

    Args:
        points: spread evenly over what there is, within the unit sphere.
    """
    asked = points[:: -(-len(points) // _ASKED)]
    axes = _axes()
    shares = np.empty((len(axes), 2))
    _find_seen_shares(asked, axes, shares)
    axis, end = np.unravel_index(np.argmax(shares), shares.shape)
    if shares[axis, end] < LEAST_SEEN:
        return None
    return (axes[axis, 2] if end == 0 else -axes[axis, 2]).astype(np.float64)


@cache
def _axes() -> Float32[np.ndarray, "A 3 3"]:
    """Return frames whose third rows lie on the upper half of the sphere; the lower half has the opposite ones."""
    return even_views(DIRECTIONS)[: DIRECTIONS // 2].astype(np.float32)


@numba.njit(cache=True, nogil=True, parallel=True)
@no_type_check
def _find_seen_shares(points, axes, shares):
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
    half = np.float32(0.5 * _PIXELS)
    places = np.empty(len(points), dtype=np.int64)
    heights = np.empty(len(points), dtype=np.float32)
    highest = np.full(_PIXELS * _PIXELS, np.float32(-2.0), dtype=np.float32)
    lowest = np.full(_PIXELS * _PIXELS, np.float32(2.0), dtype=np.float32)
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        column = int((axis[0, 0] * x + axis[0, 1] * y + axis[0, 2] * z + np.float32(1.0)) * half)
        row = int((axis[1, 0] * x + axis[1, 1] * y + axis[1, 2] * z + np.float32(1.0)) * half)
        place = min(max(row, 0), _PIXELS - 1) * _PIXELS + min(max(column, 0), _PIXELS - 1)
        height = axis[2, 0] * x + axis[2, 1] * y + axis[2, 2] * z
        places[i], heights[i] = place, height
        highest[place] = max(highest[place], height)
        lowest[place] = min(lowest[place], height)
    above, below = 0, 0
    for i in range(len(points)):
        above += heights[i] > highest[places[i]] - np.float32(_THICKNESS)
        below += heights[i] < lowest[places[i]] + np.float32(_THICKNESS)
    shares[0], shares[1] = above / len(points), below / len(points)
