"""Several meshes as one."""

from collections.abc import Sequence

import numpy as np

from shapewright.mesh.triangle_mesh import TriangleMesh


def joined(parts: Sequence[TriangleMesh]) -> TriangleMesh:
    """Return one mesh with the vertices and faces of all parts, in their order; nothing is welded."""
    starts = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    return TriangleMesh(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=True)]),
    )
