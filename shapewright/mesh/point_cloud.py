"""Point clouds: what a scan is before anyone has made a surface of it."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.errors import MeshError

LEAST_POINTS: Final = 4
"""Fewer points have no volume, whatever their positions."""


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points on the surface of an object, without faces, in the units of whoever made them.

    Args:
        points: positions; kept as C-contiguous float64, and not copied if they already have that form.

    Raises:
        MeshError: a wrong shape, fewer than :data:`LEAST_POINTS` points, a coordinate that is not finite.
    """

    points: Float[np.ndarray, "N 3"]

    def __post_init__(self) -> None:
        points = np.asarray(self.points)
        if points.ndim != 2 or points.shape[1] != 3 or points.dtype.kind not in "fiu":
            raise MeshError(f"expected numbers of shape (N, 3), got {points.shape}", where="points")
        if len(points) < LEAST_POINTS:
            raise MeshError(f"expected at least {LEAST_POINTS} points, got {len(points)}", where="points")
        points = np.ascontiguousarray(points, dtype=np.float64)
        finite = np.isfinite(points).all(axis=1)
        if not finite.all():
            raise MeshError("a coordinate is NaN or infinite", where=f"points[{int(np.argmin(finite))}]")
        object.__setattr__(self, "points", points)

    @property
    def bounds(self) -> Float[np.ndarray, "2 3"]:
        """Smallest and largest coordinates."""
        return np.stack([self.points.min(axis=0), self.points.max(axis=0)])
