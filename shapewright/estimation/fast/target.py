"""The query prepared for fitting: even samples with normals, a search tree, axes, depth images."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from shapewright.distances.depth_kernels import compare_and_trace, compare_passes
from shapewright.distances.rasterize import PASS_FRAMES, prepared
from shapewright.distances.zbuffer import ZBufferTarget
from shapewright.errors import MeshError
from shapewright.estimation.fast.outline import MOST_PIXELS, TargetOutline, Trace
from shapewright.estimation.noise import without_noise
from shapewright.estimation.prepared_query import PreparedQuery
from shapewright.estimation.sampling_kernels import place_samples, sample_surface
from shapewright.estimation.settings import EstimationSettings
from shapewright.mesh import TriangleMesh

SAMPLES = 12_000
_AXES_FROM = 4_000
_GLANCED, _HOPEFUL = 3, 1.02
"""An instance whose distance in the first few views is larger by this factor is not compared in the others."""


class Target:
    """What a search compares instances with.

    Attributes:
        points, normals, faces: (N, 3), (N, 3), (N,) samples of the surface in random order, so that the first few of
            them are spread evenly, too.
        vertices, triangles: the normalized query.
        tree: of the points.
        center: mean of the samples.
        radius: their root mean square distance from it.
        outline: of the query in the depth views.
        frames: rotation matrices whose rows are axes of the query: of its points, of its normals, of its file.

    Raises:
        MeshError: the surface has no area.
    """

    def __init__(self, normalized: TriangleMesh, zbuffer: ZBufferTarget, rng: np.random.Generator) -> None:
        self.vertices, self.triangles = prepared(normalized.vertices, normalized.faces)
        self._zbuffer = zbuffer
        chosen, weights, normals = sample_surface(self.vertices, self.triangles, SAMPLES, 0.5)
        if len(chosen) == 0:
            raise MeshError("the surface has no area", where="faces")
        points = np.empty((SAMPLES, 3))
        place_samples(self.vertices, self.triangles, chosen, weights, points)
        order = rng.permutation(SAMPLES)
        self.points: Float[np.ndarray, "N 3"] = points[order]
        self.normals: Float[np.ndarray, "N 3"] = normals[order]
        self.faces: Int[np.ndarray, " N"] = chosen[order]
        self.tree = cKDTree(self.points, balanced_tree=False)
        some = self.points[:_AXES_FROM]
        self.center: Float[np.ndarray, " 3"] = some.mean(axis=0)
        self.radius = float(np.sqrt(((some - self.center) ** 2).sum(axis=1).mean()))
        self.frames = (
            principal_axes(some - self.center),
            principal_axes(self.normals[:_AXES_FROM]),
            np.eye(3),
        )
        self.outline = TargetOutline(np.isfinite(zbuffer.views[::2]), rng)
        near = np.asarray(self.tree.query(self.points[:500], k=2)[0])
        self._spacing = 1.3 * float(np.median(near[:, 1]))

    @classmethod
    def of(
        cls, prepared: PreparedQuery, settings: EstimationSettings, checkpoint: Callable[[], None] = lambda: None
    ) -> "Target":
        """Prepare what a search compares with: the query, or where it is noisy the smooth surface beneath.

        Args:
            prepared: the query.
            settings: of the estimation.
            checkpoint: called between steps; may raise to stop.

        Raises:
            MeshError: the surface has no area.
        """
        smooth, zbuffer = without_noise(prepared.mesh, checkpoint), prepared.zbuffer
        if smooth is not prepared.mesh:
            zbuffer = ZBufferTarget(smooth.vertices, smooth.faces, settings.image_size)
        return cls(smooth, zbuffer, np.random.default_rng(settings.seed))

    def spacing(self, count: int) -> float:
        """Return how far apart ``count`` samples lie, roughly."""
        return self._spacing * float(np.sqrt(SAMPLES / count))

    def zbuffer_distance(self, points: Float[np.ndarray, "V 3"], triangles: Int[np.ndarray, "F 3"]) -> float:
        """Return the normalized z-buffer distance of an instance, computed in the calling thread."""
        sums = self.compared(points, triangles)
        assert sums is not None
        return normalized(sums)

    def compared(
        self,
        points: Float[np.ndarray, "V 3"],
        triangles: Int[np.ndarray, "F 3"],
        better_than: Float[np.ndarray, "7 2"] | None = None,
    ) -> Float[np.ndarray, "7 2"] | None:
        """Compare the depth images of an instance with the query's.

        Args:
            points, triangles: the instance, placed.
            better_than: the sums of another instance; views that show that this one is farther end the comparison.

        Returns:
            For each pair of opposite views the raw sum, and the pixels that either covers; ``None`` if it was ended.
        """
        sums, first = np.empty((len(PASS_FRAMES), 2)), 0
        views, covered = self._zbuffer.views, self._zbuffer.covered
        if better_than is not None:
            first = _GLANCED
            compare_passes(points, triangles, PASS_FRAMES, views, covered, 0, first, sums)
            if normalized(sums[:first]) > _HOPEFUL * normalized(better_than[:first]):
                return None
        compare_passes(points, triangles, PASS_FRAMES, views, covered, first, len(sums), sums)
        return sums

    def traced(self, points: Float[np.ndarray, "V 3"], triangles: Int[np.ndarray, "F 3"]) -> tuple[float, Trace]:
        """Return the normalized z-buffer distance of an instance, and its outline."""
        sums = np.empty((len(PASS_FRAMES), 2))
        size = self._zbuffer.views.shape[1]
        faces, weights = np.empty(MOST_PIXELS, dtype=np.int64), np.empty((MOST_PIXELS, 3))
        numbers, pixels = np.empty(MOST_PIXELS, dtype=np.int64), np.empty((MOST_PIXELS, 2), dtype=np.int64)
        normals = np.empty((MOST_PIXELS, 2))
        found = compare_and_trace(
            points, triangles, PASS_FRAMES, self._zbuffer.views, self._zbuffer.covered, sums, faces, weights, numbers,
            pixels, normals,
        )  # fmt: skip
        trace = Trace(size, faces[:found], weights[:found], numbers[:found], pixels[:found], normals[:found])
        return normalized(sums), trace


def normalized(sums: Float[np.ndarray, "K 2"]) -> float:
    """Return the z-buffer distance of the views whose raw sums and covered pixels are given."""
    raw, covered = sums.sum(axis=0)
    return float(raw / covered) if covered else 0.0


def principal_axes(vectors: Float[np.ndarray, "N 3"]) -> Float[np.ndarray, "3 3"]:
    """Return the right-handed principal axes of vectors as rows, the longest first."""
    axes = np.linalg.eigh(vectors.T @ vectors)[1].T[::-1].copy()
    axes[2] = np.cross(axes[0], axes[1])
    return axes
