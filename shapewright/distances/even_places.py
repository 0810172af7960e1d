"""Places spread evenly over triangles, the same ones each time; for points that move with a surface."""

from typing import Final

import numpy as np
from jaxtyping import Float, Int

_R2: Final = (0.7548776662466927, 0.5698402909980532)  # Roberts' low-discrepancy sequence in two dimensions


def even_places(areas: Float[np.ndarray, " F"], count: int) -> tuple[Int[np.ndarray, " N"], Float[np.ndarray, "N 3"]]:
    """Spread places over triangles in proportion to their areas; the same ones each time.

    Places that follow each other lie in the same triangle or in the next ones.

    Args:
        areas: of the triangles, not all 0.
        count: number of places.

    Returns:
        The triangle of each place, and its barycentric coordinates there.
    """
    sums = np.cumsum(areas)
    places = np.arange(count) + 0.5
    faces = np.minimum(np.searchsorted(sums, places / count * sums[-1], side="right"), len(areas) - 1)
    first, second = (places * share % 1.0 for share in _R2)
    root = np.sqrt(first)
    return faces, np.stack([1.0 - root, root * (1.0 - second), root * second], axis=1)
