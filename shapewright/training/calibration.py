"""How sure a classifier may be: tried on models that it has not learned from (ours).

Held-out variations of a model that was learned are far easier than real objects are. So the models are split into
folds: a head learns without a fold's models and is tried on their variations, and on objects of no class that
it did not learn from either. What it says there sets the temperature and the curve that tells known from unknown, and
is the honest forecast among the figures of a training. Where there is nothing to leave out (classes of one model each),
held-out variations set both, and there is no forecast. Labels of real meshes play no part. Scans have a curve of their
own, set by those of these objects that were broken.

Most real objects resemble a model that was learned, and some resemble one that was left out. So each fold is also tried
on held-out variations of the models it has learned; the forecast counts the left-out models alone.
"""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.optimize import minimize_scalar

from shapewright.classification.evidence import KnownCurves, auroc, class_probabilities, class_scores, fit_known_curve
from shapewright.classification.exemplars import Exemplars
from shapewright.classification.trade_off import measure_trade_off, trade_off_key
from shapewright.distances.panorama import PanoramaDescriptor
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress
from shapewright.training.dataset import FeatureSet, Plan
from shapewright.training.exemplars import USUAL
from shapewright.training.head import softmax
from shapewright.training.head_training import train_head
from shapewright.training.settings import TrainingSettings

FOLDS: Final = 3
MAX_TEMPERATURE: Final = 20.0
_LEARNED_A_SHARE: Final = 60
"""Meshes of each share that a fold learns from at most, each by :data:`_VIEWS` pictures; it learns in seconds."""
_TRIED_A_KIND: Final = 60
"""Variations of each class, and objects of each source without a class, that are tried."""
_FAMILIAR: Final = 3
"""Variations of learned models tried for each variation of a left-out model. The curve accepts real meshes about as
often as the former (91 and 92 %), and more often than the latter (75 %)."""
_VIEWS: Final = 4
_BINS: Final = 15


@dataclass(frozen=True)
class Calibration:
    """What the folds gave.

    Args:
        temperature: of the class values.
        pictures: curves of ``known`` for pictures alone; ``None`` if no objects of no class were learned from.
        geometry: the same with distances to exemplars; ``None`` without exemplars.
        usual_distances: of each class, the panorama distance to its nearest exemplar within which nine of ten of the
            tried variations lie; ``None`` without exemplars.
        metrics: figures as JSON values: accuracy on variations of left-out models by pictures and by all
            evidence, how far their probabilities by all evidence are from the truth, the area under the curve of
            known against unknown, and what thresholds of ``known`` accept and refuse; what was not tried is missing.
    """

    temperature: float
    pictures: KnownCurves | None
    geometry: KnownCurves | None
    usual_distances: tuple[float, ...] | None
    metrics: dict[str, Any]


@dataclass(frozen=True, eq=False)
class _Tried:
    """Meshes that a fold was tried on, and which of them come from models it has learned."""

    meshes: Int[np.ndarray, " M"]
    is_familiar: Bool[np.ndarray, " M"]
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
        plan: the sources, and how many meshes each one gave.
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
    values = np.concatenate([one.values for one in tried]).reshape(len(meshes), data.views, -1)
    familiar = np.concatenate([one.is_familiar for one in tried])
    kept, left_out = _honest(data, folds, meshes, familiar)
    meshes, values, familiar = meshes[kept], values[kept], familiar[kept]
    labels = data.labels[meshes]
    known = labels < data.class_count
    forecast = left_out & known
    closed = values[..., : data.class_count]
    flat = closed[known].reshape(-1, data.class_count)
    temperature = fit_temperature(flat, np.repeat(labels[known], data.views))
    probabilities = softmax(closed / temperature).mean(axis=1)
    opened = softmax(values / temperature)[..., : data.class_count].mean(axis=1)
    metrics: dict[str, Any] = {"left_out_meshes": int(forecast.sum())}
    whole, rough = _whole_and_rough(plan, settings, known, meshes)
    has_none = values.shape[2] > data.class_count

    def judged(name: str, by_class: Float[np.ndarray, "M C"], scores: Float[np.ndarray, "M C"]) -> KnownCurves | None:
        curves = None
        if has_none:
            curves = KnownCurves(*(fit_known_curve(scores[kind], known[kind]) for kind in (whole, rough)))
        best = (scores if curves is None else curves.whole.shifted(scores)).max(axis=1)
        if forecast.any():
            right = by_class[forecast].argmax(axis=1) == labels[forecast]
            metrics[f"left_out_accuracy{name}"] = float(right.mean())
            metrics[f"left_out_calibration_error{name}"] = calibration_error(by_class[forecast].max(axis=1), right)
            if curves is not None:
                metrics[f"left_out_auroc{name}"] = auroc(best[forecast], best[~known])
        if curves is not None and forecast.any():
            inside, outside = (
                [curves.whole.probability(one) for one in best[whole & kind]] for kind in (known, ~known)
            )
            points = measure_trade_off(inside, outside)
            metrics[trade_off_key(geometry=not name)] = [point.to_dict() for point in points]
        return curves

    pictures = judged("_pictures", probabilities, class_scores(opened))
    geometry = usual = None
    if exemplars is not None and descriptors is not None:
        near = _distances(data, descriptors, exemplars, meshes, familiar)
        by_all = np.stack([class_probabilities(p, d) for p, d in zip(probabilities, near, strict=True)])
        geometry = judged("", by_all, class_scores(opened, near))
        usual = _usual_distances(near[known & whole], labels[known & whole])
    return Calibration(temperature, pictures, geometry, usual, metrics)


def _whole_and_rough(
    plan: Plan, settings: TrainingSettings, known: Bool[np.ndarray, " M"], meshes: Int[np.ndarray, " M"]
) -> tuple[Bool[np.ndarray, " M"], Bool[np.ndarray, " M"]]:
    """Return which objects set the curve of whole meshes, and which that of scans: the whole and the broken ones.

    All set a curve for which there are no objects of the classes, or none of no class.
    """
    rough = np.concatenate([share.broken(settings) for share in plan.shares])[meshes]
    every = np.ones_like(rough)
    whole, rough = (kind if (kind & known).any() and (kind & ~known).any() else every for kind in (~rough, rough))
    return whole, rough


def _usual_distances(near: Float[np.ndarray, "K C"], labels: Int[np.ndarray, " K"]) -> tuple[float, ...]:
    """Return the quantile of the distances to the own class, of each class; of all together where one was not tried."""
    own = near[np.arange(len(labels)), labels]
    return tuple(
        float(np.quantile(own[labels == number] if (labels == number).any() else own, USUAL))
        for number in range(near.shape[1])
    )


def _honest(
    data: FeatureSet, folds: Int[np.ndarray, " S"], tried: Int[np.ndarray, " T"], familiar: Bool[np.ndarray, " T"]
) -> tuple[Int[np.ndarray, " M"], Bool[np.ndarray, " M"]]:
    """Which of the meshes that were tried count, and whether each is of a source that its fold had not learned from.

    Only such meshes and the familiar ones count, unless there are none of classes, or none of no class.
    """
    left_out = ((folds[data.sources[tried]] >= 0) | ~data.learned[tried]) & ~familiar
    known = data.labels[tried] < data.class_count
    counts = left_out | familiar
    for kind in (known, ~known):
        if not (left_out & kind).any():
            counts |= kind
    kept = np.flatnonzero(counts)
    return kept, left_out[kept]


def calibration_error(confidence: Float[np.ndarray, " N"], right: Bool[np.ndarray, " N"], bins: int = _BINS) -> float:
    """Expected calibration error: mean gap between confidence and accuracy over equal bins (Guo et al. 2017)."""
    slot = np.minimum((confidence * bins).astype(np.int64), bins - 1)
    gaps = [
        abs(float(confidence[slot == i].mean()) - float(right[slot == i].mean())) * float((slot == i).mean())
        for i in np.unique(slot)
    ]
    return float(sum(gaps))


def fit_temperature(values: Float[np.ndarray, "N C"], labels: Int[np.ndarray, " N"]) -> float:
    """The temperature that makes pictures with these class values most likely (Guo et al. 2017).

    At least 1: variations are easier than real meshes, so they may soften, never sharpen.
    """

    def loss(log_temperature: float) -> float:
        scaled = values.astype(np.float64) / np.exp(log_temperature)
        top = scaled.max(axis=1, keepdims=True)
        log_sum = np.log(np.exp(scaled - top).sum(axis=1)) + top[:, 0]
        return float((log_sum - scaled[np.arange(len(labels)), labels]).mean())

    best = minimize_scalar(loss, bounds=(0.0, np.log(MAX_TEMPERATURE)), method="bounded")
    return float(np.exp(best.x)) if loss(float(best.x)) < loss(0.0) else 1.0


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
    head = train_head(data, settings, learned=learned, apart=apart)
    once = (data.held_out if fold == 0 else np.zeros_like(left_out)) & (folds[data.sources] < 0)
    trials = ~data.learned & (np.arange(len(data.labels)) % FOLDS == fold)
    kinds = np.where(data.labels < data.class_count, data.labels, data.class_count + data.sources)
    each = max(1, _TRIED_A_KIND // FOLDS)
    tried = _sample(left_out | once | trials, kinds, each, rng)
    like_learned = usable & data.held_out & (data.labels < data.class_count) & (folds[data.sources] >= 0)
    familiar = _sample(like_learned, kinds, _FAMILIAR * each, rng)
    meshes = np.flatnonzero(tried | familiar)
    return _Tried(meshes, familiar[meshes], head.values(data.features[data.rows(tried | familiar)]))


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


def _distances(
    data: FeatureSet,
    descriptors: Float[np.ndarray, "M D"],
    exemplars: Exemplars,
    meshes: Int[np.ndarray, " K"],
    familiar: Bool[np.ndarray, " K"],
) -> Float[np.ndarray, "K C"]:
    """Return the distance of each mesh to the nearest exemplar of each class, leaving out the mesh itself.

    The other exemplars of its own model are left out, too, unless the mesh is familiar.
    """
    near = np.empty((len(meshes), data.class_count))
    for row, mesh in enumerate(meshes):
        distances = exemplars.distances(PanoramaDescriptor.from_array(descriptors[mesh]))
        own = int(data.sources[mesh]) if data.labels[mesh] < data.class_count else None
        if own is not None:
            number = mesh - int(np.argmax(data.sources == own))
            distances[(exemplars.models == own) & (exemplars.numbers == number)] = np.inf  # this is itself
        near[row], _ = exemplars.nearest(distances, without_model=None if familiar[row] else own)
    return near
