"""One side only: what a depth camera sees from one place."""

from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from shapewright.errors import MeshError
from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.evaluation.depth_scans import scan_front_and_back
from shapewright.mesh import TriangleMesh


def see_one_side(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Return the surface that one depth picture from a random direction shows, as a grid of new triangles.

    Every vertex lies on the front of the mesh; nothing of the back, and nothing that is hidden, is left.

    Args:
        mesh: any surface.
        strength: pixels along each side of the picture; rounded to an even number.
        rng: source of the direction, uniform.

    Raises:
        MeshError: the mesh is one point, or so thin in every direction that the picture shows nothing.
    """
    frame = np.ascontiguousarray(Rotation.random(rng=rng).as_matrix())
    seen, _ = scan_front_and_back(mesh, frame, 2 * round(strength / 2))
    if seen is None:
        raise MeshError("the picture from this direction shows nothing", where="vertices")
    return seen.cleaned()


HALF: Final = Corruption(
    name="half",
    meaning="pixels along each side of the depth picture that is all there is",
    strengths=(256.0, 128.0, 64.0),
    default=128.0,
    least=16.0,
    most=1024.0,
    corrupt=see_one_side,
)
