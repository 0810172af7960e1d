"""Clustered vertices: positions rounded to a coarse grid, as in meshes that were compressed or made small in haste."""

from typing import Final

import numpy as np

from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.mesh import TriangleMesh


def cluster_vertices(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Move every vertex to the center of its cell of a grid, then merge vertices and drop faces that collapse.

    Faces that then have the same three vertices are merged as well, whatever their winding: the two sides of a thin
    plate become one sheet.

    Args:
        mesh: any surface.
        strength: cells along the longest side of the bounding box.
        rng: source of the grid's place.

    Raises:
        MeshError: the mesh has no area, or every face collapses.
    """
    whole = mesh.cleaned()
    low, high = whole.bounds
    side = float((high - low).max()) / strength
    corner = low - side * rng.random(3)
    centers = corner + side * (np.floor((whole.vertices - corner) / side) + 0.5)
    merged = TriangleMesh(centers, whole.faces).cleaned()
    _, first = np.unique(np.sort(merged.faces, axis=1), axis=0, return_index=True)
    return TriangleMesh(merged.vertices, merged.faces[np.sort(first)])


CLUSTERED: Final = Corruption(
    name="clustered",
    meaning="cells along the longest side of the grid that vertices are rounded to",
    strengths=(48.0, 24.0, 16.0),
    default=24.0,
    least=2.0,
    most=4096.0,
    corrupt=cluster_vertices,
)
