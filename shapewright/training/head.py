"""The last layer: learned with torch on stored features, stopped early (paper section 3.2)."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from jaxtyping import Float, Int
from torch.nn import functional

from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.training.dataset import FeatureSet
from shapewright.training.settings import TrainingSettings


@dataclass(frozen=True, eq=False)
class Head:
    """A trained last layer: class values = features · weightᵀ + bias, divided by the temperature.

    It may have one row more than there are classes, for objects that are of none.

    Args:
        weight: one row a class value; the standardisation of the features is folded in.
        bias: one number a class value.
        class_count: number of classes, C.
        temperature: softens the class values so that probabilities mean what they say; at least 1.
        curves: figures of each epoch: train_loss, held_out_loss, held_out_accuracy.
        best_epoch: the epoch, from 0, whose weights these are.
    """

    weight: Float[np.ndarray, "K D"]
    bias: Float[np.ndarray, " K"]
    class_count: int
    temperature: float
    curves: dict[str, list[float]]
    best_epoch: int

    def values(self, features: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N K"]:
        """Class values before the temperature."""
        return np.asarray(features.astype(np.float32) @ self.weight.T + self.bias)

    def probabilities(self, features: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N C"]:
        """Calibrated probabilities of the classes, given that it is one of them; as the exported graph gives them."""
        return softmax(self.values(features)[:, : self.class_count] / self.temperature)

    def open_probabilities(self, features: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N C"]:
        """Probabilities of the classes where ``none`` has a share, too; rows add up to 1 or less."""
        return softmax(self.values(features) / self.temperature)[:, : self.class_count]


def train_head(
    data: FeatureSet,
    settings: TrainingSettings,
    progress: Progress = NULL_PROGRESS,
    *,
    learned: Int[np.ndarray, " L"] | None = None,
    apart: Int[np.ndarray, " A"] | None = None,
) -> Head:
    """Learn the last layer by cross entropy with Adam on standardised features, from zero weights.

    Weights of the epoch with the lowest loss on the pictures that are kept apart are kept. Deterministic: only the
    order of the pictures is random, and it comes from the seed. Torch's global generator is left alone.

    Args:
        data: features of all pictures.
        settings: how to learn.
        progress: hears of every epoch; may cancel.
        learned: rows to learn from; by default all that are learned and not held out.
        apart: rows for early stopping; by default the held-out ones.

    Raises:
        Cancelled: by ``progress``.
    """
    learned = data.rows(data.learned & ~data.held_out) if learned is None else learned
    apart = data.rows(data.held_out) if apart is None else apart
    mean, deviation = _mean_and_deviation(data.features, learned)
    width = int(data.labels[data.learned].max()) + 1
    weight = torch.zeros((width, data.features.shape[1]), requires_grad=True)
    bias = torch.zeros(width, requires_grad=True)
    groups: list[dict[str, Any]] = [
        {"params": [weight], "weight_decay": settings.weight_decay},
        {"params": [bias]},
    ]
    optimizer = torch.optim.Adam(groups, lr=settings.learning_rate)
    batch_of = _batches(data, mean, deviation)
    rng = np.random.default_rng(settings.seed)
    curves: dict[str, list[float]] = {"train_loss": [], "held_out_loss": [], "held_out_accuracy": []}
    best_loss, best_epoch = np.inf, 0
    best = (weight.detach().clone(), bias.detach().clone())
    for epoch in range(settings.epochs):
        order = rng.permutation(learned)
        total = 0.0
        for start in range(0, len(order), settings.batch_size):
            features, labels = batch_of(order[start : start + settings.batch_size])
            optimizer.zero_grad()
            loss = functional.cross_entropy(functional.linear(features, weight, bias), labels)
            loss.backward()  # type: ignore[no-untyped-call]
            optimizer.step()
            total += float(loss.detach()) * len(labels)
        held_out_loss, accuracy = _loss_and_accuracy(batch_of, apart, weight, bias)
        curves["train_loss"].append(total / len(order))
        curves["held_out_loss"].append(held_out_loss)
        curves["held_out_accuracy"].append(accuracy)
        if held_out_loss < best_loss:
            best_loss, best_epoch = held_out_loss, epoch
            best = (weight.detach().clone(), bias.detach().clone())
        progress.report(
            (epoch + 1) / settings.epochs,
            f"epoch {epoch + 1}: loss {total / len(order):.4f}, held out {held_out_loss:.4f}, "
            f"{100 * accuracy:.1f} % of held-out pictures right",
        )
        if epoch - best_epoch >= settings.patience:
            break
    folded = best[0].numpy().astype(np.float64) / deviation
    shifted = best[1].numpy().astype(np.float64) - folded @ mean
    return Head(
        weight=folded.astype(np.float32),
        bias=shifted.astype(np.float32),
        class_count=data.class_count,
        temperature=1.0,
        curves=curves,
        best_epoch=best_epoch,
    )


def softmax(values: Float[np.ndarray, "*N C"]) -> Float[np.ndarray, "*N C"]:
    """Probabilities along the last axis."""
    shifted = np.exp(values - values.max(axis=-1, keepdims=True))
    return np.asarray(shifted / shifted.sum(axis=-1, keepdims=True))


_Batches = Callable[[Int[np.ndarray, " B"]], tuple[torch.Tensor, torch.Tensor]]


def _batches(data: FeatureSet, mean: Float[np.ndarray, " D"], deviation: Float[np.ndarray, " D"]) -> _Batches:
    mean32, factor32 = mean.astype(np.float32), (1.0 / deviation).astype(np.float32)

    def batch_of(rows: Int[np.ndarray, " B"]) -> tuple[torch.Tensor, torch.Tensor]:
        features = (data.features[rows] - mean32) * factor32
        return torch.from_numpy(features), torch.from_numpy(data.row_labels(rows))

    return batch_of


def _loss_and_accuracy(
    batch_of: _Batches, rows: Int[np.ndarray, " A"], weight: torch.Tensor, bias: torch.Tensor
) -> tuple[float, float]:
    """Mean loss and share of right pictures, piece by piece: no second copy of many features."""
    loss, right = 0.0, 0.0
    with torch.no_grad():
        for part in np.array_split(rows, max(1, len(rows) // 4096)):
            features, labels = batch_of(part)
            values = functional.linear(features, weight, bias)
            loss += float(functional.cross_entropy(values, labels, reduction="sum"))
            right += float((values.argmax(dim=1) == labels).sum())
    return loss / len(rows), right / len(rows)


def _mean_and_deviation(
    features: Float[np.ndarray, "N D"], rows: Int[np.ndarray, " M"]
) -> tuple[Float[np.ndarray, " D"], Float[np.ndarray, " D"]]:
    """Mean and standard deviation of some rows, without a second copy of all features."""
    total = np.zeros(features.shape[1])
    squares = np.zeros(features.shape[1])
    for part in np.array_split(rows, max(1, len(rows) // 4096)):
        block = features[part].astype(np.float64)
        total += block.sum(axis=0)
        squares += (block * block).sum(axis=0)
    mean = total / len(rows)
    deviation = np.sqrt(np.maximum(squares / len(rows) - mean * mean, 0.0))
    return mean, np.where(deviation > 1e-6, deviation, 1.0)
