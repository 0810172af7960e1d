"""Points as dense on a surface as pictures need them."""

import numpy as np
from jaxtyping import Float

from shapewright.classification.readings import plain_reading
from shapewright.mesh import PointCloud, TriangleMesh


def dense_points(mesh: TriangleMesh | PointCloud) -> Float[np.ndarray, "N 3"]:
    """Return points spread evenly over a surface, or those of a point cloud; the same ones each time.

    Raises:
        MeshError: the surface has no area.
    """
    return plain_reading(mesh).points
