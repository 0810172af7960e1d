"""What a classifier looks at: pictures of meshes and point clouds, the same for learning and for answering."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int, UInt8

from shapewright.classification.look import Look
from shapewright.classification.readings import plain_reading
from shapewright.errors import ClassifierError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.rendering.splats import splat_images


def draw(
    objects: Sequence[TriangleMesh | PointCloud],
    rotations: Float[np.ndarray, "N 3 3"],
    scales: Float[np.ndarray, " N"],
    look: Look,
    *,
    shown: Int[np.ndarray, " N"],
) -> UInt8[np.ndarray, "N H W 3"]:
    """Draw pictures of objects.

    Args:
        objects: meshes, and for ``splats`` point clouds, too.
        rotations: of each picture.
        scales: of each picture.
        look: how.
        shown: the object that each picture shows; pictures of one object together.

    Raises:
        ClassifierError: a point cloud, and a style that draws triangles.
        MeshError: an object without area or extent, which only ``splats`` mind.
        RenderingError: no headless OpenGL, which ``splats`` do not need.
    """
    if look.style == "splats":
        clouds = [plain_reading(one).cloud for one in objects]
        return splat_images(clouds, rotations, scales, objects=shown, size=look.image_size)
    from shapewright.rendering.images import render_images

    meshes = [one for one in objects if isinstance(one, TriangleMesh)]
    if len(meshes) < len(objects):
        raise ClassifierError(f"pictures of style {look.style!r} need faces; a point cloud has none", where="style")
    return render_images(
        meshes,
        None,
        rotations,
        scales,
        objects=shown,
        size=look.image_size,
        style=look.style,
        window=look.window,
        framing=look.framing,
    )
