"""A query prepared once, and its distances to posed instances of a model."""

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import PointDistance, Pose
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
        self.descriptor = panorama_descriptor(mesh.vertices, mesh.faces)
        self._surface = SurfaceDistance(poisson_disk_points(mesh, settings.surface_points, rng=rng))
        self._zbuffer = ZBufferTarget(mesh.vertices, mesh.faces, settings.image_size)

    def instance(self, values: Float[np.ndarray, " P"]) -> TriangleMesh:
        """An instance, in model space. Parts that it lacks are left out: means of vertices must not know them."""
        return self.generator.instance(values, self.settings.subdivision_steps)

    def panorama(self, instance: TriangleMesh) -> float:
        """Panorama distance of an instance; any pose gives the same."""
        return panorama_distance(self.descriptor, panorama_descriptor(instance.vertices, instance.faces))

    def surface(self, instance: TriangleMesh) -> PointDistance:
        """The surface distance of an instance as a function of its posed vertices."""
        return self._surface

    def zbuffer(self, instance: TriangleMesh) -> PointDistance:
        """The normalised z-buffer distance of an instance as a function of its posed vertices."""
        return lambda posed: self._zbuffer.distance(posed, instance.faces).normalized

    def distances(self, instance: TriangleMesh, pose: Pose) -> Distances:
        """All distances of an instance at a pose."""
        posed = pose.apply(instance.vertices)
        zbuffer = self._zbuffer.distance(posed, instance.faces)
        return Distances(self.panorama(instance), self._surface(posed), zbuffer.normalized, zbuffer.raw)

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
