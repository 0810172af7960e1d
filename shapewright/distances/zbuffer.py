"""Z-buffer distance (paper section 3.3, Algorithm 1)."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Int

from shapewright.distances.depth_kernels import OVERSIZE_PENALTY, UNDERSIZE_PENALTY, compare_passes
from shapewright.distances.rasterize import PASS_FRAMES, check_size, depth_views, prepared, share_passes
from shapewright.errors import EstimationError


@dataclass(frozen=True)
class ZBufferDistance:
    """The outcome of Algorithm 1.

    ``raw`` is the sum of the paper; ``normalized`` is the sum divided by the number of pixels, over all 14
    views, that either object covers. The paper's threshold of 0.7 can only belong to the latter (reading
    notes on section 3.3). ``normalized`` is 0 for equal pictures, 1 or 2 where only the generated object or
    only the original is there, and at most 4 (depths that differ by the whole window). If both pictures are
    empty both are 0.
    """

    normalized: float
    raw: float


def zbuffer_distance(
    query_views: Float32[np.ndarray, "14 S S"], generated_views: Float32[np.ndarray, "14 T T"]
) -> ZBufferDistance:
    """Compare depth images pixel by pixel, as in Algorithm 1; not symmetric.

    Args:
        query_views: the original object, from :func:`~shapewright.distances.rasterize.depth_views`.
        generated_views: the generated object, in the same form and size.

    Raises:
        EstimationError: the images differ in shape.
    """
    if query_views.shape != generated_views.shape:
        raise EstimationError(f"depth images differ in shape: {query_views.shape} and {generated_views.shape}")
    original = np.isfinite(query_views)
    generated = np.isfinite(generated_views)
    both = original & generated
    differences = np.abs(query_views[both].astype(np.float64) - generated_views[both])
    raw = float(
        UNDERSIZE_PENALTY * np.count_nonzero(original & ~generated)
        + OVERSIZE_PENALTY * np.count_nonzero(generated & ~original)
        + differences.sum()
    )
    covered = int(np.count_nonzero(original | generated))
    return ZBufferDistance(raw / covered if covered else 0.0, raw)


class ZBufferTarget:
    """A query, drawn once, that generated objects are compared with.

    Drawing and comparing are one kernel that touches only the pixels around the generated object; it gives
    what :func:`zbuffer_distance` of the two depth images gives.

    Args:
        vertices: the original object, normalised.
        triangles: its vertex indices.
        size: pixels along each side of the images, even.

    Raises:
        EstimationError: ``size`` is odd or below 2.
    """

    def __init__(self, vertices: Float[np.ndarray, "V 3"], triangles: Int[np.ndarray, "F 3"], size: int = 256) -> None:
        check_size(size)
        self.views = depth_views(vertices, triangles, size)
        self.covered = np.isfinite(self.views[::2]).sum(axis=(1, 2)).astype(np.int64)

    def distance(self, vertices: Float[np.ndarray, "V 3"], triangles: Int[np.ndarray, "F 3"]) -> ZBufferDistance:
        """Distance of a generated object to the query, both in the same coordinates."""
        points, indices = prepared(vertices, triangles)
        sums = np.empty((len(PASS_FRAMES), 2))
        views, covered_by_query = self.views, self.covered
        share_passes(
            lambda first, last: compare_passes(points, indices, PASS_FRAMES, views, covered_by_query, first, last, sums)
        )
        raw, covered = sums.sum(axis=0)
        return ZBufferDistance(float(raw / covered) if covered else 0.0, float(raw))
