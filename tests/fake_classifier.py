"""A classifier without a network: it tells long things from flat ones by their extents."""

import numpy as np

from shapewright.classification import Classification
from shapewright.mesh import TriangleMesh


class ExtentClassifier:
    """``slab`` is what has two long sides, ``rod`` what has one."""

    class_names = ("rod", "slab")

    def __init__(self) -> None:
        self.asked = 0

    def classify(
        self, mesh: TriangleMesh, *, views: int = 10, rng: np.random.Generator | None = None
    ) -> Classification:
        self.asked += 1
        short, middle, long = np.sort(np.ptp(mesh.vertices, axis=0))
        slab = float((middle - short) / (long - short)) if long > short else 0.5
        probabilities = {"slab": slab, "rod": 1.0 - slab}
        return Classification(
            class_name=max(probabilities, key=lambda name: probabilities[name]),
            known=None,
            probabilities=probabilities,
            picture_probabilities=probabilities,
            scores=probabilities,
            distances=None,
            descriptor=None,
            per_view=np.tile(np.array([1.0 - slab, slab], dtype=np.float32), (views, 1)),
            images=np.zeros((views, 8, 8, 3), dtype=np.uint8),
        )
