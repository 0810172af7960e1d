"""Verdict: what an evaluation keeps of a classification, beside the true class."""

from dataclasses import dataclass

from shapewright.classification import Classification
from shapewright.classification.evidence import OTHER


@dataclass(frozen=True)
class Verdict:
    """What a classifier answered about one mesh in one condition.

    Attributes:
        label: the true class; :data:`OTHER` if the classifier does not know it.
        class_name: the most probable class by all evidence.
        picture_class: the most probable class by the pictures alone.
        probability: of ``class_name``.
        known: probability that the mesh is of any of the classes; ``None`` if the classifier gives none.
        is_known: whether the mesh was accepted as one of the classes.
    """

    label: str
    class_name: str
    picture_class: str
    probability: float
    known: float | None
    is_known: bool

    @classmethod
    def of(cls, label: str, answer: Classification) -> "Verdict":
        """Keep what figures and reports need of an answer."""
        return cls(
            label=label,
            class_name=answer.class_name,
            picture_class=max(answer.picture_probabilities, key=answer.picture_probabilities.__getitem__),
            probability=answer.probabilities[answer.class_name],
            known=answer.known,
            is_known=answer.is_known,
        )

    @property
    def is_other(self) -> bool:
        """Whether the mesh is of none of the classes that the classifier knows."""
        return self.label == OTHER

    @property
    def is_right(self) -> bool:
        """Whether the most probable class is the true one, accepted or not."""
        return self.class_name == self.label
