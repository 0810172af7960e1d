"""Classifiers without a network: they tell long things from flat ones by their extents."""

from dataclasses import replace

import numpy as np
import trimesh

from shapewright.classification import Classification
from shapewright.classification.evidence import FLOOR
from shapewright.distances.panorama import PanoramaDescriptor, panorama_descriptor
from shapewright.errors import MeshError
from shapewright.mesh import PointCloud, TriangleMesh


class ExtentClassifier:
    """``slab`` is what has two long sides, ``rod`` what has one."""

    class_names = ("rod", "slab")

    def __init__(self) -> None:
        self.asked = 0

    def classify(
        self, query: TriangleMesh | PointCloud, *, views: int = 10, rng: np.random.Generator | None = None
    ) -> Classification:
        self.asked += 1
        short, middle, long = np.sort(np.ptp(query.bounds, axis=0))
        slab = float((middle - short) / (long - short)) if long > short else 0.5
        probabilities = _highest_first({"slab": slab, "rod": 1.0 - slab})
        scores = {name: float(np.log(share + FLOOR)) for name, share in probabilities.items()}
        return Classification(
            class_name=next(iter(probabilities)),
            known=0.75,
            probabilities=probabilities,
            picture_probabilities=probabilities,
            scores=scores,
            picture_scores=scores,
            distances=None,
            fits=None,
            neighbor=None,
            descriptor=_hull_descriptor(query) if isinstance(query, PointCloud) else None,
            per_view=np.tile(np.array([1.0 - slab, slab], dtype=np.float32), (views, 1)),
            images=np.zeros((views, 8, 8, 3), dtype=np.uint8),
        )


class CubeRefuser(ExtentClassifier):
    """The same, but the less the sides differ, the less it is known."""

    def classify(
        self, query: TriangleMesh | PointCloud, *, views: int = 10, rng: np.random.Generator | None = None
    ) -> Classification:
        sides = np.ptp(query.bounds, axis=0)
        answer = super().classify(query, views=views, rng=rng)
        return replace(answer, known=float(1.0 - 0.9 * sides.min() / sides.max()))


class MeshesOnly(CubeRefuser):
    """The same, but it refuses point clouds."""

    def classify(
        self, query: TriangleMesh | PointCloud, *, views: int = 10, rng: np.random.Generator | None = None
    ) -> Classification:
        if isinstance(query, PointCloud):
            raise MeshError("there are no faces")
        return super().classify(query, views=views, rng=rng)


def _hull_descriptor(cloud: PointCloud) -> PanoramaDescriptor:
    """Describe the hull of the points, as if the object were convex."""
    hull = trimesh.convex.convex_hull(cloud.points)
    return panorama_descriptor(np.asarray(hull.vertices), np.asarray(hull.faces))


def _highest_first(shares: dict[str, float]) -> dict[str, float]:
    return dict(sorted(shares.items(), key=lambda entry: -entry[1]))
