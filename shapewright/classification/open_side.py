"""The side that a scan was seen from: a direction along which nothing hides anything (ours).

What one picture of a depth camera shows is whole along its line of sight and a shell full of gaps from anywhere else.
From the front it looks as the whole object does, so that is where a classifier looks more often.
"""

from functools import cache
from typing import Final

import numpy as np
from jaxtyping import Float, Float32

from shapewright.rendering.views import even_views

DIRECTIONS: Final = 100
"""Directions that are tried, over the whole sphere; neighbors are about 20 degrees apart."""
LEAST_SEEN: Final = 0.88
"""Share of the points that must be in front. Of closed surfaces half is, and of thin plates as well."""
_ASKED: Final = 3_000
"""Points that are looked at, at most."""


def open_side(points: Float32[np.ndarray, "N 3"]) -> Float[np.ndarray, "3"] | None:
    """Return the direction from which most is seen, if that is nearly everything.

    The opposite direction is as good a guess: nothing tells the front of a shell from its back.

    Args:
        points: spread evenly over what there is, within the unit sphere.
    """
    from shapewright.classification.open_side_kernels import find_seen_shares

    asked = points[:: -(-len(points) // _ASKED)]
    axes = _axes()
    shares = np.empty((len(axes), 2))
    find_seen_shares(asked, axes, shares)
    axis, end = np.unravel_index(np.argmax(shares), shares.shape)
    if shares[axis, end] < LEAST_SEEN:
        return None
    return (axes[axis, 2] if end == 0 else -axes[axis, 2]).astype(np.float64)


@cache
def _axes() -> Float32[np.ndarray, "A 3 3"]:
    """Return frames whose third rows lie on the upper half of the sphere; the lower half has the opposite ones."""
    return even_views(DIRECTIONS)[: DIRECTIONS // 2].astype(np.float32)
