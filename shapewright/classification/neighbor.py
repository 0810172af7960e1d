"""The nearest stored variation of a class, and how far objects of the class usually are from theirs (ours).

A query that is called unknown can be shown beside it, with the reason.
"""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Neighbor:
    """The exemplar that is nearest to a query, among those of the most probable class.

    Args:
        class_name: the class.
        digest: the model of the exemplar.
        row: which exemplar, see :meth:`shapewright.classification.Exemplars.values`.
        distance: panorama distance of the query.
        usual_distance: nine of ten trial variations of the class were nearer to it; ``None`` if the training did not
            measure it.
    """

    class_name: str
    digest: str
    row: int
    distance: float
    usual_distance: float | None

    def to_dict(self) -> dict[str, Any]:
        """Return plain values, ready for JSON."""
        return {
            "class_name": self.class_name,
            "model_id": self.digest,
            "exemplar": self.row,
            "distance": self.distance,
            "usual_distance": self.usual_distance,
        }
