"""The last layer: learned with torch on stored features, stopped early, calibrated (paper section 3.2)."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from jaxtyping import Float, Int
from scipy.optimize import minimize_scalar
from torch.nn import functional

from shapewright.classification.dataset import FeatureSet
from shapewright.classification.settings import TrainingSettings
from shapewright.progress import NULL_PROGRESS, Progress

MAX_TEMPERATURE = 20.0


@dataclass(frozen=True, eq=False)
class Head:
    """A trained last layer: class values = features · weightᵀ + bias, divided by the temperature.

    Args:
        weight: one row a class; the standardisation of the features is folded in.
        bias: one number a class.
        temperature: softens the class values so that probabilities mean what they say; at least 1.
        curves: figures of each epoch: train_loss, held_out_loss, held_out_accuracy.
        best_epoch: the epoch, from 0, whose weights these are.
    """

    weight: Float[np.ndarray, "C D"]
    bias: Float[np.ndarray, " C"]
    temperature: float
    curves: dict[str, list[float]]
    best_epoch: int

    def probabilities(self, features: Float[np.ndarray, "N D"]) -> Float[np.ndarray, "N C"]:
        """Calibrated class probabilities, as the exported graph gives them."""
        return _softmax((features @ self.weight.T + self.bias) / self.temperature)


def train_head(
    data: FeatureSet, class_count: int, settings: TrainingSettings, progress: Progress = NULL_PROGRESS
) -> Head:
    """Learn the last layer by cross entropy with Adam on standardised features, from zero weights.

    Weights of the epoch with the lowest held-out loss are kept. Deterministic: only the order of the pictures is
    random, and it comes from the seed. Torch's global generator is left alone.

    Raises:
        Cancelled: by ``progress``.
    """
    learned = np.flatnonzero(~data.held_out)
    apart = np.flatnonzero(data.held_out)
    mean, deviation = _mean_and_deviation(data.features, learned)
    weight = torch.zeros((class_count, data.features.shape[1]), requires_grad=True)
    bias = torch.zeros(class_count, requires_grad=True)
    groups: list[dict[str, Any]] = [
        {"params": [weight], "weight_decay": settings.weight_decay},
        {"params": [bias]},
    ]
    optimizer = torch.optim.Adam(groups, lr=settings.learning_rate)
    batch_of = _batches(data, mean, deviation)
    apart_features, apart_labels = batch_of(apart)
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
        with torch.no_grad():
            values = functional.linear(apart_features, weight, bias)
            held_out_loss = float(functional.cross_entropy(values, apart_labels))
            accuracy = float((values.argmax(dim=1) == apart_labels).float().mean())
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
    weight_np, bias_np = folded.astype(np.float32), shifted.astype(np.float32)
    values_np = data.features[apart] @ weight_np.T + bias_np
    return Head(
        weight=weight_np,
        bias=bias_np,
        temperature=fit_temperature(values_np, data.labels[apart]),
        curves=curves,
        best_epoch=best_epoch,
    )


def fit_temperature(values: Float[np.ndarray, "N C"], labels: Int[np.ndarray, " N"]) -> float:
    """The temperature that makes held-out pictures most likely (Guo et al. 2017).

    At least 1: held-out variations are easier than real meshes, so they may soften, never sharpen.
    """

    def loss(log_temperature: float) -> float:
        scaled = values.astype(np.float64) / np.exp(log_temperature)
        top = scaled.max(axis=1, keepdims=True)
        log_sum = np.log(np.exp(scaled - top).sum(axis=1)) + top[:, 0]
        return float((log_sum - scaled[np.arange(len(labels)), labels]).mean())

    best = minimize_scalar(loss, bounds=(0.0, np.log(MAX_TEMPERATURE)), method="bounded")
    return float(np.exp(best.x)) if loss(float(best.x)) < loss(0.0) else 1.0


def _batches(
    data: FeatureSet, mean: Float[np.ndarray, " D"], deviation: Float[np.ndarray, " D"]
) -> Callable[[Int[np.ndarray, " B"]], tuple[torch.Tensor, torch.Tensor]]:
    mean32, factor32 = mean.astype(np.float32), (1.0 / deviation).astype(np.float32)

    def batch_of(rows: Int[np.ndarray, " B"]) -> tuple[torch.Tensor, torch.Tensor]:
        features = (data.features[rows] - mean32) * factor32
        return torch.from_numpy(features), torch.from_numpy(data.labels[rows])

    return batch_of


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


def _softmax(values: Float[np.ndarray, "N C"]) -> Float[np.ndarray, "N C"]:
    shifted = np.exp(values - values.max(axis=1, keepdims=True))
    return np.asarray(shifted / shifted.sum(axis=1, keepdims=True))
