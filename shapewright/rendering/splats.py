"""Pictures of points: what classifiers see of meshes, scans and point clouds alike (ours; in place of section 3.2).

A mesh is drawn by points spread evenly over its surface, a point cloud by its own. Every point is a disc that is wide
enough to overlap its neighbors, and depths are averaged over overlapping discs before shading. So a picture shows the
shape and not the triangles: winding, soup, noise much smaller than a disc, and missing faces hardly change it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float, Float32, Int, UInt8

from shapewright.errors import MeshError, RenderingError

RADIUS: Final = 0.03
"""Radius of a disc, in units of an object whose farthest point is 1 from its middle."""
REACH: Final = 1.6
"""Radius of the discs of thin clouds, in distances between neighboring points."""


@dataclass(frozen=True, eq=False)
class SplatCloud:
    """Points to draw, in their frame: the middle of their box at the origin, the farthest at distance 1.

    Args:
        points: positions.
        radius: of the disc of each point, in the same unit.
    """

    points: Float32[np.ndarray, "N 3"]
    radius: float


def splat_cloud(points: Float[np.ndarray, "N 3"], spacing: float) -> SplatCloud:
    """Put points into their frame, with discs that overlap.

    Args:
        points: positions in any unit.
        spacing: side of the square that each point has to itself on the surface, in the same unit.

    Raises:
        MeshError: all points are at one place.
    """
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    centered = points - middle
    reach = float(np.sqrt((centered**2).sum(axis=1).max()))
    if not reach > 0:
        raise MeshError("all points are at one place", where="points")
    return SplatCloud((centered / reach).astype(np.float32), max(RADIUS, REACH * spacing / reach))


def splat_images(
    clouds: Sequence[SplatCloud],
    rotations: Float[np.ndarray, "N 3 3"],
    scales: Float[np.ndarray, " N"],
    *,
    objects: Int[np.ndarray, " N"],
    size: int = 224,
) -> UInt8[np.ndarray, "N S S 3"]:
    """Draw pictures: gray surface with dark silhouettes and steps, depth, slope towards the viewer; on white.

    Args:
        clouds: what is shown.
        rotations: of each picture; the camera looks along -z with y up.
        scales: of each picture; at 1 an object's sphere touches the rim.
        objects: which cloud each picture shows.
        size: pixels a side.

    Raises:
        RenderingError: a picture of no cloud, or no pixels.
    """
    from shapewright.rendering.splat_kernels import draw_splats

    shown = np.asarray(objects, dtype=np.int64)
    if len(shown) and not (shown.min() >= 0 and shown.max() < len(clouds)):
        raise RenderingError(f"a picture shows an object that is not among the {len(clouds)}", where="objects")
    if size < 1:
        raise RenderingError("a picture has at least one pixel", where="size")
    images = np.empty((len(shown), size, size, 3), dtype=np.uint8)
    if len(shown) == 0:
        return images
    starts = np.cumsum([0, *(len(cloud.points) for cloud in clouds)])
    turns = (np.asarray(rotations) * np.asarray(scales)[:, None, None]).astype(np.float32)
    radii = np.array([cloud.radius for cloud in clouds])[shown] * np.asarray(scales)
    draw_splats(
        np.concatenate([cloud.points for cloud in clouds]), starts, shown, turns, radii.astype(np.float32), images
    )
    return images
