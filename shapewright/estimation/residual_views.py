"""The residuals of a fit as colors: a scene for a viewer, and a picture.

Large triangles are divided first: a table top has four vertices, and colors are kept at vertices.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int, UInt8

from shapewright.distances.triangles import TriangleDistance
from shapewright.estimation.residuals import TOLERANCE
from shapewright.mesh import TriangleMesh
from shapewright.mesh.glb import ColoredMesh, write_colored_glb

LONGEST_EDGE = 0.06
"""Longest edge in a colored mesh, in units in which the query reaches from -1 to 1."""
MOST_FACES = 100_000
"""Triangles are not divided any further where there would be more."""


@dataclass(frozen=True, eq=False)
class ResidualViews:
    """Query and fit in the coordinates of the query's file, divided finely, and their distances.

    Make it with :meth:`of`.

    Attributes:
        query: the query; its first vertices are those of the file.
        fit: the fitted instance.
        query_distances: of each vertex of the query to the fit, in units in which the query reaches from -1 to 1.
        fit_distances: of each vertex of the fit to the query, in the same units.
        tolerance: in the same units.
    """

    query: TriangleMesh
    fit: TriangleMesh
    query_distances: Float[np.ndarray, " Vq"]
    fit_distances: Float[np.ndarray, " Vm"]
    tolerance: float

    @classmethod
    def of(cls, query: TriangleMesh, fit: TriangleMesh, *, tolerance: float = TOLERANCE) -> "ResidualViews":
        """Measure a query and its fit, both in the coordinates of the query.

        Raises:
            MeshError: the query has no extent.
        """
        normal = query.normalized()
        longest = LONGEST_EDGE / normal.scale
        fine_query, fine_fit = divided(query, longest), divided(fit, longest)
        return cls(
            query=fine_query,
            fit=fine_fit,
            query_distances=normal.scale * TriangleDistance(fit)(fine_query.vertices),
            fit_distances=normal.scale * TriangleDistance(query)(fine_fit.vertices),
            tolerance=tolerance,
        )

    def glb(self) -> bytes:
        """Return a GLB file with the nodes ``fit`` and ``query``, each colored by its distance to the other."""
        from shapewright.rendering.colormap import residual_colors

        return write_colored_glb(
            [
                ColoredMesh(name, mesh.vertices, mesh.faces, residual_colors(distances, self.tolerance))
                for name, mesh, distances in (
                    ("fit", self.fit, self.fit_distances),
                    ("query", self.query, self.query_distances),
                )
            ]
        )

    def picture(
        self, *, rotation: Float[np.ndarray, "3 3"] | None = None, size: int = 512
    ) -> UInt8[np.ndarray, "H W 3"]:
        """Return the picture of :func:`shapewright.rendering.compose_residuals`.

        Raises:
            RenderingError: no headless OpenGL, a picture too large.
        """
        from shapewright.rendering import compose_residuals

        return compose_residuals(
            self.query,
            self.fit,
            self.query_distances,
            self.fit_distances,
            self.tolerance,
            rotation=rotation,
            size=size,
        )


def divided(mesh: TriangleMesh, longest_edge: float, most_faces: int = MOST_FACES) -> TriangleMesh:
    """Return the same surface with its triangles halved until no edge is longer, or there would be too many.

    The vertices of the mesh come first. Neighbors are not divided alike: a vertex may lie on the edge of another face.
    """
    vertices, faces = [mesh.vertices], mesh.faces
    count = len(mesh.vertices)
    while True:
        corners = np.concatenate(vertices)[faces]
        lengths = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)  # of the edge from each corner
        long = np.flatnonzero(lengths.max(axis=1) > longest_edge)
        if len(long) == 0 or len(faces) + len(long) > most_faces:
            return TriangleMesh(np.concatenate(vertices), faces)
        turned = _from_longest(faces[long], lengths[long])
        points = np.concatenate(vertices)
        vertices = [points, (points[turned[:, 0]] + points[turned[:, 1]]) / 2]
        middles = np.arange(count, count + len(long))
        count += len(long)
        first, second = turned.copy(), turned.copy()
        first[:, 1] = second[:, 0] = middles
        faces = np.concatenate([np.delete(faces, long, axis=0), first, second])


def _from_longest(faces: Int[np.ndarray, "F 3"], lengths: Float[np.ndarray, "F 3"]) -> Int[np.ndarray, "F 3"]:
    """Return the faces with their corners turned so that the first edge is the longest."""
    columns = (lengths.argmax(axis=1)[:, None] + np.arange(3)) % 3
    return np.take_along_axis(faces, columns, axis=1)
