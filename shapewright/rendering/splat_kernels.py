"""Pictures of points as overlapping discs, on the CPU: compiled kernels (ours).

A picture is made in three passes over one view. The first finds the depth of the front surface at each pixel. The
second averages the depths of the points that lie on this front surface, with weights that fall towards the rim of a
disc, so that noise is averaged away before it can tilt a normal. The third turns depths into the three channels.
"""

import math
from typing import Final, no_type_check

import numba
import numpy as np

FILL: Final = 0.74
"""Gray of the surface in the first channel."""
LINE: Final = 0.08
"""Gray of silhouettes and steps."""
MIDDLE, FALL = 0.50, 0.37
"""Gray of depth 0, and how much darker the surface gets per unit of depth towards the viewer."""
STEEPEST, FLATTEST = 0.10, 0.75
"""Gray of a surface seen edge on, and what is added where it faces the viewer."""
NEAR, FAR = 0.6, 0.2
"""Darkness that an edge gives to the pixels on its two sides, and to the ones next to these."""
STEP: Final = 0.07
"""Height of a step between neighboring pixels that is drawn as a full line."""
CORE: Final = 0.75
"""Share of the radius within which a point covers a pixel; farther out it only takes part in the mean."""
LAYER: Final = 2.0
"""Thickness of the front surface, in radii: points farther behind are hidden."""
_LEAST_CORE, _LEAST_REACH = 0.75, 1.25
"""Of the same two, in pixels: every point covers one pixel at least."""
_EMPTY: Final = np.float32(-1e9)


@numba.njit(cache=True, nogil=True, parallel=True)
@no_type_check
def draw_splats(points, starts, shown, turns, radii, images):
    """Draw one picture for each turn.

    Args:
        points: (N, 3) float32, those of an object together.
        starts: (M + 1,) first point of each object, and the number of points.
        shown: (V,) object of each picture.
        turns: (V, 3, 3) float32; rotation times scale. The picture shows x and y within [-1, 1].
        radii: (V,) radius of the discs, in the same unit.
        images: (V, S, S, 3) uint8, filled.
    """
    for view in numba.prange(len(shown)):
        first, last = starts[shown[view]], starts[shown[view] + 1]
        _draw_one(points[first:last], turns[view], radii[view], images[view])


@numba.njit(cache=True, nogil=True, fastmath={"contract"})
@no_type_check
def _draw_one(points, turn, radius, image):
    size = image.shape[0]
    half = np.float32(0.5 * size)
    count = len(points)
    placed = np.empty((count, 3), dtype=np.float32)
    for i in range(count):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        placed[i, 0] = (turn[0, 0] * x + turn[0, 1] * y + turn[0, 2] * z + np.float32(1.0)) * half - np.float32(0.5)
        placed[i, 1] = (np.float32(1.0) - turn[1, 0] * x - turn[1, 1] * y - turn[1, 2] * z) * half - np.float32(0.5)
        placed[i, 2] = turn[2, 0] * x + turn[2, 1] * y + turn[2, 2] * z
    reach = np.float32(radius * half)
    depth = np.full((size, size), _EMPTY, dtype=np.float32)
    _find_front(placed, np.float32(max(CORE * reach, _LEAST_CORE)), depth)
    _average(placed, np.float32(max(reach, _LEAST_REACH)), np.float32(LAYER * radius), depth)
    _shade(depth, image)


@numba.njit(cache=True, nogil=True, fastmath={"contract"})
@no_type_check
def _find_front(placed, core, front):
    """Write the depth of the nearest disc into each pixel that a disc covers."""
    most = np.int32(front.shape[0] - 1)
    square = core * core
    for i in range(len(placed)):
        x, y, z = placed[i, 0], placed[i, 1], placed[i, 2]
        left, right = max(np.int32(0), np.int32(math.ceil(x - core))), min(most, np.int32(math.floor(x + core)))
        for row in range(
            max(np.int32(0), np.int32(math.ceil(y - core))), min(most, np.int32(math.floor(y + core))) + 1
        ):
            down = (row - y) * (row - y)
            for column in range(left, right + 1):
                if down + (column - x) * (column - x) <= square and z > front[row, column]:
                    front[row, column] = z


@numba.njit(cache=True, nogil=True, fastmath={"contract"})
@no_type_check
def _average(placed, reach, layer, depth):
    """Replace the depth of each covered pixel by the weighted mean over the discs of the front surface."""
    size = depth.shape[0]
    most = np.int32(size - 1)
    total = np.zeros((size, size), dtype=np.float32)
    weights = np.zeros((size, size), dtype=np.float32)
    shrink = np.float32(1.0) / (reach * reach)
    for i in range(len(placed)):
        x, y, z = placed[i, 0], placed[i, 1], placed[i, 2]
        left, right = max(np.int32(0), np.int32(math.ceil(x - reach))), min(most, np.int32(math.floor(x + reach)))
        behind = z + layer
        for row in range(
            max(np.int32(0), np.int32(math.ceil(y - reach))), min(most, np.int32(math.floor(y + reach))) + 1
        ):
            at_most = np.float32(1.0) - (row - y) * (row - y) * shrink
            for column in range(left, right + 1):
                weight = at_most - (column - x) * (column - x) * shrink
                if weight > np.float32(0.0) and behind >= depth[row, column]:
                    total[row, column] += weight * z
                    weights[row, column] += weight
    for row in range(size):
        for column in range(size):
            if depth[row, column] > _EMPTY:
                depth[row, column] = total[row, column] / weights[row, column]


@numba.njit(cache=True, nogil=True)
@no_type_check
def _shade(depth, image):
    """Turn depths into gray surface with dark silhouettes and steps, depth, and slope towards the viewer."""
    size = depth.shape[0]
    pixel = np.float32(2.0 / size)
    image[:] = 255
    top, bottom, left, right = size, -1, size, -1
    for row in range(size):
        for column in range(size):
            if depth[row, column] > _EMPTY:
                top, bottom = min(top, row), max(bottom, row)
                left, right = min(left, column), max(right, column)
    if bottom < 0:
        return
    top, bottom = max(0, top - 2), min(size - 1, bottom + 2)
    left, right = max(0, left - 2), min(size - 1, right + 2)
    rightward = np.zeros((size + 3, size + 3), dtype=np.float32)  # shifted by 2: a pixel has two edges on either side
    downward = np.zeros((size + 3, size + 3), dtype=np.float32)
    for row in range(top - 1, bottom + 1):
        for column in range(left - 1, right + 1):
            rightward[row + 2, column + 2] = _edge(depth, row, column, 0, 1)
            downward[row + 2, column + 2] = _edge(depth, row, column, 1, 0)
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            r, c = row + 2, column + 2
            across = NEAR * (rightward[r, c - 1] + rightward[r, c]) + FAR * (rightward[r, c - 2] + rightward[r, c + 1])
            down = NEAR * (downward[r - 1, c] + downward[r, c]) + FAR * (downward[r - 2, c] + downward[r + 1, c])
            darkness = min(1.0, max(across, down))
            z = depth[row, column]
            base = 1.0
            if z > _EMPTY:
                base = FILL
                image[row, column, 1] = np.uint8(255.0 * min(0.90, max(0.05, MIDDLE - FALL * z)) + 0.5)
                dx = _slope(depth, row, column, 0, 1) / pixel
                dy = _slope(depth, row, column, 1, 0) / pixel
                facing = 1.0 / math.sqrt(1.0 + dx * dx + dy * dy)
                image[row, column, 2] = np.uint8(255.0 * (STEEPEST + FLATTEST * facing) + 0.5)
            image[row, column, 0] = np.uint8(255.0 * (base + (LINE - base) * darkness) + 0.5)


@numba.njit(cache=True, nogil=True, inline="always")
@no_type_check
def _at(depth, row, column):
    size = depth.shape[0]
    if row < 0 or column < 0 or row >= size or column >= size:
        return _EMPTY
    return depth[row, column]


@numba.njit(cache=True, nogil=True, inline="always")
@no_type_check
def _slope(depth, row, column, down, right):
    """Return the smaller of the two differences to the neighbors, which does not look across a step."""
    z = depth[row, column]
    before, after = _at(depth, row - down, column - right), _at(depth, row + down, column + right)
    if before > _EMPTY and after > _EMPTY:
        one, other = z - before, after - z
        return one if abs(one) < abs(other) else other
    if before > _EMPTY:
        return z - before
    if after > _EMPTY:
        return after - z
    return np.float32(0.0)


@numba.njit(cache=True, nogil=True, inline="always")
@no_type_check
def _edge(depth, row, column, down, right):
    """Return how much of an edge lies between a pixel and the next one: 1 at a silhouette or a full step."""
    a, b = _at(depth, row, column), _at(depth, row + down, column + right)
    if a <= _EMPTY or b <= _EMPTY:
        return 0.0 if a <= _EMPTY and b <= _EMPTY else 1.0
    rise = b - a
    before, after = _at(depth, row - down, column - right), _at(depth, row + 2 * down, column + 2 * right)
    jump = abs(rise)
    if before > _EMPTY:
        jump = min(jump, abs(rise - (a - before)))
    if after > _EMPTY:
        jump = min(jump, abs(rise - (after - b)))
    share = min(1.0, max(0.0, (jump - 0.5 * STEP) / (0.5 * STEP)))
    return share * share * (3.0 - 2.0 * share)
