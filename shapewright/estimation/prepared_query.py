"""A query prepared once for every model that it is compared with."""

from collections.abc import Callable

import numpy as np

from shapewright.distances.alignment import Pose
from shapewright.distances.panorama import panorama_descriptor
from shapewright.distances.surface import SurfaceDistance, poisson_disk_points
from shapewright.distances.zbuffer import ZBufferTarget
from shapewright.estimation.dust import without_dust
from shapewright.estimation.query import Query
from shapewright.estimation.settings import EstimationSettings


def _go_on() -> None:
    pass


class PreparedQuery:
    """The normalized query and whatever of it does not depend on a model.

    Args:
        query: what is asked.
        settings: of the estimation.
        checkpoint: called between steps, of which the longest takes about a second for two million triangles; may
            raise to stop.

    Attributes:
        query: what was asked.
        mesh: the query with its vertex mean at the origin and coordinates within [-1, 1] (section 3.3), without dust.
        to_file: takes that space to the query's own file coordinates.
        descriptor: its panorama descriptor.
        surface: the surface distance to points in that space.
        zbuffer: the z-buffer distance to meshes in that space.

    Raises:
        MeshError: the query is a single point or has no area.
    """

    def __init__(self, query: Query, settings: EstimationSettings, checkpoint: Callable[[], None] = _go_on) -> None:
        normalization = without_dust(query.mesh).normalized()
        self.query = query
        self.mesh = normalization.mesh
        self.to_file = Pose(translation=normalization.translation, scale=normalization.scale).inverse()
        checkpoint()
        self.descriptor = panorama_descriptor(self.mesh.vertices, self.mesh.faces)
        checkpoint()
        _, rng = np.random.default_rng(settings.seed).spawn(2)  # the first of them draws banks
        self.surface = SurfaceDistance(poisson_disk_points(self.mesh, settings.surface_points, rng=rng))
        checkpoint()
        self.zbuffer = ZBufferTarget(self.mesh.vertices, self.mesh.faces, settings.image_size)
