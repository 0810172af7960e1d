"""Analysis by synthesis: a class is matched by its nearest stored variation and a short fit from there (ours)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Float

from shapewright.classification.exemplars import Exemplars
from shapewright.distances.panorama import PanoramaDescriptor
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.starts import KEPT, Start, improve_starts

FITTED_CLASSES: Final = 2
"""Most probable classes that are fitted."""


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
    models: Mapping[str, InstanceGenerator],
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
    starts = []
    for row in rows:
        generator = models.get(exemplars.digests[exemplars.models[row]])
        if generator is not None:
            starts.append(Start(generator, exemplars.values(int(row), generator), float(distances[row])))
    if not starts:
        return None
    best = improve_starts(descriptor, starts, exemplars.subdivision_steps, rng)
    return Fit(best.generator.model.digest, best.values, best.distance, starts[0].distance)
