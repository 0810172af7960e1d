"""Orthographic depth images of triangle soup: 7 passes that are 14 views (paper section 3.3, z-buffer
distance).

The 14 views look along the 6 axis directions and from the 8 corners of a cube, through a window of [-2, 2] in
all three directions. Views from opposite sides cover the same pixels, so one pass that keeps the nearest and
the farthest depth gives both: view ``2k`` looks along direction ``k`` of :data:`PASS_DIRECTIONS`, view ``2k +
1`` the opposite way. Views 0-5 are the axes, 6-13 the corners.

Conventions, all of them ours where the paper is silent:

- *Depth* is measured along the direction of the view, in the units of the points, zero in the plane through
  the origin. The opposite view therefore stores minus the coordinate of the farthest layer, and differences
  of depth mean the same in both.
- *Background* is ``+inf``.
- Both views of a pass share one pixel grid (a real camera on the other side would see it mirrored), rows run
  along the second, columns along the first axis of :data:`PASS_FRAMES`.
- *Fill rule*: a pixel belongs to a triangle if its centre is inside or on the border. Vertices are snapped to
  1/4096 of a pixel, after which coverage is decided in exact integers: two triangles leave no crack at the
  edge that they share. Both may cover a pixel on that edge, which does no harm where only extremes are kept.
  Snapping and rule treat both directions alike, so a mirrored object has the mirrored picture.
- *Two-sided*: winding makes no difference.
- *Sheets seen edge-on* cover nothing, as in OpenGL: a triangle without area in the picture is not drawn. Such
  a sheet still counts in the other views; drawing it one pixel wide would make every finely tessellated
  surface half a pixel fatter than a coarse one.
- Fragments outside the window are cut, in depth too.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Any, Final

import numpy as np
from jaxtyping import Float, Float32, Int

from shapewright.distances.depth_kernels import draw_passes
from shapewright.errors import EstimationError

BACKGROUND: Final = np.float32(np.inf)
"""Depth of a pixel that nothing covers."""

_AXIS_FRAMES = [
    [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
    [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
]
_CORNERS = [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [1, 1, -1]]


def _corner_frame(corner: list[int]) -> Float[np.ndarray, "3 3"]:
    forward = np.array(corner) / np.sqrt(3.0)
    right = np.array([-forward[1], forward[0], 0.0])
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward])


PASS_FRAMES: Final[Float[np.ndarray, "7 3 3"]] = np.stack(
    [*(np.array(frame, dtype=np.float64) for frame in _AXIS_FRAMES), *map(_corner_frame, _CORNERS)]
)
"""Right, up and viewing direction of each pass, right-handed and orthonormal."""

PASS_DIRECTIONS: Final[Float[np.ndarray, "7 3"]] = PASS_FRAMES[:, 2]
"""Viewing direction of views 0, 2, 4, ...; the odd views look the opposite way."""


def depth_views(
    vertices: Float[np.ndarray, "V 3"], triangles: Int[np.ndarray, "F 3"], size: int = 256
) -> Float32[np.ndarray, "14 S S"]:
    """Depth images of the 14 views of the paper.

    Args:
        vertices: finite positions; the window is [-2, 2], so normalise first.
        triangles: vertex indices.
        size: pixels along each side, even.

    Returns:
        Depth along each viewing direction; ``+inf`` is background. See the module for the conventions.

    Raises:
        EstimationError: ``size`` is odd or below 2.
    """
    check_size(size)
    views = np.empty((14, size, size), dtype=np.float32)
    points, indices = prepared(vertices, triangles)
    share_passes(lambda first, last: draw_passes(points, indices, PASS_FRAMES, first, last, views))
    return views


def share_passes(work: Callable[[int, int], object]) -> None:
    """Do ``work(first, last)`` for parts of the 7 passes at the same time, on all processors that there are.

    Ordinary threads over kernels that release the lock: as fast as numba's own on an idle machine, but they wait
    asleep. OpenMP's threads spin, which made this step 5 to 20 times slower as soon as another process was busy.
    """
    parts = min(_processors(), len(PASS_FRAMES))
    if parts == 1:
        work(0, len(PASS_FRAMES))
        return
    cuts = [round(k * len(PASS_FRAMES) / parts) for k in range(parts + 1)]
    pending = [_pool(os.getpid()).submit(work, *cuts[k : k + 2]) for k in range(1, parts)]
    try:
        work(cuts[0], cuts[1])
    finally:
        for part in pending:
            part.result()


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@lru_cache(maxsize=1)
def _pool(process_id: int) -> ThreadPoolExecutor:
    """Made when first used, and anew in a forked child, where the parent's threads do not exist."""
    return ThreadPoolExecutor(len(PASS_FRAMES) - 1, thread_name_prefix="depth-passes")


def prepared(vertices: Any, triangles: Any) -> tuple[Float[np.ndarray, "V 3"], Int[np.ndarray, "F 3"]]:
    """The arrays in the one form that the kernels are compiled for (C-contiguous float64 and int64)."""
    return np.ascontiguousarray(vertices, dtype=np.float64), np.ascontiguousarray(triangles, dtype=np.int64)


def check_size(size: int) -> None:
    """Raise EstimationError unless an image side is even and at least 2."""
    if size < 2 or size % 2:
        raise EstimationError(f"the side of a depth image is an even number of pixels, got {size}")
