"""Adding classes to a trained classifier: what it knows stays, and only what is new is drawn at length (ours).

The backbone and the hidden layer of the base are kept, and the rows of the classes in its last layer. Rows for the new
classes are learned, and the row of ``none``, for which a new class was an object of no class until now. A few
variations of each model that the base knows are drawn again, so that no new row takes what belongs to an old class.
"""

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from jaxtyping import Bool, Float

from shapewright.classification.evidence import OTHER, UNKNOWN
from shapewright.errors import ClassifierError
from shapewright.estimation.generator import InstanceGenerator
from shapewright.network.backbone import Backbone
from shapewright.network.graphs import ClassifierParts, classifier_parts
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress
from shapewright.training.array_store import ArrayStore, MemoryStore
from shapewright.training.dataset import FeatureSet, Plan, Share, evenly, load_descriptors, load_features
from shapewright.training.exemplars import exemplars_of, joined_exemplars, usual_distances_of
from shapewright.training.export import export_classifier
from shapewright.training.extension_settings import ExtensionSettings
from shapewright.training.head import Head, Layer, softmax
from shapewright.training.learning import IMAGES_SHARE, TrainedClassifier, draw_and_describe
from shapewright.training.row_training import LearnedRows, learn_rows
from shapewright.training.settings import TrainingSettings
from shapewright.training.sources import AssemblySource, ModelSource

LEAST_OF_A_MODEL: Final = 4
"""Variations of a model that are drawn again at least."""
_KEPT_METRICS: Final = ("trade_off", "trade_off_pictures")
"""Figures of the base that stay true as long as its curves stay."""


@dataclass(frozen=True, eq=False)
class Extension:
    """A base, and all that is drawn to extend it.

    Args:
        base: the classifier that is extended.
        plan: the known classes by their numbers, the new classes, objects of no class.
        chosen: how it is extended.
        drawing: the settings by which everything is drawn.
    """

    base: TrainedClassifier
    plan: Plan
    chosen: ExtensionSettings
    drawing: TrainingSettings

    @cached_property
    def parts(self) -> ClassifierParts:
        """The graph of the base, taken apart."""
        return classifier_parts(self.base.onnx)

    @cached_property
    def backbone(self) -> Backbone:
        """The backbone as it is in the base's file: no other gives the features that its layers have learned from."""
        metadata = self.base.metadata
        return Backbone(
            name=metadata["backbone"]["name"],
            weights=metadata["backbone"]["weights"],
            weights_sha256=metadata["backbone"]["weights_sha256"],
            image_size=metadata["rendering"]["image_size"],
            feature_count=self.parts.layers[0][0].shape[1],
            preprocessing=metadata["preprocessing"],
            graph=self.parts.features,
        )

    @property
    def new_plan(self) -> Plan:
        """The new classes alone, numbered from 0."""
        first = len(self.base.class_names)
        names = self.plan.class_names[first:]
        return Plan(
            names,
            tuple(
                Share(share.source, share.label - first, share.count, share.described)
                for share in self.plan.shares
                if first <= share.label < len(self.plan.class_names)
            ),
        )


def extend_classifier(
    base: TrainedClassifier,
    classes: Mapping[str, Sequence[InstanceGenerator]],
    *,
    known: Sequence[InstanceGenerator],
    negatives: Sequence[InstanceGenerator] = (),
    settings: ExtensionSettings | None = None,
    progress: Progress = NULL_PROGRESS,
    store: ArrayStore | None = None,
) -> TrainedClassifier:
    """Add classes to a classifier, in seconds where a training takes minutes.

    The temperature and the curves of ``known`` stay those of the base, as do the trade-off that was measured for them
    and the usual distances of its classes: no model of the new classes is left out to try them on.

    Args:
        base: :meth:`TrainedClassifier.load` reads one from its file.
        classes: compiled models of each new class.
        known: the compiled models that the base has learned from, all of them, in any order.
        negatives: compiled models of things that are of none of the classes, neither the known nor the new ones. They
            and random assemblies keep unknown what was unknown; not used if the base has not learned what is unknown.
        settings: how to extend.
        progress: hears of every block of variations and every epoch.
        store: keeps features and descriptors for the next extension, which computes only what is new; by default they
            are forgotten.

    Raises:
        ClassifierError: a class that the base knows, or without models; models of the base that are missing, or that
            it does not know; a base of another version.
        RenderingError: no headless OpenGL, where pictures need it.
        Cancelled: by ``progress``; what is in the store stays there.
    """
    extension = plan_extension(base, classes, known=known, negatives=negatives, settings=settings)
    store = MemoryStore() if store is None else store
    drawing = PartialProgress(progress, 0.0, IMAGES_SHARE)
    draw_and_describe(extension.plan, extension.drawing, store, drawing, backbone=extension.backbone)
    return learn_extension(extension, store, PartialProgress(progress, IMAGES_SHARE, 1.0))


def plan_extension(
    base: TrainedClassifier,
    classes: Mapping[str, Sequence[InstanceGenerator]],
    *,
    known: Sequence[InstanceGenerator],
    negatives: Sequence[InstanceGenerator] = (),
    settings: ExtensionSettings | None = None,
) -> Extension:
    """Choose what is drawn, and how much of it; see :func:`extend_classifier`.

    Raises:
        ClassifierError: as there.
    """
    chosen = settings or ExtensionSettings()
    drawing = chosen.on(base.metadata["settings"])
    _check_classes(base, classes, chosen)
    given = {generator.model.digest: generator for generator in known}
    learned = {model["digest"]: model for model in base.metadata["models"]}
    if missing := [model["name"] for digest, model in learned.items() if digest not in given]:
        raise ClassifierError(
            f"expected all models that the base has learned from; missing, or given in another version: "
            f"{', '.join(missing[:5])}{', …' if len(missing) > 5 else ''}",
            where="known",
        )
    if strange := [generator.model.name for digest, generator in given.items() if digest not in learned]:
        raise ClassifierError(f"the base has not learned from {strange[0]}", where="known")
    digests = [one.model.digest for group in (known, negatives, *classes.values()) for one in group]
    if twice := [digest for digest, count in Counter(digests).items() if count > 1]:
        raise ClassifierError("a model comes twice", where=f"model {twice[0]}")

    old, new = len(base.class_names), len(classes)
    shares = []
    for number, name in enumerate(base.class_names):
        models = [given[digest] for digest, model in learned.items() if model["class"] == name]
        total = max(chosen.rehearsed, LEAST_OF_A_MODEL * len(models))
        shares += [
            Share(ModelSource(generator, drawing.vary), number, count, described=False)
            for generator, count in zip(models, evenly(total, len(models)), strict=True)
        ]
    described = base.exemplars is not None
    shares += [
        Share(ModelSource(generator, drawing.vary), number, count, described)
        for number, generators in enumerate(classes.values(), start=old)
        for generator, count in zip(generators, evenly(chosen.variations, len(generators)), strict=True)
    ]
    extension = Extension(base, Plan((*base.class_names, *classes), tuple(shares)), chosen, drawing)
    if len(extension.parts.layers[-1][0]) == old or not chosen.negatives:
        return extension
    none = old + new
    shares += [Share(ModelSource(one), none, LEAST_OF_A_MODEL, described=False) for one in negatives]
    shares.append(Share(AssemblySource(), none, chosen.negatives, described=False))
    return Extension(base, Plan(extension.plan.class_names, tuple(shares)), chosen, drawing)


def _check_classes(
    base: TrainedClassifier, classes: Mapping[str, Sequence[InstanceGenerator]], settings: ExtensionSettings
) -> None:
    if not classes:
        raise ClassifierError("there is no class to add", where="classes")
    for name, generators in classes.items():
        if name in (UNKNOWN, OTHER):
            raise ClassifierError("this word stands for what is of no class", where=f"classes.{name}")
        if name in base.class_names:
            raise ClassifierError("the base knows this class already", where=f"classes.{name}")
        if not generators:
            raise ClassifierError("the class has no models", where=f"classes.{name}")
        if len(generators) > settings.variations:
            raise ClassifierError("the class has more models than variations", where=f"classes.{name}")


def learn_extension(extension: Extension, store: ArrayStore, progress: Progress = NULL_PROGRESS) -> TrainedClassifier:
    """Learn the new rows from a store that holds all that the extension needs.

    Raises:
        ClassifierError: something is missing in the store.
        Cancelled: by ``progress``.
    """
    base, plan, backbone = extension.base, extension.plan, extension.backbone
    progress.report(0.0, "reading features")
    data = load_features(plan, extension.drawing, backbone, store)
    before = Head(
        tuple(Layer(*layer) for layer in extension.parts.layers),
        len(base.class_names),
        extension.parts.temperature,
        curves={},
        best_epoch=-1,
    )
    start, is_learned = _with_new_rows(before.layers[-1], len(base.class_names), len(plan.class_names))
    rows = np.arange(len(data.features))
    learned = learn_rows(
        start,
        is_learned,
        before.hidden(data.features),
        data.row_labels(rows),
        np.repeat(data.held_out, data.views),
        extension.chosen,
        seed=extension.drawing.seed,
        progress=PartialProgress(progress, 0.1, 0.8),
    )
    layers, names = (*before.layers[:-1], learned.layer), plan.class_names
    head = Head(layers, len(names), before.temperature, learned.curves, learned.best_epoch)
    progress.report(0.8, "comparing with exemplars")
    exemplars, usual = base.exemplars, base.metadata["usual_distances"]
    if exemplars is not None:
        descriptors = load_descriptors(extension.new_plan, extension.drawing, store)
        new = exemplars_of(extension.new_plan, descriptors, extension.drawing)
        if usual is not None:
            usual = [*usual, *usual_distances_of(new, otherwise=float(np.median(usual)))]
        exemplars = joined_exemplars(exemplars, new)
    else:
        usual = None
    metrics = _metrics(extension, data, before, head, learned)
    metadata = _metadata(extension, metrics, usual)
    progress.report(1.0, f"{100 * metrics['new_accuracy']:.1f} % of held-out variations of new classes right")
    return TrainedClassifier(
        export_classifier(backbone, head, metadata), exemplars, plan.class_names, metrics, metadata
    )


def _with_new_rows(last: Layer, old: int, every: int) -> tuple[Layer, Bool[np.ndarray, " K"]]:
    """Return the last layer with rows for new classes before the one of ``none``, and which rows are learned.

    New rows begin as copies of the row of ``none``, or as zeros without one.
    """

    def with_new(values: Float[np.ndarray, "*K"]) -> Float[np.ndarray, "*L"]:
        none = values[old:]
        new = np.repeat(none if len(none) else np.zeros_like(values[:1]), every - old, axis=0)
        return np.concatenate([values[:old], new, none])

    layer = Layer(with_new(last.weight), with_new(last.bias))
    return layer, np.arange(len(layer.bias)) >= old


def _metrics(extension: Extension, data: FeatureSet, before: Head, after: Head, learned: LearnedRows) -> dict[str, Any]:
    """Return what became of the held-out variations and pictures, as JSON values.

    ``known_`` stands for classes that the base knows, ``new_`` for the new ones, ``other_`` for objects of no class.
    ``refused`` is the share whose most probable row is that of ``none``.
    """
    old, every = before.class_count, data.class_count
    truth, views = data.labels[data.held_out], data.views
    features = data.features[data.rows(data.held_out)]

    def guesses(head: Head) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Row of each variation among the classes, the same of each picture, and whether each variation is refused."""
        values = head.values(features)
        closed = softmax(values[:, : head.class_count] / head.temperature)
        opened = softmax(values / head.temperature).reshape(len(truth), views, -1).mean(axis=1)
        of_variations = closed.reshape(len(truth), views, -1).mean(axis=1).argmax(axis=1)
        return of_variations, closed.argmax(axis=1), opened.argmax(axis=1) >= head.class_count

    (guess_before, picture_before, refused_before), (guess, picture, refused) = guesses(before), guesses(after)
    known, new, other = truth < old, (truth >= old) & (truth < every), truth >= every
    picture_truth = np.repeat(truth, views)
    metrics: dict[str, Any] = {
        "images": len(data.features),
        "held_out_images": len(features),
        "held_out_variations": int((known | new).sum()),
        "held_out_accuracy": _share((guess == truth)[known | new]),
        "known_accuracy_before": _share((guess_before == truth)[known]),
        "known_accuracy": _share((guess == truth)[known]),
        "known_image_accuracy_before": _share((picture_before == picture_truth)[np.repeat(known, views)]),
        "known_image_accuracy": _share((picture == picture_truth)[np.repeat(known, views)]),
        "known_refused_before": _share(refused_before[known]),
        "known_refused": _share(refused[known]),
        "new_accuracy": _share((guess == truth)[new]),
        "new_image_accuracy": _share((picture == picture_truth)[np.repeat(new, views)]),
        "new_refused_before": _share(refused_before[new]),
        "new_refused": _share(refused[new]),
        "temperature": after.temperature,
        "per_class": {name: _share((guess == truth)[truth == i]) for i, name in enumerate(extension.plan.class_names)},
        "epochs": len(learned.curves["train_loss"]),
        "best_epoch": learned.best_epoch,
        "curves": learned.curves,
    }
    if other.any():
        metrics |= {"other_refused_before": _share(refused_before[other]), "other_refused": _share(refused[other])}
    return metrics | {name: value for name, value in extension.base.metrics.items() if name in _KEPT_METRICS}


def _share(fine: Bool[np.ndarray, " N"]) -> float:
    return float(fine.mean())


def _metadata(extension: Extension, metrics: dict[str, Any], usual: Sequence[float] | None) -> dict[str, Any]:
    base, plan = extension.base, extension.plan
    models = [
        {"name": share.source.name, "class": name, "digest": share.source.digest}
        for number, name in enumerate(plan.class_names)
        if name not in base.class_names
        for share in plan.shares
        if share.label == number
    ]
    step = {
        "class_names": list(plan.class_names[len(base.class_names) :]),
        "base_sha256": hashlib.sha256(base.onnx).hexdigest(),
        "settings": extension.chosen.to_dict(),
    }
    return {
        **base.metadata,
        "class_names": list(plan.class_names),
        "models": [*base.metadata["models"], *models],
        "usual_distances": None if usual is None else list(usual),
        "extensions": [*base.metadata.get("extensions", []), step],
        "metrics": metrics,
    }
