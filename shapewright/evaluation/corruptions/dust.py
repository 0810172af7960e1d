"""Dust: a few small clumps beside the object, as what else stood on the table when it was scanned."""

from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull

from shapewright.evaluation.corruptions.corruption import Corruption, diagonal
from shapewright.mesh import TriangleMesh
from shapewright.mesh.joining import joined

MOST_CLUMPS: Final = 3
RADII: Final = (0.01, 0.04)
"""Smallest and largest radius of a clump, as shares of the diagonal."""
_CORNERS: Final = 40


def add_dust(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Add one to three clumps outside the bounding box.

    The first clump stands at the full distance from a side of the box, the others anywhere up to it.

    Args:
        mesh: vertices at the same position are joined first; its faces come first in the outcome.
        strength: distance between the bounding box and the farthest clump, as a share of the diagonal.
        rng: source of the number, the places, sizes and shapes of the clumps.

    Raises:
        MeshError: the mesh has no area.
    """
    whole = mesh.cleaned()
    length = diagonal(whole)
    shares = [1.0, *rng.random(rng.integers(MOST_CLUMPS))]
    return joined([whole, *(_clump(whole.bounds, share * strength * length, length, rng) for share in shares)])


def _clump(bounds: Float[np.ndarray, "2 3"], distance: float, length: float, rng: np.random.Generator) -> TriangleMesh:
    """Make an irregular lump at a distance from a random side of a box."""
    directions = rng.normal(size=(_CORNERS, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    corners = rng.uniform(*RADII) * length * rng.uniform(0.8, 1.0, (_CORNERS, 1)) * directions
    axis, end = int(rng.integers(3)), int(rng.integers(2))
    place = rng.uniform(bounds[0], bounds[1])
    outermost = -corners[:, axis].min() if end else -corners[:, axis].max()
    place[axis] = bounds[end, axis] + (distance if end else -distance) + outermost
    return TriangleMesh(place + corners, ConvexHull(directions).simplices).cleaned()


DUST: Final = Corruption(
    name="dust",
    meaning="distance of the farthest of a few small clumps, as a share of the diagonal",
    strengths=(0.1, 0.4, 1.0),
    default=0.4,
    least=0.0,
    most=100.0,
    corrupt=add_dust,
)
