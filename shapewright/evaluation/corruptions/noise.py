"""Noise: vertices moved at random, as a scanner does that measures each point on its own."""

from typing import Final

import numpy as np

from shapewright.evaluation.corruptions.corruption import Corruption, diagonal
from shapewright.mesh import TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges

LONGEST_EDGE: Final = 0.03
"""Edges are first cut to this share of the diagonal: noise on the corners of a large flat face would only tilt it."""


def add_noise(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Move every vertex by independent Gaussian noise.

    Args:
        mesh: vertices at the same position are joined first, so that noise does not tear the surface.
        strength: standard deviation along each axis, as a share of the bounding box's diagonal.
        rng: source of the noise.
    """
    length = diagonal(mesh)
    fine = cut_edges(mesh.cleaned(), LONGEST_EDGE * length)
    return TriangleMesh(fine.vertices + rng.normal(0.0, strength * length, fine.vertices.shape), fine.faces)


NOISE: Final = Corruption(
    name="noise",
    meaning="standard deviation of the noise along each axis, as a share of the diagonal",
    strengths=(0.002, 0.005, 0.01),
    default=0.005,
    least=0.0,
    most=0.1,
    corrupt=add_noise,
)
