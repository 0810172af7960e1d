"""What a scan shows beside an object: debris and the ground it stands on (ours).

Both would decide how large an object seems and where its middle is. Points are all that is looked at, so meshes and
point clouds are treated alike.
"""

from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

_BULK: Final = (0.01, 0.99)
"""Shares of the points below and above which nothing belongs to the bulk, along each axis."""
_CELLS: Final = 32
"""Cells of the grid along the diagonal of the bulk: what is two cells apart is not connected."""
_SPACINGS: Final = 2.5
"""A cell is no smaller than so many distances between neighboring points."""
_SPECK_CELLS: Final = 56
"""Cells along the diagonal of the grid that finds specks, which may float closer to the object than larger pieces."""
_SPECK_SPACINGS: Final = 2.0
"""Least size of these cells, in distances between neighboring points."""
_SPECK_EXTENT: Final = 1.5
"""Largest extent of a speck, in these cells."""
_FAR: Final = 2**16
"""Cells beyond the bulk at which all that is farther away counts as if it were there; more would overflow the keys."""
_LARGEST_SHARE: Final = 0.015
"""Share of the points above which a piece belongs to the object unless it is small."""
_LARGEST_SIZE: Final = 0.2
"""Extent, in diagonals of the largest piece, above which a piece belongs to the object unless it has few points."""
_MOST: Final = 0.4
"""Share of the points that can be debris at all; an object in many small pieces keeps them."""

_ASKED: Final = 1_500
"""Points that the ground is looked for with."""
_TRIALS: Final = 300
"""Planes that are tried."""
_FLAT: Final = 0.006
"""Distance from a plane within which points lie on it, in diagonals."""
_NEAR: Final = 64
"""A trial plane goes through a point and two of so many nearest neighbors, among the points asked."""
_LEAST_GROUND: Final = 0.15
"""Share of the points that a ground has at least."""
_MOST_GROUND: Final = 0.97
"""Share above which there is hardly an object left beside it: a flat object is not its own ground."""
_ONE_SIDE: Final = 0.985
"""Share of the other points that lie above it, and that reach nowhere beyond its rim."""


def is_debris(points: Float[np.ndarray, "N 3"], spacing: float) -> Bool[np.ndarray, " N"]:
    """Tell which points belong to small pieces that float apart from the object.

    Args:
        points: spread evenly over everything there is.
        spacing: typical distance of a point from its neighbors on the surface.
    """
    low, high = np.quantile(points, _BULK, axis=0)
    diagonal = float(np.linalg.norm(high - low))
    debris = np.zeros(len(points), dtype=bool)
    if not diagonal > 0:
        return debris
    piece, extents = _pieces(points, low, high, max(diagonal / _CELLS, _SPACINGS * spacing))
    sizes = np.bincount(piece)
    largest = int(np.argmax(sizes))
    small = (sizes < _LARGEST_SHARE * len(points)) | (extents < _LARGEST_SIZE * extents[largest])
    small[largest] = False
    debris |= small[piece]
    piece, extents = _pieces(points, low, high, max(diagonal / _SPECK_CELLS, _SPECK_SPACINGS * spacing))
    speck = (extents <= _SPECK_EXTENT) & (np.bincount(piece) < _LARGEST_SHARE * len(points))
    debris |= speck[piece]
    return debris if debris.sum() <= _MOST * len(points) else np.zeros_like(debris)


def _pieces(
    points: Float[np.ndarray, "N 3"], low: Float[np.ndarray, " 3"], high: Float[np.ndarray, " 3"], cell: float
) -> tuple[Int[np.ndarray, " N"], Float[np.ndarray, " P"]]:
    """Return the piece of each point, and how far each piece extends, in cells; pieces are two cells apart."""
    far = _FAR * cell
    origin = np.maximum(points.min(axis=0), low - far)
    cells, of_point = _cells(np.floor((np.clip(points, origin, high + far) - origin) / cell).astype(np.int64))
    pairs = cKDTree(cells).query_pairs(1.8, output_type="ndarray")  # cells that touch, at a corner at least
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(cells), len(cells)))
    count, piece_of_cell = connected_components(links, directed=False)
    lows, highs = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(lows, piece_of_cell, cells)
    np.maximum.at(highs, piece_of_cell, cells)
    return piece_of_cell[of_point], np.linalg.norm(highs - lows, axis=1)


def _cells(places: Int[np.ndarray, "N 3"]) -> tuple[Int[np.ndarray, "C 3"], Int[np.ndarray, " N"]]:
    """Return the cells that are not empty, and the cell of each point."""
    counts = places.max(axis=0) + 1
    keys = (places[:, 0] * counts[1] + places[:, 1]) * counts[2] + places[:, 2]
    _, first, of_point = np.unique(keys, return_index=True, return_inverse=True)
    return places[first], of_point.reshape(-1)


def is_ground(points: Float[np.ndarray, "N 3"]) -> Bool[np.ndarray, " N"] | None:
    """Tell which points lie on a plane that may be the ground the object stands on; ``None`` if there is none.

    Nearly all the rest lies on one side of such a plane and within its rim. The same holds for the top of a table, so
    only a comparison with the classes can tell which of the two it is.

    Args:
        points: spread evenly over everything there is.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    flat = _FLAT * float(np.linalg.norm(high - low))
    rng = np.random.default_rng(0)
    asked = points[rng.permutation(len(points))[:_ASKED]]
    first = rng.integers(len(asked), size=_TRIALS)
    near = np.asarray(cKDTree(asked).query(asked[first], k=min(_NEAR, len(asked)))[1])
    second, third = (near[np.arange(_TRIALS), rng.integers(1, near.shape[1], size=_TRIALS)] for _ in range(2))
    normals = np.cross(asked[second] - asked[first], asked[third] - asked[first])
    lengths = np.linalg.norm(normals, axis=1)
    usable = lengths > 1e-12 * max(float(lengths.max()), 1e-300)
    if not usable.any():
        return None
    normals = normals[usable] / lengths[usable][:, None]
    heights = normals @ asked.T - np.einsum("nk,nk->n", asked[first[usable]], normals)[:, None]
    above, below = (np.count_nonzero(side, axis=1) for side in (heights > flat, heights < -flat))
    shares = 1.0 - (above + below) / len(asked)
    rest = np.maximum(above + below, 1)
    shares[(np.maximum(above, below) < _ONE_SIDE * rest) | (shares > _MOST_GROUND)] = 0.0
    best = int(np.argmax(shares))
    if shares[best] < _LEAST_GROUND:
        return None
    inside = asked[np.abs(heights[best]) <= flat]
    middle = inside.mean(axis=0)
    axes = np.linalg.svd(inside - middle, full_matrices=False)[2]
    offsets = (points - middle) @ axes.T
    found = np.abs(offsets[:, 2]) <= 1.5 * flat
    if found.all():
        return None
    reach = np.abs(offsets[found][:, :2]).max(axis=0)
    beyond = (np.abs(offsets[~found][:, :2]) > 1.02 * reach).any(axis=1).mean()
    return found if beyond <= 1.0 - _ONE_SIDE else None
