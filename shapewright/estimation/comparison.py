"""A query prepared once, and its distances to posed instances of a model."""

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.distances.panorama import panorama_descriptor, panorama_distance
from shapewright.distances.surface import SurfaceDistance, poisson_disk_points
from shapewright.distances.zbuffer import ZBufferTarget
from shapewright.errors import MeshError
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.result import Distances
from shapewright.estimation.settings import EstimationSettings
from shapewright.mesh import TriangleMesh


class Comparison:
    """The normalised query and whatever of it does not change: descriptor, sampled points, depth images.

    Poses here map model space to the normalised space of the query (vertex mean at the origin, coordinates
    within [-1, 1], section 3.3); :attr:`to_file` takes that space to the query's own file coordinates.

    Raises:
        MeshError: the query is a single point or has no area.
    """

    def __init__(
        self,
        query: TriangleMesh,
        generator: InstanceGenerator,
        settings: EstimationSettings,
        rng: np.random.Generator,
    ) -> None:
        normalization = query.normalized()
        mesh = normalization.mesh
        self.generator = generator
        self.settings = settings
        self.to_file = Pose(translation=normalization.translation, scale=normalization.scale).inverse()
        self.triangles = generator.surface_triangles(settings.subdivision_steps)
        self.descriptor = panorama_descriptor(mesh.vertices, mesh.faces)
        self._surface = SurfaceDistance(poisson_disk_points(mesh, settings.surface_points, rng=rng))
        self._zbuffer = ZBufferTarget(mesh.vertices, mesh.faces, settings.image_size)

    def points(self, values: Float[np.ndarray, " P"]) -> Float[np.ndarray, "V 3"]:
        """Vertices of an instance, in model space."""
        return np.asarray(self.generator.surface_points(values[None], self.settings.subdivision_steps)[0])

    def panorama(self, points: Float[np.ndarray, "V 3"]) -> float:
        """Panorama distance of an instance; any pose gives the same."""
        return panorama_distance(self.descriptor, panorama_descriptor(points, self.triangles))

    def surface(self, posed: Float[np.ndarray, "V 3"]) -> float:
        """Surface distance of a posed instance."""
        return float(self._surface(posed))

    def zbuffer(self, posed: Float[np.ndarray, "V 3"]) -> float:
        """Normalised z-buffer distance of a posed instance."""
        return self._zbuffer.distance(posed, self.triangles).normalized

    def distances(self, points: Float[np.ndarray, "V 3"], pose: Pose) -> Distances:
        """All distances of an instance at a pose."""
        posed = pose.apply(points)
        zbuffer = self._zbuffer.distance(posed, self.triangles)
        return Distances(self.panorama(points), self.surface(posed), zbuffer.normalized, zbuffer.raw)

    def initial_pose(self, points: Float[np.ndarray, "V 3"]) -> Pose:
        """The paper's initial normalisation of an instance.

        Raises:
            MeshError: the instance is a single point.
        """
        mean = points.mean(axis=0)
        extent = float(np.abs(points - mean).max())
        if not (np.isfinite(extent) and extent > 0):
            raise MeshError("all vertices of an instance are one point")
        return Pose(translation=-mean / extent, scale=1.0 / extent)
