"""Sights: the ways to see a query that a classifier chooses from."""

from dataclasses import dataclass
from typing import Final, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.classification.look import Look
from shapewright.classification.open_side import open_side
from shapewright.classification.pictures import draw
from shapewright.classification.readings import Reading, plain_reading, readings
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.rendering.splats import splat_images
from shapewright.rendering.views import views_about

AROUND_RAD: Final = np.radians(30.0)
"""How far from the direction that a scan was seen from the views of it go."""


@runtime_checkable
class Sight(Protocol):
    """One way to see a query."""

    @property
    def is_rough(self) -> bool:
        """Whether it shows a scanner's traces: a cloud of points, or noise."""
        ...

    def more_views(
        self, rng: np.random.Generator, count: int
    ) -> tuple[Float[np.ndarray, "N 3 3"], Float[np.ndarray, " N"]]:
        """Views that are worth having besides ``count`` evenly spread ones; none of most queries.

        Returns:
            Rotation matrices (N, 3, 3) and scales (N,).
        """

    def images(
        self, rotations: Float[np.ndarray, "N 3 3"], scales: Float[np.ndarray, " N"]
    ) -> UInt8[np.ndarray, "N H W 3"]:
        """Draw it."""

    def surface(self) -> TriangleMesh:
        """Return what is compared with exemplars."""


@dataclass(frozen=True, eq=False)
class DrawnMesh:
    """A query whose triangles are drawn."""

    query: TriangleMesh | PointCloud
    look: Look

    @property
    def is_rough(self) -> bool:
        """Triangles are drawn as they are."""
        return False

    def more_views(
        self, rng: np.random.Generator, count: int
    ) -> tuple[Float[np.ndarray, "N 3 3"], Float[np.ndarray, " N"]]:
        """No more views."""
        return np.empty((0, 3, 3)), np.empty(0)

    def images(
        self, rotations: Float[np.ndarray, "N 3 3"], scales: Float[np.ndarray, " N"]
    ) -> UInt8[np.ndarray, "N H W 3"]:
        """Draw it."""
        return draw([self.query], rotations, scales, self.look, shown=np.zeros(len(scales), dtype=np.int64))

    def surface(self) -> TriangleMesh:
        """Return the mesh itself."""
        return plain_reading(self.query).described_surface()


@dataclass(frozen=True, eq=False)
class DrawnPoints:
    """A query whose points are drawn."""

    reading: Reading
    look: Look

    @property
    def is_rough(self) -> bool:
        """Whether it has no faces, or had noise."""
        return self.reading.surface is None or self.reading.was_noisy

    def more_views(
        self, rng: np.random.Generator, count: int
    ) -> tuple[Float[np.ndarray, "N 3 3"], Float[np.ndarray, " N"]]:
        """As many from the side that a scan was seen from, and as many from behind, if there is such a side."""
        side = open_side(self.reading.cloud.points)
        if side is None:
            return np.empty((0, 3, 3)), np.empty(0)
        views = [
            views_about(rng, direction, count, farthest_rad=AROUND_RAD, scale_range=self.look.scale_range)
            for direction in (side, -side)
        ]
        rotations, scales = zip(*views, strict=True)
        return np.concatenate(rotations), np.concatenate(scales)

    def images(
        self, rotations: Float[np.ndarray, "N 3 3"], scales: Float[np.ndarray, " N"]
    ) -> UInt8[np.ndarray, "N H W 3"]:
        """Draw it."""
        shown = np.zeros(len(scales), dtype=np.int64)
        return splat_images([self.reading.cloud], rotations, scales, objects=shown, size=self.look.image_size)

    def surface(self) -> TriangleMesh:
        """Return the mesh that was read, or surfels of a point cloud."""
        return self.reading.described_surface()


def sights_of(query: TriangleMesh | PointCloud, look: Look) -> list[Sight]:
    """Return the ways to see a query: as it is, and where it may stand on the ground also without that.

    Raises:
        MeshError: the query has no area or no extent, and its points are drawn.
    """
    if look.style != "splats":
        return [DrawnMesh(query, look)]
    return [DrawnPoints(reading, look) for reading in readings(query)]
