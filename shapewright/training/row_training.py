"""Learning some rows of a last layer with torch while its other rows stay as they are (ours)."""

from dataclasses import dataclass
from typing import Final

import numpy as np
import torch
from jaxtyping import Bool, Float, Int
from torch.nn import functional

from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.training.extension_settings import ExtensionSettings
from shapewright.training.head import Layer
from shapewright.training.head_training import LEAST_STEPS, WARM_UP

_USUAL_INPUTS: Final = 1280
"""Inputs of a last layer for which learning rates are given."""
_LEAST_DEVIATION: Final = 1e-6
"""Inputs that vary less are constant, as those of a dead hidden value are."""


@dataclass(frozen=True, eq=False)
class LearnedRows:
    """What :func:`learn_rows` gives.

    Args:
        layer: the last layer, all rows.
        curves: figures of each epoch: train_loss, held_out_loss, held_out_accuracy.
        best_epoch: the epoch, from 0, whose weights these are; -1 if none is better than where they began.
    """

    layer: Layer
    curves: dict[str, list[float]]
    best_epoch: int


def learn_rows(
    start: Layer,
    learned_rows: Bool[np.ndarray, " K"],
    inputs: Float[np.ndarray, "N D"],
    labels: Int[np.ndarray, " N"],
    held_out: Bool[np.ndarray, " N"],
    settings: ExtensionSettings,
    *,
    seed: int,
    progress: Progress = NULL_PROGRESS,
) -> LearnedRows:
    """Learn rows by cross entropy over all rows; every label weighs the same, however few its pictures.

    What is learned is the difference to the start, and weight decay pulls it to nothing. Weights of the epoch with the
    lowest loss on held-out pictures are kept. Deterministic: everything random comes from the seed.

    Args:
        start: the last layer as learning finds it.
        learned_rows: which rows are learned.
        inputs: of the last layer, a row a picture.
        labels: the right row of each picture.
        held_out: which pictures are not learned from.
        settings: how to learn.
        seed: of the order of the pictures.
        progress: hears of every epoch; may cancel.

    Raises:
        Cancelled: by ``progress``.
    """
    apart, learned = np.flatnonzero(held_out), np.flatnonzero(~held_out)
    mean, deviation = inputs[learned].mean(axis=0), inputs[learned].std(axis=0)
    factor = np.where(deviation > _LEAST_DEVIATION, 1.0 / np.maximum(deviation, _LEAST_DEVIATION), 0.0)
    before, standard = torch.from_numpy(start(inputs)), torch.from_numpy((inputs - mean) * factor)
    right, weights = torch.from_numpy(labels), torch.from_numpy(_weights(labels, learned))
    places = torch.from_numpy(np.flatnonzero(learned_rows))
    weight = torch.zeros((len(places), inputs.shape[1]), requires_grad=True)
    bias = torch.zeros(len(places), requires_grad=True)

    def loss_of(rows: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        values = before[rows].index_add(1, places, functional.linear(standard[rows], weight, bias))
        losses = functional.cross_entropy(values, right[rows], reduction="none") * weights[rows]
        return losses.sum() / weights[rows].sum(), values

    def judged() -> tuple[float, float]:
        with torch.no_grad():
            loss, values = loss_of(torch.from_numpy(apart))
            return float(loss), float((values.argmax(dim=1) == right[apart]).double().mean())

    def layer() -> Layer:
        change = weight.detach().numpy() * factor
        whole = Layer(start.weight.copy(), start.bias.copy())
        whole.weight[learned_rows] += change
        whole.bias[learned_rows] += bias.detach().numpy() - change @ mean
        return whole

    batch = min(settings.batch_size, max(1, len(learned) // LEAST_STEPS))
    highest = settings.learning_rate * _USUAL_INPUTS / inputs.shape[1]
    optimizer = torch.optim.AdamW([weight, bias], lr=highest, weight_decay=settings.weight_decay)
    steps = settings.epochs * -(-len(learned) // batch) + 1
    rate = torch.optim.lr_scheduler.OneCycleLR(optimizer, highest, total_steps=steps, pct_start=WARM_UP)
    rng = np.random.default_rng(seed)
    curves: dict[str, list[float]] = {"train_loss": [], "held_out_loss": [], "held_out_accuracy": []}
    best_loss, best_epoch, best = judged()[0], -1, layer()
    for epoch in range(settings.epochs):
        order, total = torch.from_numpy(rng.permutation(learned)), 0.0
        for begin in range(0, len(order), batch):
            rows = order[begin : begin + batch]
            optimizer.zero_grad()
            loss, _ = loss_of(rows)
            loss.backward()  # type: ignore[no-untyped-call]
            optimizer.step()
            rate.step()
            total += float(loss.detach()) * len(rows)
        held_out_loss, accuracy = judged()
        curves["train_loss"].append(total / len(learned))
        curves["held_out_loss"].append(held_out_loss)
        curves["held_out_accuracy"].append(accuracy)
        if held_out_loss < best_loss:
            best_loss, best_epoch, best = held_out_loss, epoch, layer()
        progress.report(
            (epoch + 1) / settings.epochs, f"epoch {epoch + 1}: {100 * accuracy:.1f} % of held-out pictures right"
        )
        if epoch - best_epoch >= settings.patience:
            break
    return LearnedRows(best, curves, best_epoch)


def _weights(labels: Int[np.ndarray, " N"], learned: Int[np.ndarray, " L"]) -> Float[np.ndarray, " N"]:
    """Return a weight of each picture by which all labels weigh the same."""
    counts = np.bincount(labels[learned], minlength=int(labels.max()) + 1)
    return (len(learned) / np.maximum(counts, 1))[labels].astype(np.float32)
