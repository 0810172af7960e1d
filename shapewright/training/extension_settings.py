"""How a classifier is extended by classes."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from shapewright.errors import ClassifierError
from shapewright.training.settings import TrainingSettings, checked_values


@dataclass(frozen=True)
class ExtensionSettings:
    """Settings of :func:`shapewright.training.extend_classifier`.

    How pictures are drawn, how variations are broken, and the seed are those of the base classifier: the classes that
    it knows and the new ones have to look alike.

    Args:
        variations: random variations of each new class.
        images_per_variation: pictures of each variation.
        rehearsed: variations of each class that the base knows, more if its models are many.
        negatives: random assemblies; of each model of no class there are a few variations, too. 0 takes neither.
        held_out: share of each class's variations kept for early stopping and for the figures.
        epochs: passes over the features at most.
        patience: passes without a better held-out loss after which learning stops.
        learning_rate: highest one of AdamW, for a last layer of 1280 standardized inputs; it is divided by their
            share of 1280, so that a step moves the class values as far whatever the layer reads.
        weight_decay: pull of the learned rows toward where they began.
        batch_size: pictures in one step of the learning at most.

    Raises:
        ClassifierError: a setting that makes no sense; ``where`` names it.
    """

    variations: int = 200
    images_per_variation: int = 4
    rehearsed: int = 24
    negatives: int = 60
    held_out: float = 0.2
    epochs: int = 40
    patience: int = 8
    learning_rate: float = 1e-3
    weight_decay: float = 1e-2
    batch_size: int = 256

    def __post_init__(self) -> None:
        if self.rehearsed < 2:
            raise ClassifierError(f"is {self.rehearsed!r}, must be at least 2", where="rehearsed")
        TrainingSettings(**self._shared())  # it checks its values

    def on(self, base: Mapping[str, Any]) -> TrainingSettings:
        """Return the settings by which an extension draws.

        Args:
            base: settings in the metadata of the base classifier.

        Raises:
            ClassifierError: the base was made with settings, or with a backbone, that this version does not know.
        """
        try:
            return TrainingSettings.from_dict({**base, **self._shared()})
        except ClassifierError as error:
            raise ClassifierError(error.message, where=f"settings of the base classifier: {error.where}") from None

    def to_dict(self) -> dict[str, Any]:
        """Return the settings as JSON values."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "ExtensionSettings":
        """Return settings from JSON values; what is missing keeps its default.

        Raises:
            ClassifierError: a name that is no setting, a value of a wrong type or that makes no sense.
        """
        for name in values:
            if name in TrainingSettings.__dataclass_fields__ and name not in cls.__dataclass_fields__:
                raise ClassifierError("cannot be chosen: an extended classifier keeps its base's", where=name)
        return cls(**checked_values(cls, values))

    def _shared(self) -> dict[str, Any]:
        return {name: value for name, value in asdict(self).items() if name in TrainingSettings.__dataclass_fields__}
