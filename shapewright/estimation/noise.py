"""Noise: vertices that a scanner measured each on its own, and a smooth surface instead (ours).

A surface with noise misleads a search: depth images see the outermost vertices, outlines are too wide, thin parts too
thick, and normals point anywhere. What is searched for is the smoothed surface; what an answer is judged by stays the
query as it is.
"""

from collections.abc import Callable
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy import sparse

from shapewright.mesh import TriangleMesh

FEWEST_VERTICES: Final = 1000
_SIZES: Final = (0.0005, 0.05)
"""Median distance of a vertex from the middle of its neighbors, as a share of the diagonal, that may be noise: with
less there is no need to smooth, with more no shape is left."""
_SPREAD: Final = (0.41, 0.55)
"""Quarter of these distances over their median: 0.47 for normally distributed ones. Flat faces and creases differ."""
_ALIKE: Final = -0.03
"""Correlation of these distances with those of neighbors, below which they are noise: such vertices push each other
out, while those of a curved surface lie on one side together."""
_NORMALS_SMOOTHED: Final = 4
_CLIPPED: Final = 3.0
_PASSES: Final = 20
_SHRINK, _GROW = 0.5, 0.52
"""Share of the way to the middle of its neighbors that each vertex goes in a pass, and then back."""


def without_noise(mesh: TriangleMesh, checkpoint: Callable[[], None] = lambda: None) -> TriangleMesh:
    """Return the mesh with its noise smoothed away (Taubin 1995); itself if it has none.

    Shapes as wide as a few edges stay; flat faces get flat, creases round by about an edge.

    Args:
        mesh: connected by its vertices; a soup of triangles has no neighbors to tell noise by.
        checkpoint: called between steps; may raise to stop.
    """
    if len(mesh.vertices) < FEWEST_VERTICES:
        return mesh
    welded = mesh.cleaned()
    if len(welded.vertices) < FEWEST_VERTICES:
        return mesh
    middles = _neighborhood(welded)
    checkpoint()
    if not _is_noisy(welded, middles):
        return mesh
    vertices = welded.vertices
    for _ in range(_PASSES):
        checkpoint()
        for factor in (_SHRINK, -_GROW):
            vertices = vertices + factor * (middles @ vertices - vertices)
    return TriangleMesh(vertices, welded.faces)


def _neighborhood(mesh: TriangleMesh) -> sparse.csr_array:
    """Return the (V, V) matrix that takes vertices to the middles of their neighbors."""
    ends = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    rows, columns = np.concatenate([ends, ends[:, ::-1]]).T
    count = len(mesh.vertices)
    edges = sparse.csr_array((np.ones(len(rows)), (rows, columns)), shape=(count, count))
    edges.data[:] = 1.0  # those of several triangles count once
    return sparse.csr_array(sparse.diags_array(1.0 / edges.sum(axis=1)) @ edges)


def _is_noisy(mesh: TriangleMesh, middles: sparse.csr_array) -> bool:
    """Tell whether vertices lie off the middles of their neighbors as independent noise does."""
    normals, areas = _vertex_normals(mesh)
    for _ in range(_NORMALS_SMOOTHED):
        normals = _unit(normals + middles @ normals)
    heights = ((mesh.vertices - middles @ mesh.vertices) * normals).sum(axis=1)
    order = np.argsort(np.abs(heights))
    shares = np.cumsum(areas[order]) / areas.sum()
    quarter, median = np.abs(heights)[order][np.searchsorted(shares, (0.25, 0.5))]
    low, high = mesh.bounds
    least, most = (size * float(np.linalg.norm(high - low)) for size in _SIZES)
    if not (least < median < most and _SPREAD[0] * median < quarter < _SPREAD[1] * median):
        return False
    clipped = np.clip(heights, -_CLIPPED * median, _CLIPPED * median)
    return bool((areas * clipped) @ (middles @ clipped) < _ALIKE * (areas @ clipped**2))


def _vertex_normals(mesh: TriangleMesh) -> tuple[Float[np.ndarray, "V 3"], Float[np.ndarray, " V"]]:
    """Return the mean normal of each vertex's triangles, and their area."""
    corners, areas = mesh.faces.ravel(), np.repeat(mesh.face_areas, 3)
    weighted = np.repeat(mesh.face_normals * mesh.face_areas[:, None], 3, axis=0)
    count = len(mesh.vertices)
    sums = np.stack([np.bincount(corners, weighted[:, axis], count) for axis in range(3)], axis=1)
    return _unit(sums), np.bincount(corners, areas, count)


def _unit(vectors: Float[np.ndarray, "V 3"]) -> Float[np.ndarray, "V 3"]:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)
