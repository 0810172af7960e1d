"""Catmull-Clark subdivision with creases as one sparse matrix a step (Catmull, Clark 1978; DeRose et al. 1998).

An edge marked sharp, or with one face only, is a crease. A vertex with one such edge is a dart (treated as smooth),
with two a crease vertex, with three or more a corner; a vertex marked sharp is a corner too.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int
from scipy import sparse

Loop = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Polygons:
    """A topology with compact vertex numbers.

    Attributes:
        n_vertices: number of vertices.
        loops: the faces, counter-clockwise from outside.
        sharp_edges: pairs of vertices, the smaller first.
        sharp_vertices: corners.
    """

    n_vertices: int
    loops: tuple[Loop, ...]
    sharp_edges: frozenset[tuple[int, int]] = frozenset()
    sharp_vertices: frozenset[int] = frozenset()

    def triangles(self) -> Int[np.ndarray, "F 3"]:
        """Cut every polygon into a fan of triangles from its first vertex."""
        return np.array(
            [(loop[0], loop[i], loop[i + 1]) for loop in self.loops for i in range(1, len(loop) - 1)],
            dtype=np.int64,
        )


@dataclass(frozen=True, eq=False)
class SubdivisionStep:
    """One step: new positions are ``matrix @ positions``, for any number of instances at once.

    Attributes:
        matrix: (V', V) in CSR form; every row sums to 1.
        refined: the topology after the step, all quads. The vertices of the old one come first, then one for each
            edge, then one for each face.
    """

    matrix: sparse.csr_array
    refined: Polygons


def subdivide(polygons: Polygons) -> SubdivisionStep:
    """Build one step of Catmull-Clark subdivision."""
    edge_faces: dict[tuple[int, int], list[int]] = defaultdict(list)
    for face_index, loop in enumerate(polygons.loops):
        for pair in _edges(loop):
            edge_faces[pair].append(face_index)
    creases = {pair for pair, faces in edge_faces.items() if len(faces) != 2 or pair in polygons.sharp_edges}
    edge_index = {pair: polygons.n_vertices + i for i, pair in enumerate(edge_faces)}
    first_face = polygons.n_vertices + len(edge_index)

    rows = _Rows()
    _vertex_points(rows, polygons, edge_faces, creases)
    for pair, faces in edge_faces.items():
        if pair in creases:
            rows.add(edge_index[pair], pair, 0.5)
            continue
        rows.add(edge_index[pair], pair, 0.25)
        for face_index in faces:
            loop = polygons.loops[face_index]
            rows.add(edge_index[pair], loop, 0.25 / len(loop))
    for face_index, loop in enumerate(polygons.loops):
        rows.add(first_face + face_index, loop, 1.0 / len(loop))

    refined = Polygons(
        n_vertices=first_face + len(polygons.loops),
        loops=tuple(
            (
                vertex,
                edge_index[_key(vertex, after)],
                first_face + face_index,
                edge_index[_key(before, vertex)],
            )
            for face_index, loop in enumerate(polygons.loops)
            for before, vertex, after in zip(loop[-1:] + loop[:-1], loop, loop[1:] + loop[:1], strict=True)
        ),
        sharp_edges=frozenset(
            half
            for pair in polygons.sharp_edges
            if pair in edge_index
            for half in ((pair[0], edge_index[pair]), (pair[1], edge_index[pair]))
        ),
        sharp_vertices=polygons.sharp_vertices,
    )
    return SubdivisionStep(rows.matrix((refined.n_vertices, polygons.n_vertices)), refined)


def _vertex_points(
    rows: "_Rows",
    polygons: Polygons,
    edge_faces: dict[tuple[int, int], list[int]],
    creases: set[tuple[int, int]],
) -> None:
    neighbours: dict[int, list[int]] = defaultdict(list)
    creased: dict[int, list[int]] = defaultdict(list)
    for first, second in edge_faces:
        neighbours[first].append(second)
        neighbours[second].append(first)
        if (first, second) in creases:
            creased[first].append(second)
            creased[second].append(first)
    faces: dict[int, list[Loop]] = defaultdict(list)
    for loop in polygons.loops:
        for vertex in loop:
            faces[vertex].append(loop)

    for vertex in range(polygons.n_vertices):
        n_creases = len(creased[vertex])
        if vertex in polygons.sharp_vertices or n_creases > 2 or not faces[vertex]:
            rows.add(vertex, (vertex,), 1.0)
        elif n_creases == 2:
            rows.add(vertex, (vertex,), 0.75)
            rows.add(vertex, creased[vertex], 0.125)
        else:
            n = len(neighbours[vertex])
            rows.add(vertex, (vertex,), (n - 2.0) / n)
            rows.add(vertex, neighbours[vertex], 1.0 / n**2)
            for loop in faces[vertex]:
                rows.add(vertex, loop, 1.0 / (n * len(faces[vertex]) * len(loop)))


class _Rows:
    """Collects the entries of a sparse matrix; entries at one place add up."""

    def __init__(self) -> None:
        self._rows: list[int] = []
        self._columns: list[int] = []
        self._weights: list[float] = []

    def add(self, row: int, columns: Sequence[int], weight: float) -> None:
        self._rows += [row] * len(columns)
        self._columns += columns
        self._weights += [weight] * len(columns)

    def matrix(self, shape: tuple[int, int]) -> sparse.csr_array:
        return sparse.csr_array((self._weights, (self._rows, self._columns)), shape=shape)


def _key(first: int, second: int) -> tuple[int, int]:
    return (first, second) if first < second else (second, first)


def _edges(loop: Loop) -> Iterable[tuple[int, int]]:
    return (_key(first, second) for first, second in zip(loop, loop[1:] + loop[:1], strict=True))
