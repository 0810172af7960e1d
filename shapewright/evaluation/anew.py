"""The same surface cut into other triangles, so that a query tells nothing of the triangulation that it came from."""

from typing import Final

import numpy as np
from jaxtyping import Float, Int

from shapewright.mesh import TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges, cut_some_edges

TOLERANCE: Final = 2e-4
"""How far the planes of the old triangles may be from a vertex that has moved, as a share of the half extent."""
_LONGEST_EDGE: Final = (0.1, 0.3)
"""Edges are cut to a length in this range, as shares of the half extent: another density than the model's."""
_CUT_SHARE: Final = 0.3
"""Share of the edges, however short, that are cut once more."""
_SLIDES: Final = (0.1, 0.3)
"""How far vertices move along an edge, as shares of its length, as long as the shape allows it."""


def cut_anew(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Return the same surface with other vertices and triangles.

    Edges are cut at random places to a random length, and some once more, which leaves the surface exactly as it is.
    Then every vertex slides along that of its edges that leaves the planes of its triangles least: within flat faces,
    along creases, and on curved surfaces as far as :data:`TOLERANCE` allows. Corners stay. At last vertices and
    triangles are shuffled.

    Args:
        mesh: any surface.
        rng: source of all choices.

    Raises:
        MeshError: the mesh has no area.
    """
    low, high = mesh.bounds
    half_extent = 0.5 * float((high - low).max())
    even = cut_edges(mesh.cleaned(), rng.uniform(*_LONGEST_EDGE) * half_extent, rng)
    fine = cut_some_edges(even, _CUT_SHARE, rng)
    vertices = _slid(fine, TOLERANCE * half_extent, rng)
    order = rng.permutation(len(vertices))
    new_index = np.argsort(order)
    faces = new_index[fine.faces][rng.permutation(len(fine.faces))]
    corners = (rng.integers(3, size=len(faces))[:, None] + np.arange(3)) % 3
    return TriangleMesh(vertices[order], np.take_along_axis(faces, corners, axis=1))


def _slid(mesh: TriangleMesh, tolerance: float, rng: np.random.Generator) -> Float[np.ndarray, "V 3"]:
    """Move each vertex along one of its edges, at most ``tolerance`` out of the planes of its triangles."""
    here = mesh.faces.ravel()
    count = len(mesh.vertices)
    there = np.concatenate([mesh.faces[:, [1, 2, 0]].ravel(), mesh.faces[:, [2, 0, 1]].ravel()])
    keys = np.unique(np.concatenate([here, here]) * count + there)  # by vertex, then by neighbor
    ways = np.stack(np.divmod(keys, count), axis=1)
    off = _off_planes(mesh, ways)
    first = np.searchsorted(ways[:, 0], np.arange(count + 1))
    best = np.lexsort([off, ways[:, 0]])[first[:-1]]  # the flattest way of each vertex
    start, end = mesh.vertices, mesh.vertices[ways[best, 1]]
    wanted = rng.uniform(*_SLIDES, count)
    allowed = tolerance / np.maximum(off[best], 1e-300)
    return np.asarray(start + np.minimum(wanted, allowed)[:, None] * (end - start))


def _off_planes(mesh: TriangleMesh, ways: Int[np.ndarray, "W 2"]) -> Float[np.ndarray, " W"]:
    """Return how far the end of each way is from the planes of the triangles about its start, the farthest."""
    face_of_corner = np.repeat(np.arange(len(mesh.faces)), 3)
    order = np.argsort(mesh.faces.ravel(), kind="stable")
    faces = face_of_corner[order]
    first = np.searchsorted(mesh.faces.ravel()[order], np.arange(len(mesh.vertices) + 1))
    number = np.diff(first)[ways[:, 0]]
    way = np.repeat(np.arange(len(ways)), number)
    within = np.arange(len(way)) - np.repeat(np.cumsum(number) - number, number)
    normals = mesh.face_normals[faces[first[ways[way, 0]] + within]]
    steps = mesh.vertices[ways[:, 1]] - mesh.vertices[ways[:, 0]]
    off = np.abs(np.einsum("nk,nk->n", normals, steps[way]))
    return np.asarray(np.maximum.reduceat(off, np.cumsum(number) - number))
