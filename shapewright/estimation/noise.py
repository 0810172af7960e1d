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

FEWEST_VERTICES, MOST_VERTICES = 1000, 400_000
"""Meshes with fewer vertices show no noise, those with more take seconds to look at; they stay as they are."""
_SIZES: Final = (0.0005, 0.02)
"""Median distance of a vertex from the middle of its neighbors, as a share of the diagonal. Below the first number a
mesh needs no smoothing; above the second no shape is left that smoothing could bring back."""
_SPREAD: Final = (0.43, 0.51)
"""Quarter of these distances over their median: 0.47 for normally distributed ones. Flat faces and creases differ."""
_ALIKE: Final = -0.05
"""Correlation of these distances with those of neighbors, below which they are noise: such vertices push each other
out, while those of a curved surface lie on one side together."""
_SMOOTHED: Final = 4
"""How often normals are averaged with those of the neighbors before distances are measured along them."""
_CLIPPED: Final = 3.0
"""Distances larger than so many medians count no more: a few creases would decide otherwise."""
_PASSES: Final = 20
"""Passes of the smoothing; 40 brought parameters hardly nearer, 5 clearly less."""
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
    if not FEWEST_VERTICES <= len(welded.vertices) <= MOST_VERTICES:
        return mesh
    checkpoint()
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
    off, areas = _off_the_surface(mesh, middles)
    heights = np.linalg.norm(off, axis=1)
    order = np.argsort(heights)
    shares = np.cumsum(areas[order]) / areas.sum()
    quarter, median = heights[order][np.searchsorted(shares, (0.25, 0.5))]
    low, high = mesh.bounds
    least, most = (size * float(np.linalg.norm(high - low)) for size in _SIZES)
    if not (least < median < most and _SPREAD[0] * median < quarter < _SPREAD[1] * median):
        return False
    clipped = off * np.minimum(1.0, _CLIPPED * median / np.maximum(heights, 1e-300))[:, None]
    together = (clipped * (middles @ clipped)).sum(axis=1)
    return bool(areas @ together < _ALIKE * (areas @ (clipped**2).sum(axis=1)))


def _off_the_surface(
    mesh: TriangleMesh, middles: sparse.csr_array
) -> tuple[Float[np.ndarray, "V 3"], Float[np.ndarray, " V"]]:
    """Return how far each vertex is from the middle of its neighbors, across the surface, and the area about it.

    Which way a triangle faces does not matter: the mean of n n^T stands for the normal n.
    """
    count, corners, areas = len(mesh.vertices), mesh.faces.ravel(), np.repeat(mesh.face_areas, 3)
    facing = np.repeat(mesh.face_normals, 3, axis=0)
    across = np.empty((count, 9))
    for k in range(9):
        across[:, k] = np.bincount(corners, areas * facing[:, k // 3] * facing[:, k % 3], count)
    for _ in range(_SMOOTHED):
        across += middles @ across
    normals = np.linalg.eigh(across.reshape(-1, 3, 3))[1][:, :, 2]
    off = mesh.vertices - middles @ mesh.vertices
    off = (off * normals).sum(axis=1, keepdims=True) * normals
    return off, np.bincount(corners, areas, count)
