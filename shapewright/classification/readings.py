"""Readings of a query: points to draw and a surface to compare, of meshes and point clouds, clean or not (ours).

Noise is smoothed, debris beside the object goes. Where an object may stand on the ground, there is a second reading
without it; which of the two is right, the classes decide.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import cKDTree

from shapewright.distances.even_places import even_places
from shapewright.errors import MeshError
from shapewright.estimation.noise import without_noise
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.places import first_at_place
from shapewright.mesh.surfels import surfels
from shapewright.mesh.surroundings import is_debris, is_ground
from shapewright.rendering.splats import RADIUS, SplatCloud, splat_cloud

VERSION: Final = 1
"""Raise it when the same query is read differently."""
SPACING: Final = 0.6
"""Distance of neighboring points on a mesh, in radii of a disc."""
LEAST_POINTS, MOST_POINTS = 2_000, 30_000
"""How many points a query is drawn by, at least and at most; a point cloud may have fewer."""
_NEIGHBORS: Final = 6
"""Neighbors that the spacing of a point cloud is measured by."""
_ASKED: Final = 1_000
"""Points at which it is measured."""


@dataclass(frozen=True, eq=False)
class Reading:
    """One way to see a query.

    Args:
        points: on the surface, in the query's unit.
        spacing: side of the square that each point has to itself on the surface.
        surface: the mesh that the points lie on; ``None`` for a point cloud.
        was_noisy: whether this is the smooth surface beneath a noisy one.
    """

    points: Float[np.ndarray, "N 3"]
    spacing: float
    surface: TriangleMesh | None
    was_noisy: bool = False

    @property
    def cloud(self) -> SplatCloud:
        """What is drawn.

        Raises:
            MeshError: all points are at one place.
        """
        return splat_cloud(self.points, self.spacing if self.surface is None else 0.0)

    def described_surface(self, *, by_surfels: bool = False) -> TriangleMesh:
        """Return the surface to compare: the mesh, or surfels, which noise and small holes hardly change.

        Args:
            by_surfels: return surfels even if there is a mesh; a point cloud always has surfels.
        """
        return surfels(self.points, self.spacing) if by_surfels or self.surface is None else self.surface


def plain_reading(query: TriangleMesh | PointCloud) -> Reading:
    """Read a query as it is; the same each time.

    Raises:
        MeshError: a mesh without area, or points that are all at one place.
    """
    if isinstance(query, PointCloud):
        points = query.points
        if len(points) > MOST_POINTS:  # at random: every tenth point of a scanner's rows would be a pattern
            points = np.random.default_rng(0).choice(points, MOST_POINTS, replace=False)
        points = points[first_at_place(points) == np.arange(len(points))]  # repeated ones have no distance
        if len(points) == 1:
            raise MeshError("all points are at one place", where="points")
        return Reading(points, _cloud_spacing(points), None)
    return _mesh_reading(query)[0]


def readings(query: TriangleMesh | PointCloud) -> list[Reading]:
    """Read a query that may be a scan: without noise and debris, and once more without ground if it may have some.

    Raises:
        MeshError: a mesh without area, or points that are all at one place.
    """
    if isinstance(query, PointCloud):
        whole = plain_reading(query)
        kept = ~is_debris(whole.points, whole.spacing)
        first = Reading(whole.points[kept], whole.spacing, None)
        ground = is_ground(first.points)
        return [first] if ground is None else [first, Reading(first.points[~ground], first.spacing, None)]
    smooth = without_noise(query)
    was_noisy = smooth is not query
    whole, places = _mesh_reading(smooth)
    debris = is_debris(whole.points, whole.spacing)
    cleared = _part(whole, places, ~debris) if debris.any() else None
    first, places = (whole, places) if cleared is None else _mesh_reading(cleared)
    ground = is_ground(first.points)
    lifted = None if ground is None else _part(first, places, ~ground)
    found = [first] if lifted is None else [first, _mesh_reading(lifted)[0]]
    return [replace(one, was_noisy=was_noisy) for one in found]


def _mesh_reading(mesh: TriangleMesh) -> tuple[Reading, Int[np.ndarray, " N"]]:
    """Read a mesh; also tell which face each point lies on."""
    areas = mesh.face_areas
    area = float(areas.sum())
    if not area > 0:
        raise MeshError("the surface has no area", where="faces")
    used = mesh.vertices[mesh.faces[areas > 0]].reshape(-1, 3)
    reach = 0.5 * float(np.linalg.norm(used.max(axis=0) - used.min(axis=0)))
    count = int(np.clip(area / (SPACING * RADIUS * reach) ** 2, LEAST_POINTS, MOST_POINTS))
    faces, weights = even_places(areas, count)
    points = np.einsum("nk,nkd->nd", weights, mesh.vertices[mesh.faces[faces]])
    return Reading(points, float(np.sqrt(area / count)), mesh), faces


def _part(whole: Reading, places: Int[np.ndarray, " N"], kept: Bool[np.ndarray, " N"]) -> TriangleMesh | None:
    """Return the faces that most of their points stay with, or ``None`` if they have no area.

    Faces without a point go with the nearest one.
    """
    assert whole.surface is not None
    votes = np.zeros(len(whole.surface.faces))
    np.add.at(votes, places, np.where(kept, 1.0, -1.0))
    silent = np.flatnonzero(np.bincount(places, minlength=len(votes)) == 0)
    if len(silent):
        middles = whole.surface.triangles[silent].mean(axis=1)
        votes[silent] = np.where(kept[cKDTree(whole.points).query(middles)[1]], 1.0, -1.0)
    stay = votes > 0
    if not whole.surface.face_areas[stay].sum() > 0:
        return None
    used, renumbered = np.unique(whole.surface.faces[stay], return_inverse=True)
    return TriangleMesh(whole.surface.vertices[used], renumbered.reshape(-1, 3))


def _cloud_spacing(points: Float[np.ndarray, "N 3"]) -> float:
    """Return the side of the square that a point of a surface has to itself, the median over the points."""
    count = min(_NEIGHBORS, len(points) - 1)
    asked = points[:: max(1, len(points) // _ASKED)]
    distances = np.asarray(cKDTree(points).query(asked, k=count + 1)[0])[:, -1]
    return float(np.sqrt(np.pi / count) * np.median(distances))
