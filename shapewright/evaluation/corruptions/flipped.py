"""Flipped faces: windings that disagree, as in meshes from the web and from careless conversions."""

from typing import Final

import numpy as np

from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.mesh import TriangleMesh


def turn_faces(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Turn random faces over; the surface stays where it is.

    Args:
        mesh: vertices at the same position are joined first.
        strength: share of the faces to turn.
        rng: source of the choice.

    Raises:
        MeshError: the mesh has no area.
    """
    whole = mesh.cleaned()
    chosen = rng.permutation(len(whole.faces))[: round(strength * len(whole.faces))]
    faces = whole.faces.copy()
    faces[chosen] = faces[chosen, ::-1]
    return TriangleMesh(whole.vertices, faces)


FLIPPED: Final = Corruption(
    name="flipped",
    meaning="share of the faces that are turned over",
    strengths=(0.25, 0.5, 1.0),
    default=0.5,
    least=0.0,
    most=1.0,
    corrupt=turn_faces,
)
