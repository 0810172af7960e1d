"""Outliers: debris that floats about the object, as where a scanner measures reflections or the air."""

from typing import Final

import numpy as np

from shapewright.evaluation.corruptions.corruption import Corruption, diagonal
from shapewright.mesh import TriangleMesh
from shapewright.mesh.joining import joined

SIZE: Final = 0.015
"""Side of the cube that holds one piece of debris, as a share of the diagonal; a triangle's sides are about 1 %."""
MARGIN: Final = 0.1
"""How far the debris reaches beyond the bounding box on every side, as a share of the diagonal."""


def add_outliers(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Add small random triangles at random places in a box that is a little larger than the object's.

    Args:
        mesh: vertices at the same position are joined first; its faces come first in the outcome.
        strength: number of triangles, rounded.
        rng: source of their places and shapes, both uniform.

    Raises:
        MeshError: the mesh has no area.
    """
    whole = mesh.cleaned()
    count = round(strength)
    if count == 0:
        return whole
    length = diagonal(whole)
    low, high = whole.bounds
    centers = rng.uniform(low - MARGIN * length, high + MARGIN * length, (count, 3))
    corners = centers[:, None] + rng.uniform(-0.5 * SIZE * length, 0.5 * SIZE * length, (count, 3, 3))
    debris = TriangleMesh(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    return joined([whole, debris])


OUTLIERS: Final = Corruption(
    name="outliers",
    meaning="small triangles that float about the object",
    strengths=(50.0, 150.0, 500.0),
    default=150.0,
    least=0.0,
    most=100_000.0,
    corrupt=add_outliers,
)
