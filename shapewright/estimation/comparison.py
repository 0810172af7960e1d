"""The distances of a prepared query to posed instances of a model."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import AlignmentSettings, PointDistance, Pose, rotations_24
from shapewright.distances.panorama import panorama_descriptor, panorama_distance
from shapewright.errors import MeshError
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.prepared_query import PreparedQuery
from shapewright.estimation.result import Distances
from shapewright.estimation.settings import EstimationSettings
from shapewright.estimation.surface_samples import spread_samples
from shapewright.mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class Instance:
    """An instance in model space, without the parts that it lacks: means of vertices must not know them.

    Attributes:
        mesh: its subdivided surface.
        samples: the points at which the surface distance measures it.
    """

    mesh: TriangleMesh
    samples: Float[np.ndarray, "N 3"]


@dataclass(frozen=True, eq=False)
class PosedDistance:
    """A distance of an instance as a function of its pose.

    Attributes:
        points: what a pose moves, in model space.
        at_points: the distance, given the moved points.
    """

    points: Float[np.ndarray, "N 3"]
    at_points: PointDistance

    def __call__(self, pose: Pose) -> float:
        """The distance at a pose."""
        return self.at_points(pose.apply(self.points))


class Comparison:
    """Measures instances of one model against one query.

    Poses here map model space to the normalized space of the query; :attr:`to_file` takes that space to the query's
    own file coordinates.

    Attributes:
        prepared: the query.
        generator: the model.
        settings: of the estimation.
        to_file: the normalized space to the query's own coordinates.
        known_scale: scale of poses here, if the units of query and model are known.
        alignment: settings of the realignment; with a known scale they leave it as it is.
    """

    def __init__(self, prepared: PreparedQuery, generator: InstanceGenerator, settings: EstimationSettings) -> None:
        self.prepared = prepared
        self.generator = generator
        self.settings = settings
        self.to_file = prepared.to_file
        in_file = prepared.query.scale_of(generator.model.unit_m)
        self.known_scale = None if in_file is None else in_file / self.to_file.scale
        self.alignment: AlignmentSettings = settings.alignment
        if self.known_scale is not None:
            self.alignment = replace(settings.alignment, scale_limits=(1.0, 1.0))
        on_surface = settings.model_points == "surface"
        self._samples = spread_samples(generator, settings.subdivision_steps) if on_surface else None

    def instance(self, values: Float[np.ndarray, " P"]) -> Instance:
        """Generate an instance."""
        mesh = self.generator.instance(values, self.settings.subdivision_steps)
        if self._samples is None:
            return Instance(mesh, mesh.vertices)
        present = self.generator.parts_present(values[None])[0]
        return Instance(mesh, self._samples.of_instance(present).points(mesh.vertices))

    def panorama(self, instance: Instance) -> float:
        """Panorama distance of an instance; any pose gives the same."""
        descriptor = panorama_descriptor(instance.mesh.vertices, instance.mesh.faces)
        return panorama_distance(self.prepared.descriptor, descriptor)

    def surface(self, instance: Instance) -> PosedDistance:
        """The surface distance of an instance."""
        return PosedDistance(instance.samples, self.prepared.surface)

    def zbuffer(self, instance: Instance) -> PosedDistance:
        """The normalized z-buffer distance of an instance."""
        target, faces = self.prepared.zbuffer, instance.mesh.faces
        return PosedDistance(instance.mesh.vertices, lambda posed: target.distance(posed, faces).normalized)

    def distances(self, instance: Instance, pose: Pose) -> Distances:
        """All distances of an instance at a pose."""
        zbuffer = self.prepared.zbuffer.distance(pose.apply(instance.mesh.vertices), instance.mesh.faces)
        surface = self.surface(instance)(pose)
        return Distances(self.panorama(instance), surface, zbuffer.normalized, zbuffer.raw)

    def initial_pose(self, instance: Instance) -> Pose:
        """The paper's initial normalization of an instance, or its known scale.

        Raises:
            MeshError: the instance is a single point.
        """
        vertices = instance.mesh.vertices
        mean = vertices.mean(axis=0)
        extent = float(np.abs(vertices - mean).max())
        if not (np.isfinite(extent) and extent > 0):
            raise MeshError("all vertices of an instance are one point")
        scale = 1.0 / extent if self.known_scale is None else self.known_scale
        return Pose(translation=-mean * scale, scale=scale)

    def starting_rotations(self) -> Float[np.ndarray, "R 3 3"]:
        """The rotations that an alignment begins at: the paper's 24, or those of them that agree with what is known."""
        query = self.prepared.query
        if query.rotation is not None:
            return query.rotation[None]
        return np.stack([rotation for rotation in rotations_24() if query.allows(rotation)])
