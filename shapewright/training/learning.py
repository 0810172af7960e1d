"""From procedural models to a classifier: draw, describe, learn, calibrate, export (paper section 3.2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from shapewright.classification.classifier import Classifier
from shapewright.classification.exemplars import Exemplars
from shapewright.classification.file_format import exemplars_file
from shapewright.errors import ClassifierError
from shapewright.estimation.generator import InstanceGenerator
from shapewright.network.backbone import Backbone, load_backbone
from shapewright.network.features import FeatureExtractor
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress
from shapewright.training.array_store import ArrayStore, MemoryStore
from shapewright.training.calibration import calibrate, calibration_error
from shapewright.training.chunks import is_stored, store_chunk
from shapewright.training.dataset import FeatureSet, Plan, load_descriptors, load_features, plan_learning
from shapewright.training.exemplars import exemplars_of
from shapewright.training.export import ModelReference, classifier_metadata, export_classifier
from shapewright.training.head import Head
from shapewright.training.head_training import train_head
from shapewright.training.settings import TrainingSettings

IMAGES_SHARE = 0.85
"""Share of the work that drawing and describing takes, for the progress shown."""


@dataclass(frozen=True, eq=False)
class TrainedClassifier:
    """What training hands over.

    Args:
        onnx: the classifier's file, see :class:`shapewright.classification.Classifier`.
        exemplars: the geometric evidence that goes with it; ``None`` if the settings want none.
        class_names: in the order of the probabilities.
        metrics: figures of the training as JSON values: counts, accuracy on held-out variations and on
            variations of left-out models, accuracy of each class, confusion, loss, calibration error, curves.
        metadata: what the file says about itself.
    """

    onnx: bytes
    exemplars: Exemplars | None
    class_names: tuple[str, ...]
    metrics: dict[str, Any]
    metadata: dict[str, Any]

    @classmethod
    def read(cls, onnx: bytes, exemplars: Exemplars | None, *, where: str | None = None) -> "TrainedClassifier":
        """Return what an earlier training handed over, from its files.

        Args:
            onnx: content of the classifier's file.
            exemplars: that go with it.
            where: the name of the file, for errors.

        Raises:
            ClassifierError: the file is damaged or not one of ours; exemplars of another classifier.
        """
        try:
            loaded = Classifier(onnx, exemplars=exemplars, threads=1)
        except ClassifierError as error:
            raise ClassifierError(error.message, where=error.where or where) from error
        return cls(onnx, exemplars, loaded.class_names, loaded.metrics, loaded.metadata)

    @classmethod
    def load(cls, path: str | Path) -> "TrainedClassifier":
        """Return what an earlier training handed over, from its file and the exemplars that lie beside it.

        Raises:
            ClassifierError: as :meth:`read`, or a file is missing.
        """
        path = Path(path)
        try:
            onnx = path.read_bytes()
        except OSError as error:
            raise ClassifierError(f"cannot be read: {error.strerror}", where=path.name) from error
        beside = exemplars_file(path)
        return cls.read(onnx, Exemplars.load(beside) if beside.is_file() else None, where=path.name)


def train_classifier(
    classes: Mapping[str, Sequence[InstanceGenerator]],
    settings: TrainingSettings | None = None,
    progress: Progress = NULL_PROGRESS,
    *,
    negatives: Sequence[InstanceGenerator] = (),
    store: ArrayStore | None = None,
) -> TrainedClassifier:
    """Learn to tell classes apart from random variations of their procedural models alone.

    Args:
        classes: compiled models of each class; several models of a class share its variations.
        settings: 2000 variations of 5 pictures a class if not given.
        progress: hears of every block of variations and every epoch.
        negatives: compiled models of things that are none of the classes, for telling what is unknown.
        store: keeps features and descriptors for the next training, which computes only what is new; by default
            they are forgotten.

    Raises:
        ClassifierError: fewer than two classes, a class without models.
        RenderingError: no headless OpenGL.
        Cancelled: by ``progress``; what is in the store stays there.
    """
    settings = settings or TrainingSettings()
    plan = plan_learning(classes, negatives, settings)
    store = MemoryStore() if store is None else store
    draw_and_describe(plan, settings, store, PartialProgress(progress, 0.0, IMAGES_SHARE))
    return learn(plan, settings, store, PartialProgress(progress, IMAGES_SHARE, 1.0))


def draw_and_describe(
    plan: Plan,
    settings: TrainingSettings,
    store: ArrayStore,
    progress: Progress = NULL_PROGRESS,
    *,
    backbone: Backbone | None = None,
) -> None:
    """Fill the store with what a plan needs and the store lacks, chunk by chunk.

    Args:
        plan: what is needed.
        settings: how it is drawn.
        store: is filled.
        progress: hears of every block of variations; may cancel.
        backbone: what describes pictures; by default the one that the settings name.

    Raises:
        RenderingError: no headless OpenGL.
        Cancelled: by ``progress``; finished chunks stay in the store.
    """
    progress.report(0.0, "loading the backbone")
    backbone = load_backbone(settings.backbone) if backbone is None else backbone
    missing = [
        (chunk, described)
        for chunk, described in plan.chunks
        if not is_stored(chunk, settings, backbone, store, described)
    ]
    if not missing:
        return
    extractor = FeatureExtractor(backbone, threads=1)
    total = sum(chunk.count for chunk, _ in missing)
    done = 0
    for chunk, described in missing:
        part = PartialProgress(progress, done / total, (done + chunk.count) / total)
        store_chunk(chunk, settings, extractor, store, described=described, progress=part)
        done += chunk.count


def learn(
    plan: Plan, settings: TrainingSettings, store: ArrayStore, progress: Progress = NULL_PROGRESS
) -> TrainedClassifier:
    """Learn the head from a store that holds all that the plan needs.

    Raises:
        ClassifierError: something is missing in the store.
        Cancelled: by ``progress``.
    """
    backbone = load_backbone(settings.backbone)
    progress.report(0.0, "reading features")
    data = load_features(plan, settings, backbone, store)
    descriptors = exemplars = None
    if settings.exemplars and settings.vary:
        descriptors = load_descriptors(plan, settings, store)
        exemplars = exemplars_of(plan, descriptors, settings)
    head = train_head(data, settings, PartialProgress(progress, 0.05, 0.6))
    calibration = calibrate(
        plan,
        data,
        settings,
        descriptors=descriptors,
        exemplars=exemplars,
        progress=PartialProgress(progress, 0.6, 0.98),
    )
    head = replace(head, temperature=calibration.temperature)
    metrics = {**held_out_metrics(data, head, plan.class_names), **calibration.metrics}
    models = tuple(
        ModelReference(name=share.source.name, class_name=plan.class_names[share.label], digest=share.source.digest)
        for share in plan.shares
        if share.label < len(plan.class_names)
    )
    metadata = classifier_metadata(plan.class_names, models, backbone, settings, metrics, calibration)
    onnx = export_classifier(backbone, head, metadata)
    progress.report(1.0, f"{100 * metrics['held_out_accuracy']:.1f} % of held-out variations right")
    return TrainedClassifier(onnx, exemplars, plan.class_names, metrics, metadata)


def held_out_metrics(data: FeatureSet, head: Head, class_names: Sequence[str]) -> dict[str, Any]:
    """How well the held-out variations are told apart, as JSON values.

    They come from the same models as the learning pictures: a check of the learning, no forecast for real meshes.
    """
    meshes = data.held_out & (data.labels < data.class_count)
    rows = data.rows(meshes)
    probabilities = head.probabilities(data.features[rows])
    labels = data.row_labels(rows)
    truth = data.labels[meshes]
    guess = probabilities.reshape(len(truth), data.views, -1).mean(axis=1).argmax(axis=1)
    confusion = np.zeros((len(class_names), len(class_names)), dtype=np.int64)
    np.add.at(confusion, (truth, guess), 1)
    picture_right = probabilities.argmax(axis=1) == labels
    return {
        "images": len(data.features),
        "held_out_images": len(rows),
        "held_out_variations": len(truth),
        "held_out_accuracy": float((truth == guess).mean()),
        "held_out_image_accuracy": float(picture_right.mean()),
        "held_out_loss": float(-np.log(np.maximum(probabilities[np.arange(len(rows)), labels], 1e-12)).mean()),
        "calibration_error": calibration_error(probabilities.max(axis=1), picture_right),
        "temperature": head.temperature,
        "per_class": {name: float(confusion[i, i] / max(confusion[i].sum(), 1)) for i, name in enumerate(class_names)},
        "confusion": confusion.tolist(),
        "epochs": len(head.curves["train_loss"]),
        "best_epoch": head.best_epoch,
        "curves": head.curves,
    }
