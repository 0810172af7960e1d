"""Holes: patches of the surface that are missing, as where a scanner sees nothing."""

from typing import Final

import numpy as np

from shapewright.evaluation.corruptions.corruption import Corruption, diagonal
from shapewright.mesh import TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges

RADII: Final = (0.03, 0.09)
"""Smallest and largest radius of a patch, as shares of the diagonal."""
_LONGEST_EDGE: Final = 0.02
"""Edges are first cut to this share of the diagonal, so that patches are round on large faces, too."""


def cut_holes(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Take round patches away until the given share of the area is gone.

    A patch is a ball about a random point of what is left; its radius is uniform in :data:`RADII`. The last one takes
    the nearest triangles only, so that the share is met within one small triangle. At least one triangle stays.

    Args:
        mesh: any surface.
        strength: share of the area to take away.
        rng: source of the patches.
    """
    length = diagonal(mesh)
    fine = cut_edges(mesh.cleaned(), _LONGEST_EDGE * length)
    areas, centers = fine.face_areas, fine.triangles.mean(axis=1)
    wanted = strength * fine.area
    kept = np.ones(len(fine.faces), dtype=bool)
    gone = 0.0
    while gone < wanted:
        left = np.flatnonzero(kept)
        sums = np.cumsum(areas[left])
        middle = left[min(int(np.searchsorted(sums, rng.random() * sums[-1], side="right")), len(left) - 1)]
        distances = np.linalg.norm(centers[left] - centers[middle], axis=1)
        inside = distances <= rng.uniform(*RADII) * length
        taken = left[inside][np.argsort(distances[inside], kind="stable")]
        taken = taken[: int(np.searchsorted(np.cumsum(areas[taken]), wanted - gone)) + 1]
        if len(taken) == len(left):
            break
        kept[taken] = False
        gone += float(areas[taken].sum())
    return TriangleMesh(fine.vertices, fine.faces[kept]).cleaned()


HOLES: Final = Corruption(
    name="holes",
    meaning="share of the area that is missing",
    strengths=(0.1, 0.2, 0.4),
    default=0.2,
    least=0.0,
    most=0.9,
    corrupt=cut_holes,
)
