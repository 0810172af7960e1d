"""Decimation: fewer and larger triangles, as in meshes made small for games and the web."""

from typing import Final

import numpy as np

from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.mesh import TriangleMesh

LEAST_FACES: Final = 4
_AGGRESSIONS: Final = (5, 4, 3)
"""How far the package's search may go, 0 to 10: first what reaches the number of faces, then what is more careful."""
_LEAST_AREA: Final = 0.95
"""A search that loses more of the area has given whole parts up, such as the spokes of a bicycle."""


def decimate(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Collapse edges, those first that change the surface least (Garland and Heckbert 1997), until few faces are left.

    No part is given up: a mesh of many small pieces keeps more faces than asked for.

    Args:
        mesh: vertices at the same position are joined first.
        strength: share of the faces to keep.
        rng: not used; the outcome follows from the mesh.

    Raises:
        MeshError: the mesh has no area.
    """
    from fast_simplification import simplify

    normalization = mesh.cleaned().normalized()  # the package works in single precision
    whole = normalization.mesh
    vertices, faces = whole.vertices.astype(np.float32), whole.faces.astype(np.int32)
    wanted = max(LEAST_FACES, round(strength * len(faces)))
    for aggression in _AGGRESSIONS:
        fewer = TriangleMesh(*simplify(vertices, faces, target_count=wanted, agg=aggression))
        if fewer.area >= _LEAST_AREA * whole.area:
            break
    back = (fewer.vertices - normalization.translation) / normalization.scale
    return TriangleMesh(back, fewer.faces).cleaned()


DECIMATED: Final = Corruption(
    name="decimated",
    meaning="share of the faces that are kept",
    strengths=(0.3, 0.1, 0.03),
    default=0.1,
    least=0.001,
    most=1.0,
    corrupt=decimate,
)
