"""Checks of many variations at once, in bounded memory: finite, no face without area, no component inside out, none
that floats apart, sane extents.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from shapewright.modeling.compiled import CompiledModel
from shapewright.progress import NULL_PROGRESS, Progress

VARIATION_CHECKS: Final = ("finite", "faces", "volume", "together", "extent")

GREATEST: Final = 1e100
"""Largest coordinate; volumes of larger ones overflow."""
LEAST_AREA: Final = 1e-12
"""Smallest area of a triangle, in squared diagonals of its instance."""
DIAGONALS: Final = (0.05, 20.0)
"""Smallest and largest diagonal, in diagonals of the base model."""
LEAST_EXTENT: Final = 0.002
"""Smallest extent along any axis, in diagonals of the instance."""
WIDEST_GAP: Final = 0.005
"""Space that may be between the bounding boxes of a component and the rest, in diagonals."""

_CHUNK_TRIANGLES: Final = 150_000
_PAIRS: Final = 500_000
"""Pairs of components whose distances are in memory at once."""


@dataclass(frozen=True)
class Fault:
    """What is wrong in some rows of values; ``row`` is the worst of them."""

    check: str
    where: str
    message: str
    row: int


@dataclass
class _Tally:
    count: int = 0
    worst: float = np.inf
    row: int = 0

    def add(self, rows: Int[np.ndarray, " N"], scores: Float[np.ndarray, " N"]) -> None:
        """Count rows at fault; the smallest score is the worst."""
        if len(rows):
            self.count += len(rows)
            least = int(np.argmin(scores))
            if scores[least] < self.worst:
                self.worst, self.row = float(scores[least]), int(rows[least])


class _Surface:
    """The triangles of a model after subdivision, sorted by connected component."""

    def __init__(self, compiled: CompiledModel) -> None:
        triangles = compiled.surface_triangles()
        n_vertices = compiled.surface_polygons().n_vertices
        links = sparse.coo_array(
            (np.ones(2 * len(triangles)), (triangles[:, [0, 0]].ravel(), triangles[:, 1:].ravel())),
            shape=(n_vertices, n_vertices),
        )
        self.count, of_vertex = connected_components(links.tocsr(), directed=False)
        order = np.argsort(of_vertex[triangles[:, 0]], kind="stable")
        self.triangles: Int[np.ndarray, "F 3"] = triangles[order]
        of_triangle = of_vertex[self.triangles[:, 0]]
        self.first = np.searchsorted(of_triangle, np.arange(self.count))
        self.of_triangle = of_triangle
        self.vertex_order = np.argsort(of_vertex, kind="stable")
        self.first_vertex = np.searchsorted(of_vertex[self.vertex_order], np.arange(self.count))
        parts = compiled.surface_parts()
        self.part: Int[np.ndarray, " K"] = parts[self.vertex_order[self.first_vertex]]
        # the rows of control vertices come first among those of a refined mesh
        named = np.full(self.count, -1)
        named[of_vertex[: len(compiled.control_components)]] = compiled.control_components
        self.names = [f"component c{number}" for number in named]
        self.closed: Bool[np.ndarray, " K"] = self._closed(n_vertices)

    def _closed(self, n_vertices: int) -> Bool[np.ndarray, " K"]:
        edges = np.sort(self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        keys = edges[:, 0] * n_vertices + edges[:, 1]
        _, inverse, counts = np.unique(keys, return_inverse=True, return_counts=True)
        open_edges = (counts[inverse] != 2).reshape(-1, 3).any(axis=1)
        closed = np.ones(self.count, dtype=bool)
        closed[self.of_triangle[open_edges]] = False
        return closed


def check_variations(
    compiled: CompiledModel, values: Float[np.ndarray, "B P"], progress: Progress = NULL_PROGRESS
) -> list[Fault]:
    """Check every row of values; the first is the base model, which sets the scale."""
    surface = _Surface(compiled)
    present_parts = np.hstack([compiled.parts_present(values), np.ones((len(values), 1), dtype=bool)])
    present: Bool[np.ndarray, "B K"] = present_parts[:, surface.part]
    base_diagonal = 0.0
    tallies: dict[tuple[str, str], _Tally] = {}

    def tally(check: str, where: str, rows: Int[np.ndarray, " N"], scores: Float[np.ndarray, " N"]) -> None:
        if len(rows):
            tallies.setdefault((check, where), _Tally()).add(rows, scores)

    for start, chunk in _chunks(compiled, values, len(surface.triangles)):
        progress.report(start / len(values), f"variations: {start} of {len(values)}")
        finite = (np.abs(chunk) <= GREATEST).all(axis=(1, 2))
        tally("finite", "", start + np.flatnonzero(~finite), np.zeros(int((~finite).sum())))
        rows = start + np.flatnonzero(finite)
        if len(rows) == 0:
            continue
        xyz = np.ascontiguousarray(chunk[finite].transpose(2, 0, 1))  # what runs over vertices is many times faster
        extents = xyz.max(axis=2) - xyz.min(axis=2)
        diagonals = np.linalg.norm(extents, axis=0)
        if start == 0 and finite[0]:
            base_diagonal = float(diagonals[0])
        relative = diagonals / (base_diagonal or 1.0)
        tally("extent", "small", *_below(rows, relative, DIAGONALS[0]))
        tally("extent", "large", *_below(rows, -relative, -DIAGONALS[1]))
        flat = np.divide(extents.min(axis=0), diagonals, out=np.zeros(len(rows)), where=diagonals > 0)
        tally("extent", "flat", *_below(rows, flat, LEAST_EXTENT))
        there = present[rows]
        areas, volumes = _areas_and_volumes(xyz, surface)
        least = np.minimum.reduceat(areas, surface.first, axis=1) / np.maximum(diagonals, 1e-300)[:, None] ** 2
        gaps = _gaps(xyz, diagonals, there, surface) / np.maximum(diagonals, 1e-300)[:, None]
        for k in range(surface.count):
            mine = there[:, k]
            tally("faces", surface.names[k], *_below(rows[mine], least[mine, k], LEAST_AREA))
            if surface.closed[k]:
                tally("volume", surface.names[k], *_below(rows[mine], volumes[mine, k], 0.0))
            tally("together", surface.names[k], *_below(rows[mine], -gaps[mine, k], -WIDEST_GAP))
    return [
        Fault(check, "" if check == "extent" else where, _message(check, where, tally_, len(values)), tally_.row)
        for check in VARIATION_CHECKS
        for (its_check, where), tally_ in tallies.items()
        if its_check == check
    ]


def _chunks(
    compiled: CompiledModel, values: Float[np.ndarray, "B P"], n_triangles: int
) -> Iterator[tuple[int, Float[np.ndarray, "C V 3"]]]:
    size = max(1, _CHUNK_TRIANGLES // n_triangles)
    for start, chunk in compiled.surface_chunks(values):
        for first in range(0, len(chunk), size):
            yield start + first, chunk[first : first + size]


def _below(
    rows: Int[np.ndarray, " N"], scores: Float[np.ndarray, " N"], bound: float
) -> tuple[Int[np.ndarray, " M"], Float[np.ndarray, " M"]]:
    at_fault = scores <= bound
    return rows[at_fault], scores[at_fault]


def _areas_and_volumes(
    xyz: Float[np.ndarray, "3 C V"], surface: _Surface
) -> tuple[Float[np.ndarray, "C F"], Float[np.ndarray, "C K"]]:
    """Area of each triangle and volume of each component; the latter means something where it is closed."""
    x, y, z = xyz - xyz.mean(axis=2, keepdims=True)
    ia, ib, ic = surface.triangles.T
    ax, ay, az = x[:, ia], y[:, ia], z[:, ia]
    ux, uy, uz = x[:, ib] - ax, y[:, ib] - ay, z[:, ib] - az
    vx, vy, vz = x[:, ic] - ax, y[:, ic] - ay, z[:, ic] - az
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    areas = 0.5 * np.sqrt(nx * nx + ny * ny + nz * nz)
    volumes = np.add.reduceat(ax * nx + ay * ny + az * nz, surface.first, axis=1) / 6.0
    return areas, volumes


def _gaps(
    xyz: Float[np.ndarray, "3 C V"],
    diagonals: Float[np.ndarray, " C"],
    there: Bool[np.ndarray, "C K"],
    surface: _Surface,
) -> Float[np.ndarray, "C K"]:
    """How far the bounding box of each component is from the nearest of another group that it does not touch.

    Components whose boxes touch (or nearly) are a group. What is not in the largest group gets its distance to the
    nearest component outside of its own group, everything else 0.
    """
    gaps = np.zeros(there.shape)
    if surface.count == 1:
        return gaps
    ordered = xyz[:, :, surface.vertex_order]
    low = np.minimum.reduceat(ordered, surface.first_vertex, axis=2)
    high = np.maximum.reduceat(ordered, surface.first_vertex, axis=2)
    for row, mine in enumerate(there):
        chosen = np.flatnonzero(mine)
        boxes = _Boxes(low[:, row, chosen], high[:, row, chosen])
        group = boxes.groups(WIDEST_GAP * diagonals[row])
        largest = np.bincount(group).argmax()
        for floating in np.flatnonzero(group != largest):
            others = np.flatnonzero(group != group[floating])
            gaps[row, chosen[floating]] = boxes.distances(np.array([floating]), others).min()
    return gaps


@dataclass(frozen=True)
class _Boxes:
    """Bounding boxes; all pairs of them at once may be too many for the memory."""

    low: Float[np.ndarray, "3 K"]
    high: Float[np.ndarray, "3 K"]

    def distances(self, some: Int[np.ndarray, " S"], others: Int[np.ndarray, " O"]) -> Float[np.ndarray, "S O"]:
        """Space between boxes; 0 if they touch."""
        low, high = self.low[:, some, None], self.high[:, some, None]
        apart = np.maximum(low - self.high[:, None, others], self.low[:, None, others] - high)
        return np.asarray(np.linalg.norm(np.maximum(apart, 0.0), axis=0))

    def groups(self, reach: float) -> Int[np.ndarray, " K"]:
        """Number the boxes so that those equal that are connected by steps of at most ``reach``."""
        group = np.full(self.low.shape[1], -1)
        at_once = max(1, _PAIRS // len(group))
        for number in range(len(group)):
            alone = np.flatnonzero(group < 0)
            if len(alone) == 0:
                break
            waiting = alone[:1]
            group[waiting] = number
            while len(waiting) and len(alone := np.flatnonzero(group < 0)):
                found = alone[(self.distances(waiting[:at_once], alone) <= reach).any(axis=0)]
                group[found] = number
                waiting = np.concatenate([waiting[at_once:], found])
        return group


def _message(check: str, where: str, tally: _Tally, total: int) -> str:
    place = f"variation {tally.row - 1}" if tally.row else "the base model"
    many = f"{tally.count} of {total} variations"
    if check == "finite":
        return f"{many} have coordinates that are not finite or beyond {GREATEST:g}, such as {place}"
    if check == "faces":
        return f"{many} have a face without area; worst is {place} ({tally.worst:.1g} of the squared diagonal)"
    if check == "volume":
        return f"it is inside out or empty in {many}; worst is {place}"
    if check == "together":
        return f"it touches nothing in {many}; worst is {place} (a gap of {-tally.worst:.2g} diagonals)"
    if where == "flat":
        return f"{many} are flat; worst is {place} (extent {tally.worst:.2g} of the diagonal)"
    return f"{many} are too {where}; worst is {place} ({abs(tally.worst):.3g} x the base model)"
