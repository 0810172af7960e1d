"""The answer of a classifier."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.classification.evidence import KNOWN_THRESHOLD, UNKNOWN
from shapewright.classification.neighbor import Neighbor
from shapewright.classification.synthesis import Fit
from shapewright.distances.panorama import PanoramaDescriptor


@dataclass(frozen=True, eq=False)
class Classification:
    """The answer to: what is this mesh?

    Args:
        class_name: the most probable class, also where the mesh may be of none.
        known: probability that the mesh is of one of the classes at all; ``None`` if the classifier has not learned
            what is unknown. With fits it is a little higher: what it is set by was not fitted.
        probabilities: of the classes by all evidence, given that it is one of them; highest first.
        picture_probabilities: by the pictures alone, means over the views; highest first.
        scores: of the classes, see :mod:`shapewright.classification.evidence`; comparable between meshes.
        picture_scores: the same by the pictures alone.
        distances: panorama distance of the nearest exemplar or fit of each class; ``None`` without exemplars.
        fits: of the classes that were fitted, instead of the nearest exemplar; ``None`` if nobody asked for that.
        neighbor: the nearest exemplar of the most probable class; ``None`` without exemplars.
        descriptor: panorama descriptor of the mesh; ``None`` without exemplars.
        per_view: probabilities of each picture; columns in the order of the classifier's ``class_names``.
        images: the pictures that were looked at.
    """

    class_name: str
    known: float | None
    probabilities: dict[str, float]
    picture_probabilities: dict[str, float]
    scores: dict[str, float]
    picture_scores: dict[str, float]
    distances: dict[str, float] | None
    fits: dict[str, Fit] | None
    neighbor: Neighbor | None
    descriptor: PanoramaDescriptor | None
    per_view: Float[np.ndarray, "N C"]
    images: UInt8[np.ndarray, "N H W 3"]

    @property
    def is_known(self) -> bool:
        """Whether the mesh is taken for one of the classes at all."""
        return self.answer != UNKNOWN

    @property
    def answer(self) -> str:
        """The class, or :data:`UNKNOWN`, at the default threshold."""
        return self.answer_at(KNOWN_THRESHOLD)

    def answer_at(self, threshold: float) -> str:
        """Return the class, or :data:`UNKNOWN` if ``known`` is below the threshold.

        :attr:`shapewright.classification.Classifier.trade_off` lists what thresholds accept and refuse.
        """
        return self.class_name if self.known is None or self.known >= threshold else UNKNOWN

    def to_dict(self) -> dict[str, Any]:
        """The answer as JSON values, without scores, descriptor and pictures."""
        return {
            "class_name": self.class_name,
            "answer": self.answer,
            "known": self.known,
            "probabilities": _listed(self.probabilities, "probability"),
            "picture_probabilities": _listed(self.picture_probabilities, "probability"),
            "distances": None if self.distances is None else _listed(self.distances, "distance"),
            "fits": None if self.fits is None else [{"class_name": n} | fit.to_dict() for n, fit in self.fits.items()],
            "neighbor": None if self.neighbor is None else self.neighbor.to_dict(),
            "per_view": np.asarray(self.per_view, dtype=np.float64).tolist(),
        }


def _listed(values: Mapping[str, float], what: str) -> list[dict[str, Any]]:
    return [{"class_name": name, what: float(value)} for name, value in values.items()]
