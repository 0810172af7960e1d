"""The head of a classifier: its last layers, from features to class values."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class Layer:
    """Values = inputs · weightᵀ + bias.

    Args:
        weight: one row a value.
        bias: one number a value.
    """

    weight: Float[np.ndarray, "M D"]
    bias: Float[np.ndarray, " M"]

    def __call__(self, inputs: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N M"]:
        """Values of each input."""
        return np.asarray(inputs @ self.weight.T + self.bias)


@dataclass(frozen=True, eq=False)
class Head:
    """Trained last layers; negative values of all layers but the last count as zero.

    The last layer gives the class values, which are then divided by the temperature. It may have one row more than
    there are classes, for objects that are of none.

    Args:
        layers: from features to class values; the standardization of the features is folded into the first.
        class_count: number of classes, C.
        temperature: softens the class values so that probabilities mean what they say; at least 1.
        curves: figures of each epoch: train_loss, held_out_loss, held_out_accuracy.
        best_epoch: the epoch, from 0, whose weights these are.
    """

    layers: tuple[Layer, ...]
    class_count: int
    temperature: float
    curves: dict[str, list[float]]
    best_epoch: int

    def values(self, features: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N K"]:
        """Class values before the temperature."""
        return self.layers[-1](self.hidden(features))

    def hidden(self, features: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N H"]:
        """Values that the last layer reads: the features themselves if it is the only one."""
        values = features.astype(np.float32)
        for layer in self.layers[:-1]:
            values = np.maximum(layer(values), 0.0)
        return values

    def probabilities(self, features: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N C"]:
        """Calibrated probabilities of the classes, given that it is one of them; as the exported graph gives them."""
        return softmax(self.values(features)[:, : self.class_count] / self.temperature)

    def open_probabilities(self, features: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N C"]:
        """Probabilities of the classes where ``none`` has a share, too; rows add up to 1 or less."""
        return softmax(self.values(features) / self.temperature)[:, : self.class_count]


def softmax(values: Float[np.ndarray, "*N C"]) -> Float[np.ndarray, "*N C"]:
    """Probabilities along the last axis."""
    shifted = np.exp(values - values.max(axis=-1, keepdims=True))
    return np.asarray(shifted / shifted.sum(axis=-1, keepdims=True))
