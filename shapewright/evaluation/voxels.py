"""Voxels: the little cubes of a grid that a surface goes through, and surfaces made of such grids."""

from dataclasses import dataclass
from typing import Final, no_type_check

import numpy as np
from jaxtyping import Bool, Float, Int
from numba import njit
from scipy.ndimage import label

from shapewright.mesh import TriangleMesh

_STEP: Final = 0.5
"""Distance between the places that are marked, in voxels: near enough that no path between voxels that share a side
slips through the surface."""

Quads = Int[np.ndarray, "Q 4"]


@dataclass(frozen=True, eq=False)
class VoxelGrid:
    """Cubes over the bounding box of an object.

    Attributes:
        occupied: whether the surface goes through each cube; there is a margin of empty ones all around.
        corner: lowest corner of the first cube.
        side: of each cube, in the units of the object.
    """

    occupied: Bool[np.ndarray, "X Y Z"]
    corner: Float[np.ndarray, " 3"]
    side: float

    def filled(self) -> Bool[np.ndarray, "X Y Z"]:
        """Return the occupied cubes and those that they enclose."""
        return enclosed(self.occupied)

    def placed(self, places: Float[np.ndarray, "N 3"]) -> Float[np.ndarray, "N 3"]:
        """Return places of the grid, where a cube has side 1, in the coordinates of the object."""
        return np.asarray(self.corner + self.side * places)


def voxelize(mesh: TriangleMesh, count: float, margin: int, rng: np.random.Generator) -> VoxelGrid:
    """Mark the cubes that a surface goes through; a few that it only grazes may be missed.

    Args:
        mesh: any surface with an extent.
        count: cubes along the longest side of the bounding box.
        margin: empty cubes on each side, at least 1.
        rng: source of the place of the grid, within one cube.
    """
    low, high = mesh.bounds
    side = float((high - low).max()) / count
    corner = low - side * (margin + rng.random(3))
    shape = np.ceil((high - corner) / side).astype(np.int64) + 1 + margin
    occupied = np.zeros(tuple(shape), dtype=np.bool_)
    _mark((mesh.vertices - corner) / side, mesh.faces, occupied)
    return VoxelGrid(occupied, corner, side)


def enclosed(wall: Bool[np.ndarray, "X Y Z"]) -> Bool[np.ndarray, "X Y Z"]:
    """Return a wall of voxels with all that cannot be reached from the first voxel through sides of voxels."""
    labels, _ = label(~wall)
    return np.asarray(labels != labels[0, 0, 0])


def voxel_sides(solid: Bool[np.ndarray, "X Y Z"]) -> tuple[Float[np.ndarray, "V 3"], Int[np.ndarray, "F 3"]]:
    """Return the squares between solid and empty voxels as triangles that face outward; solid voxels need a margin."""
    shape = np.array(solid.shape) + 1  # of the corners
    strides = np.array([shape[1] * shape[2], shape[2], 1])
    quads = []
    for axis in range(3):
        right, up = strides[(axis + 1) % 3], strides[(axis + 2) % 3]
        for outward in (1, -1):
            faces_outward = solid & ~np.roll(solid, -outward, axis=axis)
            first = np.stack(np.nonzero(faces_outward), axis=1) @ strides + (strides[axis] if outward > 0 else 0)
            around = np.stack([first, first + right, first + right + up, first + up], axis=1)
            quads.append(around[:, ::outward])
    used, renumbered = np.unique(np.concatenate(quads), return_inverse=True)
    corners = np.stack(np.unravel_index(used, tuple(shape)), axis=1).astype(np.float64)
    return corners, _triangles(renumbered.reshape(-1, 4))


def level_surface(
    field: Float[np.ndarray, "X Y Z"], level: float
) -> tuple[Float[np.ndarray, "V 3"], Int[np.ndarray, "F 3"]]:
    """Return the surface around all places where a field is below a level, as triangles that face outward.

    These are surface nets (Gibson 1998): one vertex for each cell of eight values that the surface goes through, at the
    mean of the places where it crosses the cell's edges. Coordinates are the indices of the field, which has to be
    above the level at its border.
    """
    inside = field < level
    strides = np.array([field.shape[1] * field.shape[2], field.shape[2], 1])
    cells = [
        inside[x : x - 1 or None, y : y - 1 or None, z : z - 1 or None] for x in (0, 1) for y in (0, 1) for z in (0, 1)
    ]
    count = np.sum(cells, axis=0, dtype=np.int8)
    place = np.stack(np.nonzero((count > 0) & (count < 8)), axis=1)
    first = place @ strides
    flat = field.ravel()
    sums, crossings = np.zeros((len(first), 3)), np.zeros((len(first), 1))
    quads = []
    for axis in range(3):
        others = (axis + 1) % 3, (axis + 2) % 3
        right, up = strides[list(others)]
        for r in (0, 1):
            for u in (0, 1):
                start = first + r * right + u * up
                here, there = flat[start] - level, flat[start + strides[axis]] - level
                crossed = np.flatnonzero((here < 0) != (there < 0))
                share = here[crossed] / (here[crossed] - there[crossed])
                sums[crossed, axis] += share
                sums[crossed, others[0]] += r
                sums[crossed, others[1]] += u
                crossings[crossed] += 1.0
                if r == u == 1:  # each edge of the grid is this one of exactly one cell
                    around = np.stack([first, first + right, first + right + up, first + up], axis=1)[crossed]
                    rising = (here[crossed] < 0)[:, None]
                    quads.append(np.where(rising, around, around[:, ::-1]))
    numbers = np.searchsorted(first, np.concatenate(quads))  # the cells come in the order of the array
    return place + sums / crossings, _triangles(numbers)


def _triangles(quads: Quads) -> Int[np.ndarray, "F 3"]:
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


@njit(cache=True, nogil=True)
@no_type_check
def _mark(points, faces, grid):
    """Mark the voxels of places all over each triangle, in rows along its longest side."""
    for f in range(faces.shape[0]):
        a, b, c = points[faces[f, 0]], points[faces[f, 1]], points[faces[f, 2]]
        ab, bc, ca = np.sum((b - a) ** 2), np.sum((c - b) ** 2), np.sum((a - c) ** 2)
        if bc >= ab and bc >= ca:
            a, b, c = b, c, a
        elif ca >= ab:
            a, b, c = c, a, b
        along, over = b - a, c - a
        length = np.sqrt(np.sum(along * along))
        height = 0.0
        if length > 0.0:
            height = np.sqrt(max(0.0, np.sum(over * over) - (np.sum(over * along) / length) ** 2))
        rows = max(1, int(np.ceil(height / _STEP)))
        for row in range(rows + 1):
            rest = 1.0 - row / rows
            x, y, z = c[0] + rest * (a[0] - c[0]), c[1] + rest * (a[1] - c[1]), c[2] + rest * (a[2] - c[2])
            columns = max(1, int(np.ceil(rest * length / _STEP)))
            for column in range(columns + 1):
                share = rest * column / columns
                grid[int(x + share * along[0]), int(y + share * along[1]), int(z + share * along[2])] = True
