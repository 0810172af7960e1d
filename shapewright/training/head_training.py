"""Learning a head with torch on stored features (paper section 3.2; the hidden layer is ours).

The paper learns one layer. Objects that are whole, seen from one side, full of holes or rounded to a grid belong to one
class and look different; a hidden layer can keep them together where a single layer cannot.
"""

from collections.abc import Callable
from itertools import pairwise
from typing import Final

import numpy as np
import torch
from jaxtyping import Float, Int
from torch.nn import functional

from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.training.dataset import FeatureSet
from shapewright.training.head import Head, Layer
from shapewright.training.settings import TrainingSettings

DROPPED: Final = 0.5
"""Share of the hidden values that each step drops (Srivastava et al. 2014)."""
LEAST_STEPS: Final = 8
"""Least number of steps in an epoch: few pictures make smaller batches."""
WARM_UP: Final = 0.1
"""Share of the steps in which the learning rate rises."""


def train_head(
    data: FeatureSet,
    settings: TrainingSettings,
    progress: Progress = NULL_PROGRESS,
    *,
    learned: Int[np.ndarray, " L"] | None = None,
    apart: Int[np.ndarray, " A"] | None = None,
) -> Head:
    """Learn the last layers by cross entropy with AdamW on standardized features, in one cycle of the learning rate.

    Keep the weights of the epoch with the lowest loss on the held-out pictures. Deterministic: all random numbers come
    from the seed, and torch's global generator is not used.

    Args:
        data: features of all pictures.
        settings: how to learn.
        progress: receives a report after every epoch; may cancel.
        learned: rows to learn from; by default all that are learned and not held out.
        apart: rows for early stopping; by default the held-out ones.

    Raises:
        Cancelled: by ``progress``.
    """
    learned = data.rows(data.learned & ~data.held_out) if learned is None else learned
    apart = data.rows(data.held_out) if apart is None else apart
    mean, deviation = _mean_and_deviation(data.features, learned)
    generator = torch.Generator().manual_seed(settings.seed)
    hidden = [settings.hidden] if settings.hidden else []
    widths = [data.features.shape[1], *hidden, int(data.labels[data.learned].max()) + 1]
    values_of = _Layers(widths, generator)
    batch_of = _batches(data, mean, deviation)
    batch = min(settings.batch_size, max(1, len(learned) // LEAST_STEPS))
    optimizer = torch.optim.AdamW(values_of.parameters(), lr=settings.learning_rate, weight_decay=settings.weight_decay)
    rate = torch.optim.lr_scheduler.OneCycleLR(
        optimizer,
        settings.learning_rate,
        total_steps=settings.epochs * -(-len(learned) // batch) + 1,
        pct_start=WARM_UP,
    )
    rng = np.random.default_rng(settings.seed)
    curves: dict[str, list[float]] = {"train_loss": [], "held_out_loss": [], "held_out_accuracy": []}
    best_loss, best_epoch, best = np.inf, 0, values_of.layers()
    for epoch in range(settings.epochs):
        order = rng.permutation(learned)
        total = 0.0
        for start in range(0, len(order), batch):
            features, labels = batch_of(order[start : start + batch])
            optimizer.zero_grad()
            loss = functional.cross_entropy(values_of(features, dropped=DROPPED), labels)
            loss.backward()  # type: ignore[no-untyped-call]
            optimizer.step()
            rate.step()
            total += float(loss.detach()) * len(labels)
        held_out_loss, accuracy = _loss_and_accuracy(batch_of, apart, values_of)
        curves["train_loss"].append(total / len(order))
        curves["held_out_loss"].append(held_out_loss)
        curves["held_out_accuracy"].append(accuracy)
        if held_out_loss < best_loss:
            best_loss, best_epoch, best = held_out_loss, epoch, values_of.layers()
        progress.report(
            (epoch + 1) / settings.epochs,
            f"epoch {epoch + 1}: loss {total / len(order):.4f}, held out {held_out_loss:.4f}, "
            f"{100 * accuracy:.1f} % of held-out pictures right",
        )
        if epoch - best_epoch >= settings.patience:
            break
    return Head(
        layers=(_for_plain_features(best[0], mean, deviation), *best[1:]),
        class_count=data.class_count,
        temperature=1.0,
        curves=curves,
        best_epoch=best_epoch,
    )


class _Layers(torch.nn.Module):
    """The layers while they are learned."""

    def __init__(self, widths: list[int], generator: torch.Generator) -> None:
        super().__init__()
        self._generator = generator
        self._weights, self._biases = torch.nn.ParameterList(), torch.nn.ParameterList()
        for inputs, outputs in pairwise(widths):
            reach = inputs**-0.5
            self._weights.append((2.0 * torch.rand((outputs, inputs), generator=generator) - 1.0) * reach)
            self._biases.append(torch.zeros(outputs))

    def forward(self, values: torch.Tensor, dropped: float = 0.0) -> torch.Tensor:
        for number, (weight, bias) in enumerate(zip(self._weights, self._biases, strict=True)):
            if number > 0:
                values = functional.relu(values)
                if dropped:
                    kept = torch.rand(values.shape, generator=self._generator) >= dropped
                    values = values * kept / (1.0 - dropped)
            values = functional.linear(values, weight, bias)
        return values

    def layers(self) -> tuple[Layer, ...]:
        """The layers as they are now."""
        pairs = zip(self._weights, self._biases, strict=True)
        return tuple(Layer(weight.detach().numpy().copy(), bias.detach().numpy().copy()) for weight, bias in pairs)


_Batches = Callable[[Int[np.ndarray, " B"]], tuple[torch.Tensor, torch.Tensor]]


def _batches(data: FeatureSet, mean: Float[np.ndarray, " D"], deviation: Float[np.ndarray, " D"]) -> _Batches:
    mean32, factor32 = mean.astype(np.float32), (1.0 / deviation).astype(np.float32)

    def batch_of(rows: Int[np.ndarray, " B"]) -> tuple[torch.Tensor, torch.Tensor]:
        features = (data.features[rows] - mean32) * factor32
        return torch.from_numpy(features), torch.from_numpy(data.row_labels(rows))

    return batch_of


def _loss_and_accuracy(batch_of: _Batches, rows: Int[np.ndarray, " A"], values_of: _Layers) -> tuple[float, float]:
    """Return the mean loss and the share of right pictures, without a second copy of all features."""
    loss, right = 0.0, 0.0
    with torch.no_grad():
        for part in np.array_split(rows, max(1, len(rows) // 4096)):
            features, labels = batch_of(part)
            values = values_of(features)
            loss += float(functional.cross_entropy(values, labels, reduction="sum"))
            right += float((values.argmax(dim=1) == labels).sum())
    return loss / len(rows), right / len(rows)


def _for_plain_features(layer: Layer, mean: Float[np.ndarray, " D"], deviation: Float[np.ndarray, " D"]) -> Layer:
    """Fold the standardization of the features into the layer that reads them."""
    weight = layer.weight.astype(np.float64) / deviation
    return Layer(weight.astype(np.float32), (layer.bias - weight @ mean).astype(np.float32))


def _mean_and_deviation(
    features: Float[np.ndarray, "N D"], rows: Int[np.ndarray, " M"]
) -> tuple[Float[np.ndarray, " D"], Float[np.ndarray, " D"]]:
    """Return the mean and standard deviation of some rows, without a second copy of all features."""
    total = np.zeros(features.shape[1])
    squares = np.zeros(features.shape[1])
    for part in np.array_split(rows, max(1, len(rows) // 4096)):
        block = features[part].astype(np.float64)
        total += block.sum(axis=0)
        squares += (block * block).sum(axis=0)
    mean = total / len(rows)
    deviation = np.sqrt(np.maximum(squares / len(rows) - mean * mean, 0.0))
    return mean, np.where(deviation > 1e-6, deviation, 1.0)
