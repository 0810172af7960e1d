"""Analysis by synthesis: a class is matched by its nearest stored variation and a short fit from there (ours).

The fit draws candidates around the nearest exemplars, evaluates them in one batch, and goes on from the best: a few
rounds of the cross-entropy method (Rubinstein 1999) with steps that shrink. The panorama distance knows no pose, so
nothing has to be aligned.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int

from shapewright.classification.exemplars import Exemplars
from shapewright.classification.sources import InstanceGenerator
from shapewright.distances.panorama import PanoramaDescriptor, panorama_descriptors, panorama_distances

FITTED_CLASSES: Final = 2
"""Most probable classes that are fitted."""
CANDIDATES: Final = 48
"""Instances of each round."""
KEPT: Final = 3
"""What each round begins from."""
STEPS: Final = (0.15, 0.08)
"""Standard deviation of each round, in shares of a parameter's range."""
_MOVED: Final = 0.4
"""Share of the parameters that a candidate changes."""


@runtime_checkable
class BatchGenerator(InstanceGenerator, Protocol):
    """A compiled model that makes batches; :class:`shapewright.modeling.CompiledModel` is one."""

    minimum: Float[np.ndarray, " P"]
    maximum: Float[np.ndarray, " P"]

    def settle(self, values: Float[np.ndarray, "B P"]) -> Float[np.ndarray, "B P"]:
        """The rows as they are meant: in their ranges, options whole."""
        ...

    def surface_points(self, values: Float[np.ndarray, "B P"], steps: int = 2) -> Float[np.ndarray, "B V 3"]:
        """Vertices of each row's surface."""
        ...

    def surface_triangles(self, steps: int = 2) -> Int[np.ndarray, "F 3"]:
        """The triangles that all rows share."""
        ...


@dataclass(frozen=True, eq=False)
class Fit:
    """The instance of a class that was found nearest.

    Args:
        digest: its model.
        values: its parameter values.
        distance: its panorama distance.
        exemplar_distance: that of the nearest exemplar, where the fit began.
    """

    digest: str
    values: Float[np.ndarray, " P"]
    distance: float
    exemplar_distance: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON; ``values`` in the order of the model's parameters."""
        return {
            "model_id": self.digest,
            "values": self.values.tolist(),
            "distance": self.distance,
            "exemplar_distance": self.exemplar_distance,
        }


def fit_class(
    descriptor: PanoramaDescriptor,
    exemplars: Exemplars,
    distances: Float[np.ndarray, " M"],
    class_number: int,
    models: Mapping[str, BatchGenerator],
    rng: np.random.Generator,
) -> Fit | None:
    """Match one class; ``None`` if the models of its nearest exemplars are not at hand.

    Args:
        descriptor: of the mesh.
        exemplars: stored variations.
        distances: of the mesh to each of them.
        class_number: of the class.
        models: compiled models by digest.
        rng: draws the candidates.
    """
    rows = np.flatnonzero(exemplars.classes == class_number)
    rows = rows[np.argsort(distances[rows], kind="stable")[:KEPT]]
    best: list[tuple[float, BatchGenerator, Float[np.ndarray, " P"]]] = []
    for row in rows:
        generator = models.get(exemplars.digests[exemplars.models[row]])
        if generator is not None:
            best.append((float(distances[row]), generator, exemplars.values(int(row), generator)))
    if not best:
        return None
    begun_at = best[0][0]
    for step in STEPS:
        found = list(best)
        for _, generator, values in best:
            count = CANDIDATES // len(best)
            candidates = _around(generator, values, step, count, rng)
            points = generator.surface_points(candidates, exemplars.subdivision_steps)
            triangles = generator.surface_triangles(exemplars.subdivision_steps)
            near = panorama_distances(descriptor, panorama_descriptors(points, triangles))
            found += [(float(near[i]), generator, candidates[i]) for i in range(count)]
        best = sorted(found, key=lambda one: one[0])[:KEPT]
    distance, generator, values = best[0]
    return Fit(generator.model.digest, values, distance, begun_at)


def _around(
    generator: BatchGenerator, values: Float[np.ndarray, " P"], step: float, count: int, rng: np.random.Generator
) -> Float[np.ndarray, "B P"]:
    moved = rng.random((count, len(values))) < _MOVED
    spread = step * (generator.maximum - generator.minimum)
    return generator.settle(values + moved * rng.normal(size=(count, len(values))) * spread)
