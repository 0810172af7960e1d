"""The side that a scan was seen from: a direction along which nothing hides anything (ours).

What one picture of a depth camera shows is whole along its line of sight and a shell full of gaps from anywhere else.
From the front it looks as the whole object does, so that is where a classifier looks more often.
"""

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
    frames = even_views(DIRECTIONS)
    shares = _seen_shares(asked, frames.astype(np.float32))
    best = int(np.argmax(shares))
    return frames[best, 2] if shares[best] >= LEAST_SEEN else None


@numba.njit(cache=True, nogil=True)
@no_type_check
def _seen_shares(points, frames):
    """Return the share of the points that lie in front, along the third row of each frame."""
    shares = np.empty(len(frames))
    places = np.empty(len(points), dtype=np.int64)
    depths = np.empty(len(points), dtype=np.float32)
    half = np.float32(0.5 * _PIXELS)
    for number in range(len(frames)):
        frame = frames[number]
        front = np.full(_PIXELS * _PIXELS, np.float32(-2.0), dtype=np.float32)
        for i in range(len(points)):
            x, y, z = points[i, 0], points[i, 1], points[i, 2]
            column = int((frame[0, 0] * x + frame[0, 1] * y + frame[0, 2] * z + np.float32(1.0)) * half)
            row = int((frame[1, 0] * x + frame[1, 1] * y + frame[1, 2] * z + np.float32(1.0)) * half)
            depths[i] = frame[2, 0] * x + frame[2, 1] * y + frame[2, 2] * z
            places[i] = min(max(row, 0), _PIXELS - 1) * _PIXELS + min(max(column, 0), _PIXELS - 1)
            front[places[i]] = max(front[places[i]], depths[i])
        seen = 0
        for i in range(len(points)):
            seen += depths[i] > front[places[i]] - np.float32(_THICKNESS)
        shares[number] = seen / len(points)
    return shares
