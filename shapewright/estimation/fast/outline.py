"""The outlines of the query in the seven depth views, and how they pull an instance (ours).

Closest points say nothing about where a flat fin ends, or which way a thin rod should slide; the outlines do, and most
of the z-buffer distance is there. Outlines of both objects that face the same way are matched within each view.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import cKDTree

from shapewright.distances.depth_kernels import WINDOW
from shapewright.distances.rasterize import PASS_FRAMES
from shapewright.estimation.fast import outline_kernels

_MOST_PIXELS = 8_000
_APART = 100.0
"""Distance between the views in the one search tree that holds them all."""
_NEIGHBORS = 6
_ACROSS = 0.1
_SPACING_PIXELS = 2.0


@dataclass(frozen=True, eq=False)
class OutlinePulls:
    """Outline points of an instance, as barycentric samples, and what pulls each of them.

    Attributes:
        faces, weights: (N,), (N, 3), where the samples are.
        metrics, forces: (N, 3, 3), (N, 3), sums of the pairs.
    """

    faces: Int[np.ndarray, " N"]
    weights: Float[np.ndarray, "N 3"]
    metrics: Float[np.ndarray, "N 3 3"]
    forces: Float[np.ndarray, "N 3"]


class TargetOutline:
    """The outline of the query, seen along each of the seven directions of the depth views.

    Args:
        covered: (7, S, S), which pixels the query covers.
        rng: for the order of the points, so that the first few of them are spread evenly.
    """

    def __init__(self, covered: Bool[np.ndarray, "7 S S"], rng: np.random.Generator) -> None:
        self._size = covered.shape[1]
        self._pixel = 2.0 * WINDOW / self._size
        pixels, normals, views = [], [], []
        for view, mask in enumerate(covered):
            found, facing = np.empty((_MOST_PIXELS, 2), dtype=np.int64), np.empty((_MOST_PIXELS, 2))
            count = outline_kernels.mask_outline(mask, found, facing)
            pixels.append(found[:count])
            normals.append(facing[:count])
            views.append(np.full(count, view))
        order = rng.permutation(sum(map(len, pixels)))
        self._points: Float[np.ndarray, "N 2"] = np.concatenate(pixels)[order] * self._pixel
        self._normals: Float[np.ndarray, "N 2"] = np.concatenate(normals)[order]
        self._views: Int[np.ndarray, " N"] = np.concatenate(views)[order]
        self._tree = cKDTree(_apart(self._points, self._views), balanced_tree=False)

    def pulls(
        self,
        points: Float[np.ndarray, "V 3"],
        triangles: Int[np.ndarray, "F 3"],
        count: int,
        weight: float,
        width: float,
    ) -> OutlinePulls | None:
        """Match the outlines of an instance.

        Args:
            points: the instance's vertices, placed.
            triangles: of the instance.
            count: outline points at most, on either side.
            weight: of all pairs of one direction together; those of surfaces have 1.
            width: of the robust weight.

        Returns:
            The pulls; ``None`` if the instance has hardly any outline.
        """
        faces, weights = np.empty(_MOST_PIXELS, dtype=np.int64), np.empty((_MOST_PIXELS, 3))
        views, pixels = np.empty(_MOST_PIXELS, dtype=np.int64), np.empty((_MOST_PIXELS, 2), dtype=np.int64)
        facing = np.empty((_MOST_PIXELS, 2))
        found = outline_kernels.outline_points(
            points, triangles, PASS_FRAMES, self._size, WINDOW, faces, weights, views, pixels, facing
        )
        if min(found, len(self._points)) < _NEIGHBORS:
            return None
        every = max(1, -(-found // count))
        some = np.arange(0, found, every)
        views, places, facing = views[some], pixels[some] * self._pixel, facing[some]
        if len(some) < _NEIGHBORS:
            return None
        metrics, forces = np.zeros((len(some), 3, 3)), np.zeros((len(some), 3))
        near = self._tree.query(_apart(places, views), k=_NEIGHBORS)[1]
        chosen = np.empty(len(some), dtype=np.int64)
        outline_kernels.match_outlines(places, facing, self._points, self._normals, near, _ACROSS, chosen)
        self._add(np.arange(len(some)), places, chosen, views, 1, weight / len(some), width, metrics, forces)
        own = np.arange(min(count, len(self._points)))
        tree = cKDTree(_apart(places, views), balanced_tree=False, compact_nodes=False)
        near = tree.query(_apart(self._points[own], self._views[own]), k=_NEIGHBORS)[1]
        back = np.empty(len(own), dtype=np.int64)
        outline_kernels.match_outlines(self._points[own], self._normals[own], places, facing, near, _ACROSS, back)
        self._add(back, places, own, views, every, weight / len(own), width, metrics, forces)
        return OutlinePulls(faces[some], weights[some], metrics, forces)

    def _add(
        self,
        rows: Int[np.ndarray, " K"],
        places: Float[np.ndarray, "N 2"],
        own: Int[np.ndarray, " K"],
        views: Int[np.ndarray, " N"],
        every: int,
        share: float,
        width: float,
        metrics: Float[np.ndarray, "N 3 3"],
        forces: Float[np.ndarray, "N 3"],
    ) -> None:
        """Add pairs of a sample of the instance and a point of the query's outline; those of two views pull nothing."""
        same = views[rows] == self._views[own]
        rows, own = rows[same], own[same]
        outline_kernels.add_outline_pairs(
            rows, places[rows] - self._points[own], self._normals[own], self._views[own], PASS_FRAMES,
            _SPACING_PIXELS * self._pixel * every, width, share, metrics, forces,
        )  # fmt: skip


def _apart(points: Float[np.ndarray, "N 2"], views: Int[np.ndarray, " N"]) -> Float[np.ndarray, "N 3"]:
    return np.column_stack([points, _APART * views])
