"""Uneven density: vertices crowded on one part of the surface, as where a mesh was refined or scanned twice."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.evaluation.corruptions.corruption import Corruption, diagonal
from shapewright.evaluation.corruptions.decimated import decimate
from shapewright.mesh import TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges, cut_some_edges

SHARE: Final = 0.35
"""Share of the area that is finely divided."""
MOST_FACES: Final = 6_000
"""Meshes with more faces are decimated to this number first, and not below."""
LONGEST_EDGE: Final = 0.06
"""Longest edge of the coarse part, as a share of the diagonal; longer where soup has very much area in little room."""
_ALL_CUT: Final = 4.0
"""Factor of the number of vertices when every edge is cut once: a surface has three edges for each vertex."""


def divide_unevenly(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Divide the part of the surface that lies farthest in a random direction more finely, and leave the rest.

    The surface stays as it is where the mesh has few faces. Many faces are first made fewer, so that the coarse part is
    coarse; that moves the surface as little as decimation can. No gap opens between the parts.

    Args:
        mesh: vertices at the same position are joined first.
        strength: factor by which the vertices of the fine part are denser than they would be otherwise.
        rng: source of the direction and of where edges are cut.

    Raises:
        MeshError: the mesh has no area.
    """
    whole = mesh.cleaned()
    if len(whole.faces) > MOST_FACES:
        whole = decimate(whole, MOST_FACES / len(whole.faces), rng)
    direction = rng.normal(size=3)
    regular = np.sqrt(4.0 / np.sqrt(3.0) * whole.area / MOST_FACES)  # edge of that many equal triangles
    mesh = cut_edges(whole, max(LONGEST_EDGE * diagonal(whole), 2.0 * float(regular)))
    heights = mesh.triangles.mean(axis=1) @ direction
    order = np.argsort(-heights)
    border = heights[order[int(np.searchsorted(np.cumsum(mesh.face_areas[order]), SHARE * mesh.area))]]
    left = strength
    while left > 1.0:
        share = min(1.0, (left - 1.0) / (_ALL_CUT - 1.0))
        mesh = cut_some_edges(mesh, _Beyond(direction, border, share), rng)
        left /= _ALL_CUT
    return mesh


@dataclass(frozen=True, eq=False)
class _Beyond:
    """A share on one side of a plane, and none on the other."""

    direction: Float[np.ndarray, " 3"]
    border: float
    share: float

    def __call__(self, places: Float[np.ndarray, "N 3"]) -> Float[np.ndarray, " N"]:
        return np.where(places @ self.direction >= self.border, self.share, 0.0)


UNEVEN: Final = Corruption(
    name="uneven",
    meaning="factor by which vertices are denser on a third of the surface",
    strengths=(2.0, 4.0, 16.0),
    default=4.0,
    least=1.0,
    most=64.0,
    corrupt=divide_unevenly,
)
