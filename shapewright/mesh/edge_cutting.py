"""Cutting of long edges: the same surface with smaller triangles, without gaps where triangles share an edge."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.mesh import TriangleMesh

MOST_FACES: Final = 400_000
"""A surface is not cut further once it has this many triangles."""
_MOST_PASSES: Final = 64
_MIDDLE: Final = (0.35, 0.65)
"""Where a random cut lies, as a share of the edge."""

Faces = Int[np.ndarray, "F 3"]
ShareAt = Callable[[Float[np.ndarray, "E 3"]], Float[np.ndarray, " E"]]
"""Takes the middles of edges; returns how probable it is that each of them is cut."""


def cut_edges(mesh: TriangleMesh, longest: float, rng: np.random.Generator | None = None) -> TriangleMesh:
    """Cut every edge that is longer than ``longest``; new vertices lie on old edges, so the surface stays as it is.

    Triangles that share an edge (by vertex index) also share its cuts. With ``rng`` an edge is cut anywhere near its
    middle, otherwise in the middle. Cutting stops early at :data:`MOST_FACES`.
    """
    for _ in range(_MOST_PASSES):
        edges = _Edges.of(mesh)
        long = edges.lengths > longest
        if not long.any() or len(mesh.faces) >= MOST_FACES:
            break
        mesh = edges.cut(long, rng)
    return mesh


def cut_some_edges(mesh: TriangleMesh, share: float | ShareAt, rng: np.random.Generator) -> TriangleMesh:
    """Cut about this share of the edges, whichever, each anywhere near its middle; the surface stays as it is.

    The share may depend on the place of an edge, so that part of a surface is divided more finely.
    """
    edges = _Edges.of(mesh)
    chances = share(mesh.vertices[edges.ends].mean(axis=1)) if callable(share) else share
    return edges.cut(rng.random(len(edges.ends)) < chances, rng)


@dataclass(frozen=True, eq=False)
class _Edges:
    """The edges of a mesh: their two vertices, and which edges the sides 0-1, 1-2 and 2-0 of each face are."""

    mesh: TriangleMesh
    ends: Int[np.ndarray, "E 2"]
    of_face: Faces

    @classmethod
    def of(cls, mesh: TriangleMesh) -> "_Edges":
        count = len(mesh.vertices)
        sides = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        keys, edge_of_side = np.unique(sides[:, 0] * count + sides[:, 1], return_inverse=True)
        return cls(mesh, np.stack(np.divmod(keys, count), axis=1), edge_of_side.reshape(-1, 3))

    @property
    def lengths(self) -> Float[np.ndarray, " E"]:
        start, end = self.mesh.vertices[self.ends].transpose(1, 0, 2)
        return np.asarray(np.linalg.norm(end - start, axis=1))

    def cut(self, chosen: Bool[np.ndarray, " E"], rng: np.random.Generator | None) -> TriangleMesh:
        """Cut the chosen edges, in the middle or, with ``rng``, near it."""
        vertices = self.mesh.vertices
        start, end = vertices[self.ends[chosen]].transpose(1, 0, 2)
        share = np.full(len(start), 0.5) if rng is None else rng.uniform(*_MIDDLE, len(start))
        cut_of_edge = np.full(len(self.ends), -1)
        cut_of_edge[chosen] = len(vertices) + np.arange(len(start))
        vertices = np.concatenate([vertices, start + share[:, None] * (end - start)])
        return TriangleMesh(vertices, _divided(vertices, self.mesh.faces, cut_of_edge[self.of_face]))


def _divided(vertices: Float[np.ndarray, "V 3"], faces: Faces, cuts: Faces) -> Int[np.ndarray, "G 3"]:
    """Divide each triangle at the cuts (a vertex, or -1) of its sides 0-1, 1-2 and 2-0."""
    count = (cuts >= 0).sum(axis=1)
    parts = [faces[count == 0]]
    one, cut = _turned(faces, cuts, count == 1, (cuts >= 0).argmax(axis=1))
    a, b, c, p = one[:, 0], one[:, 1], one[:, 2], cut[:, 0]
    parts += [np.stack([a, p, c], 1), np.stack([p, b, c], 1)]
    two, cut = _turned(faces, cuts, count == 2, ((cuts < 0).argmax(axis=1) + 1) % 3)  # the last side stays whole
    a, b, c, p, q = two[:, 0], two[:, 1], two[:, 2], cut[:, 0], cut[:, 1]
    shorter = _distance(vertices, p, c) < _distance(vertices, a, q)
    parts.append(np.stack([p, b, q], 1))
    parts.append(np.where(shorter[:, None], np.stack([a, p, c], 1), np.stack([a, p, q], 1)))
    parts.append(np.where(shorter[:, None], np.stack([p, q, c], 1), np.stack([a, q, c], 1)))
    three, cut = faces[count == 3], cuts[count == 3]
    (a, b, c), (p, q, r) = three.T, cut.T
    parts += [np.stack([a, p, r], 1), np.stack([p, b, q], 1), np.stack([r, q, c], 1), np.stack([p, q, r], 1)]
    return np.concatenate(parts)


def _turned(
    faces: Faces, cuts: Faces, chosen: Bool[np.ndarray, " F"], first: Int[np.ndarray, " F"]
) -> tuple[Int[np.ndarray, "G 3"], Int[np.ndarray, "G 3"]]:
    """Take the chosen triangles and their cuts, beginning at a given corner."""
    order = (first[chosen][:, None] + np.arange(3)) % 3
    return np.take_along_axis(faces[chosen], order, axis=1), np.take_along_axis(cuts[chosen], order, axis=1)


def _distance(
    vertices: Float[np.ndarray, "V 3"], a: Int[np.ndarray, " F"], b: Int[np.ndarray, " F"]
) -> Float[np.ndarray, " F"]:
    return np.asarray(np.linalg.norm(vertices[a] - vertices[b], axis=1))
