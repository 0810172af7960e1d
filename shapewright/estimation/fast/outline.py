"""The outlines of the query in the seven depth views, and how they pull an instance (ours).

Closest points say nothing about where a flat fin ends, or which way a thin rod should slide; the outlines do, and most
of the z-buffer distance is there. Outlines of both objects that face the same way are matched within each view.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.distances.depth_kernels import WINDOW, trace_mask
from shapewright.distances.rasterize import PASS_FRAMES
from shapewright.estimation.fast import outline_kernels

MOST_PIXELS: Final = 16_000
"""Outline pixels of an object in all views together; more are left out."""
_LEAST: Final = 6
_ACROSS: Final = 0.1
_SPACING_PIXELS: Final = 2.0


@dataclass(frozen=True, eq=False)
class Trace:
    """The outline of an instance, view after view.

    Attributes:
        size: pixels along each side of a view.
        faces, weights: (N,), (N, 3), where on its surface each outline pixel is.
        views: (N,) number of the view.
        pixels: (N, 2) column and row.
        normals: (N, 2) direction out of the outline.
    """

    size: int
    faces: Int[np.ndarray, " N"]
    weights: Float[np.ndarray, "N 3"]
    views: Int[np.ndarray, " N"]
    pixels: Int[np.ndarray, "N 2"]
    normals: Float[np.ndarray, "N 2"]


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
        rng: for the order of the points of a view, so that the first few of them are spread evenly.
    """

    def __init__(self, covered: Bool[np.ndarray, "7 S S"], rng: np.random.Generator) -> None:
        most = MOST_PIXELS // len(covered)
        places = []
        for mask in covered:
            pixels, normals = np.empty((most, 2), dtype=np.int64), np.empty((most, 2))
            count = trace_mask(np.where(mask, 0, -1).astype(np.int32), pixels, normals)
            order = rng.permutation(count)
            places.append(_places(pixels[order], normals[order], covered.shape[1]))
        self._places: Float[np.ndarray, "4 N"] = np.concatenate(places, axis=1)
        self._starts = np.concatenate([[0], np.cumsum([one.shape[1] for one in places])])

    def pulls(self, trace: Trace, count: int, weight: float, width: float) -> OutlinePulls | None:
        """Match the outlines of an instance.

        Args:
            trace: the outlines of the instance.
            count: outline points at most, on either side.
            weight: of all pairs of one direction together; those of surfaces have 1.
            width: of the robust weight.

        Returns:
            The pulls; ``None`` if the instance has hardly any outline.
        """
        every = max(1, -(-len(trace.faces) // count))
        some = slice(0, len(trace.faces), every)
        faces, views = trace.faces[some], trace.views[some]
        if min(len(faces), self._starts[-1]) < _LEAST:
            return None
        places = _places(trace.pixels[some], trace.normals[some], trace.size)
        starts = np.searchsorted(views, np.arange(len(self._starts)))
        metrics, forces = np.zeros((len(faces), 3, 3)), np.zeros((len(faces), 3))
        spacing = _SPACING_PIXELS * 2.0 * WINDOW / trace.size * every

        def add(rows: Int[np.ndarray, " K"], own: Int[np.ndarray, " K"]) -> None:
            outline_kernels.add_outline_pairs(
                rows, places, own, self._places, views, PASS_FRAMES, spacing, width, weight / len(rows), metrics, forces
            )

        chosen = np.empty(len(faces), dtype=np.int64)
        outline_kernels.match_outlines(places, starts, self._places, self._starts, _ACROSS, chosen)
        add(np.arange(len(faces)), chosen)
        own, own_starts = self._some(count)
        chosen = np.empty(len(own), dtype=np.int64)
        own_places = np.ascontiguousarray(self._places[:, own])
        outline_kernels.match_outlines(own_places, own_starts, places, starts, _ACROSS, chosen)
        add(chosen, own)
        return OutlinePulls(faces, trace.weights[some], metrics, forces)

    def _some(self, count: int) -> tuple[Int[np.ndarray, " M"], Int[np.ndarray, " K"]]:
        """Choose about so many points, the same share of each view."""
        share = min(1.0, count / self._starts[-1])
        counts = np.ceil(share * np.diff(self._starts)).astype(np.int64)
        first = self._starts[:-1]
        chosen = [np.arange(begin, begin + some) for begin, some in zip(first, counts, strict=True)]
        return np.concatenate(chosen), np.concatenate([[0], np.cumsum(counts)])


def _places(pixels: Int[np.ndarray, "N 2"], normals: Float[np.ndarray, "N 2"], size: int) -> Float[np.ndarray, "4 N"]:
    return np.ascontiguousarray(np.concatenate([pixels.T * (2.0 * WINDOW / size), normals.T]))
