"""From procedural models to a classifier: draw, describe, learn, export (paper section 3.2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from shapewright.classification.backbone import load_backbone
from shapewright.classification.dataset import FeatureSet, InstanceGenerator, class_features, join_classes
from shapewright.classification.export import ModelReference, classifier_metadata, export_classifier
from shapewright.classification.features import FeatureExtractor
from shapewright.classification.head import Head, train_head
from shapewright.classification.settings import TrainingSettings
from shapewright.errors import ClassifierError
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress

IMAGES_SHARE = 0.92
"""Share of the work that drawing and describing takes, for the progress shown."""


@dataclass(frozen=True, eq=False)
class TrainedClassifier:
    """What training hands over.

    Args:
        onnx: the classifier's file, see :class:`shapewright.classification.Classifier`.
        class_names: in the order of the probabilities.
        metrics: figures of the training as JSON values: counts, held-out accuracy of pictures and of variations
            (pictures averaged), accuracy of each class, confusion, loss, calibration error, curves.
        metadata: what the file says about itself.
    """

    onnx: bytes
    class_names: tuple[str, ...]
    metrics: dict[str, Any]
    metadata: dict[str, Any]


def train_classifier(
    classes: Mapping[str, Sequence[InstanceGenerator]],
    settings: TrainingSettings | None = None,
    progress: Progress = NULL_PROGRESS,
) -> TrainedClassifier:
    """Learn to tell classes apart from random variations of their procedural models alone.

    Args:
        classes: compiled models of each class; several models of a class share its variations.
        settings: the paper's by default (1000 variations of 10 pictures a class).
        progress: hears of every block of variations and every epoch.

    Raises:
        ClassifierError: fewer than two classes, a class without models.
        RenderingError: no headless OpenGL.
        Cancelled: by ``progress``; nothing is kept.
    """
    settings = settings or TrainingSettings()
    class_names = tuple(classes)
    if len(class_names) < 2:
        raise ClassifierError("a classifier tells at least two classes apart", where="classes")
    for name, generators in classes.items():
        if not generators:
            raise ClassifierError("the class has no models", where=f"classes.{name}")
        if len(generators) > settings.variations:
            raise ClassifierError("the class has more models than variations", where=f"classes.{name}")
    progress.report(0.0, "loading the backbone")
    backbone = load_backbone(settings.backbone)
    extractor = FeatureExtractor(backbone)
    features = []
    for number, name in enumerate(class_names):
        start, end = (IMAGES_SHARE * step / len(class_names) for step in (number, number + 1))
        part = PartialProgress(progress, start, end)
        features.append(class_features(classes[name], settings, extractor, part))
    data = join_classes(features, settings)
    del features
    head = train_head(data, len(class_names), settings, PartialProgress(progress, IMAGES_SHARE, 0.99))
    metrics = held_out_metrics(data, head, class_names)
    models = tuple(
        ModelReference(name=generator.model.name, class_name=name, digest=generator.model.digest)
        for name in class_names
        for generator in classes[name]
    )
    metadata = classifier_metadata(class_names, models, backbone, settings, metrics)
    onnx = export_classifier(backbone, head, metadata)
    progress.report(1.0, f"{100 * metrics['held_out_accuracy']:.1f} % of held-out variations right")
    return TrainedClassifier(onnx=onnx, class_names=class_names, metrics=metrics, metadata=metadata)


def held_out_metrics(data: FeatureSet, head: Head, class_names: Sequence[str]) -> dict[str, Any]:
    """How well the held-out variations are told apart, as JSON values.

    They come from the same models as the learning pictures: a check of the learning, no forecast for real meshes.
    """
    rows = np.flatnonzero(data.held_out)
    probabilities = head.probabilities(data.features[rows])
    labels = data.labels[rows]
    _, first, number = np.unique(data.variations[rows], return_index=True, return_inverse=True)
    averaged = np.zeros((len(first), len(class_names)))
    np.add.at(averaged, number, probabilities)
    truth, guess = labels[first], averaged.argmax(axis=1)
    confusion = np.zeros((len(class_names), len(class_names)), dtype=np.int64)
    np.add.at(confusion, (truth, guess), 1)
    picture_right = probabilities.argmax(axis=1) == labels
    return {
        "images": len(data.labels),
        "held_out_images": len(rows),
        "held_out_variations": len(first),
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


def calibration_error(
    confidence: Float[np.ndarray, " N"], right: Int[np.ndarray, " N"] | np.ndarray, bins: int = 15
) -> float:
    """Expected calibration error: mean gap between confidence and accuracy over equal bins (Guo et al. 2017)."""
    slot = np.minimum((confidence * bins).astype(np.int64), bins - 1)
    gaps = [
        abs(float(confidence[slot == i].mean()) - float(right[slot == i].mean())) * float((slot == i).mean())
        for i in np.unique(slot)
    ]
    return float(sum(gaps))
