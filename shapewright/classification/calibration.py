"""How sure a classifier may be: tried on models that it has not learned from (ours).

Held-out variations of a model that was learned are far easier than real objects are. So the models are split into
folds: a last layer learns without a fold's models and is tried on their variations, and on objects of no class that
it did not learn from either. What it says there sets the temperature and the curve that tells known from unknown, and
is the honest forecast among the figures of a training. Labels of real meshes have no part in it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.optimize import minimize_scalar

from shapewright.classification.dataset import FeatureSet, Plan
from shapewright.classification.evidence import KnownCurve, class_probabilities, class_scores, fit_known_curve
from shapewright.classification.exemplars import Exemplars
from shapewright.classification.head import softmax, train_head
from shapewright.classification.settings import TrainingSettings
from shapewright.distances.panorama import PanoramaDescriptor
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress

FOLDS: Final = 3
MAX_TEMPERATURE: Final = 20.0
_LEARNED_A_SHARE: Final = 60
"""Meshes of each share that a fold learns from at most, each by :data:`_VIEWS` pictures; it learns in seconds."""
_TRIED_A_KIND: Final = 40
"""Variations of each class, and objects of each source without a class, that are tried."""
_VIEWS: Final = 4
_EPOCHS: Final = 12


@dataclass(frozen=True)
class Calibration:
    """What the folds gave.

    Args:
        temperature: of the class values.
        pictures: curve of ``known`` for pictures alone; ``None`` if no objects of no class were learned from.
        geometry: the same with distances to exemplars; ``None`` without exemplars.
        metrics: figures as JSON values: accuracy on variations of left-out models by pictures and by all
            evidence, and the area under the curve of known against unknown.
    """

    temperature: float
    pictures: KnownCurve | None
    geometry: KnownCurve | None
    metrics: dict[str, Any]


@dataclass(frozen=True, eq=False)
class _Tried:
    """Meshes that a fold was tried on."""

    meshes: Int[np.ndarray, " M"]
    values: Float[np.ndarray, "N K"]


def calibrate(
    plan: Plan,
    data: FeatureSet,
    settings: TrainingSettings,
    *,
    descriptors: Float[np.ndarray, "M D"] | None = None,
    exemplars: Exemplars | None = None,
    progress: Progress = NULL_PROGRESS,
) -> Calibration:
    """Learn without each fold's models and see what becomes of them.

    Args:
        plan: what was drawn.
        data: its features.
        settings: of the training.
        descriptors: panorama descriptors of all meshes, with ``exemplars``.
        exemplars: of the classes; a variation's own model is left out when it is compared.
        progress: told of every fold; may cancel.

    Raises:
        Cancelled: by ``progress``.
    """
    folds = _folds(plan)
    tried = []
    for fold in range(FOLDS):
        part = PartialProgress(progress, 0.8 * fold / FOLDS, 0.8 * (fold + 1) / FOLDS)
        part.report(0.0, f"learning without some models, {fold + 1} of {FOLDS}")
        tried.append(_try_fold(data, settings, folds, fold))
    progress.report(0.8, "comparing with exemplars")
    meshes = np.concatenate([one.meshes for one in tried])
    values = np.concatenate([one.values for one in tried])
    labels = data.labels[meshes]
    known = labels < data.class_count
    row_labels = np.repeat(labels, data.views)
    row_known = row_labels < data.class_count
    closed = values[:, : data.class_count]
    temperature = fit_temperature(closed[row_known], row_labels[row_known])
    by_mesh = (len(meshes), data.views, -1)
    probabilities = softmax(closed / temperature).reshape(by_mesh).mean(axis=1)
    opened = softmax(values / temperature)[:, : data.class_count].reshape(by_mesh).mean(axis=1)
    metrics: dict[str, Any] = {
        "left_out_meshes": int(known.sum()),
        "left_out_accuracy_pictures": _accuracy(probabilities[known], labels[known]),
    }
    has_none = values.shape[1] > data.class_count
    scores = class_scores(opened).max(axis=1)
    pictures = fit_known_curve(scores, known) if has_none else None
    if has_none:
        metrics["left_out_auroc_pictures"] = auroc(scores[known], scores[~known])
    geometry = None
    if exemplars is not None and descriptors is not None:
        near = _distances_without_own_model(data, descriptors, exemplars, meshes)
        every = [class_probabilities(p, d) for p, d in zip(probabilities, near, strict=True)]
        metrics["left_out_accuracy"] = _accuracy(np.stack(every)[known], labels[known])
        scores = class_scores(opened, near).max(axis=1)
        if has_none:
            geometry = fit_known_curve(scores, known)
            metrics["left_out_auroc"] = auroc(scores[known], scores[~known])
    return Calibration(temperature, pictures, geometry, metrics)


def fit_temperature(values: Float[np.ndarray, "N C"], labels: Int[np.ndarray, " N"]) -> float:
    """The temperature that makes pictures with these class values most likely (Guo et al. 2017).

    At least 1: even variations of models that were left out are easier than real meshes, so they may soften, never
    sharpen.
    """

    def loss(log_temperature: float) -> float:
        scaled = values.astype(np.float64) / np.exp(log_temperature)
        top = scaled.max(axis=1, keepdims=True)
        log_sum = np.log(np.exp(scaled - top).sum(axis=1)) + top[:, 0]
        return float((log_sum - scaled[np.arange(len(labels)), labels]).mean())

    best = minimize_scalar(loss, bounds=(0.0, np.log(MAX_TEMPERATURE)), method="bounded")
    return float(np.exp(best.x)) if loss(float(best.x)) < loss(0.0) else 1.0


def auroc(positive: Float[np.ndarray, " P"], negative: Float[np.ndarray, " N"]) -> float:
    """Area under the ROC curve: the chance that a positive has a higher score than a negative (ties count half)."""
    order = np.sort(negative)
    below = np.searchsorted(order, positive, side="left")
    not_above = np.searchsorted(order, positive, side="right")
    return float((below + not_above).mean() / 2 / len(negative))


def _folds(plan: Plan) -> Int[np.ndarray, " S"]:
    """The fold in which each share is left out; -1 for one that has no like: a class's only model."""
    folds = np.full(len(plan.shares), -1)
    labels = np.array([share.label for share in plan.shares])
    for label in np.unique(labels):
        shares = [index for index in np.flatnonzero(labels == label) if plan.shares[index].learned]
        if len(shares) > 1:
            folds[shares] = np.arange(len(shares)) % FOLDS
    return folds


def _try_fold(data: FeatureSet, settings: TrainingSettings, folds: Int[np.ndarray, " S"], fold: int) -> _Tried:
    """Learn without the fold's shares; try them, and in the first fold also what no fold leaves out."""
    left_out = folds[data.sources] == fold
    rng = np.random.default_rng([settings.seed, fold])
    usable = data.learned & ~left_out
    learned = _views_of(data, _sample(usable & ~data.held_out, data.sources, _LEARNED_A_SHARE, rng))
    apart = _views_of(data, _sample(usable & data.held_out, data.sources, _LEARNED_A_SHARE, rng))
    if not len(learned) or not len(apart):  # few variations: the split was drawn by class, not by model
        learned = apart = np.concatenate([learned, apart])
    head = train_head(data, replace(settings, epochs=min(settings.epochs, _EPOCHS)), learned=learned, apart=apart)
    once = (data.held_out if fold == 0 else np.zeros_like(left_out)) & (folds[data.sources] < 0)
    trials = ~data.learned & (np.arange(len(data.labels)) % FOLDS == fold)
    kinds = np.where(data.labels < data.class_count, data.labels, data.class_count + data.sources)
    tried = _sample(left_out | once | trials, kinds, max(1, _TRIED_A_KIND // FOLDS), rng)
    return _Tried(np.flatnonzero(tried), head.values(data.features[data.rows(tried)]))


def _sample(
    chosen: Bool[np.ndarray, " M"], groups: Int[np.ndarray, " M"], most: int, rng: np.random.Generator
) -> Bool[np.ndarray, " M"]:
    """At most so many of the chosen in each group."""
    kept = np.zeros_like(chosen)
    for group in np.unique(groups[chosen]):
        members = np.flatnonzero(chosen & (groups == group))
        kept[rng.permutation(members)[:most]] = True
    return kept


def _views_of(data: FeatureSet, meshes: Bool[np.ndarray, " M"]) -> Int[np.ndarray, " N"]:
    return data.rows(meshes).reshape(-1, data.views)[:, :_VIEWS].reshape(-1)


def _distances_without_own_model(
    data: FeatureSet, descriptors: Float[np.ndarray, "M D"], exemplars: Exemplars, meshes: Int[np.ndarray, " K"]
) -> Float[np.ndarray, "K C"]:
    near = np.empty((len(meshes), data.class_count))
    for row, mesh in enumerate(meshes):
        distances = exemplars.distances(PanoramaDescriptor.from_array(descriptors[mesh]))
        own = int(data.sources[mesh]) if data.labels[mesh] < data.class_count else None
        if own is not None:
            distances[mesh] = np.inf  # the exemplars are the first rows of all meshes: this is itself
        near[row], _ = exemplars.nearest(distances, without_model=own)
    return near


def _accuracy(probabilities: Sequence[Any] | np.ndarray, labels: Int[np.ndarray, " M"]) -> float:
    return float((np.asarray(probabilities).argmax(axis=1) == labels).mean()) if len(labels) else 0.0
