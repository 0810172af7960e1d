"""The classifier's file: one ONNX model from pixels to probabilities that says where it comes from."""

import json
from dataclasses import dataclass
from typing import Any, Final

from shapewright.classification.file_format import FORMAT, FORMAT_VERSION, METADATA_KEY
from shapewright.network.backbone import Backbone
from shapewright.network.graphs import classifier_graph
from shapewright.training.calibration import Calibration
from shapewright.training.head import Head
from shapewright.training.settings import TrainingSettings

NORMALISATIONS: Final[dict[str, str]] = {
    "paper": "vertex mean to the origin, coordinates within [-1, 1]",
    "sphere": "middle of the bounding box to the origin, the farthest point at distance 1",
}


@dataclass(frozen=True)
class ModelReference:
    """A procedural model that a class was learned from.

    Args:
        name: the model's name.
        class_name: the class it stands for.
        digest: sha256 of its document.
    """

    name: str
    class_name: str
    digest: str


def classifier_metadata(
    class_names: tuple[str, ...],
    models: tuple[ModelReference, ...],
    backbone: Backbone,
    settings: TrainingSettings,
    metrics: dict[str, Any],
    calibration: Calibration,
) -> dict[str, Any]:
    """All that one has to know to use a classifier and to make it again, as JSON values."""
    return {
        "format": FORMAT,
        "version": FORMAT_VERSION,
        "class_names": list(class_names),
        "models": [{"name": m.name, "class": m.class_name, "digest": m.digest} for m in models],
        "backbone": {
            "name": backbone.name,
            "weights": backbone.weights,
            "weights_sha256": backbone.weights_sha256,
        },
        "preprocessing": f"in the graph: uint8 NHWC, {backbone.preprocessing}",
        "rendering": {**settings.look.to_dict(), "normalisation": NORMALISATIONS[settings.framing]},
        "known": {
            name: None if curve is None else curve.to_dict()
            for name, curve in (("pictures", calibration.pictures), ("geometry", calibration.geometry))
        },
        "usual_distances": None if calibration.usual_distances is None else list(calibration.usual_distances),
        "settings": settings.to_dict(),
        "metrics": metrics,
    }


def export_classifier(backbone: Backbone, head: Head, metadata: dict[str, Any]) -> bytes:
    """One ONNX file: ``images`` uint8 (N, H, W, 3) to ``probabilities`` (N, C), ``open_probabilities``, ``features``.

    Args:
        backbone: what the head was trained on.
        head: the last layers and their temperature.
        metadata: from :func:`classifier_metadata`; kept as JSON under the key ``shapewright``, the class names
            also under ``class_names`` for other readers.
    """
    model = classifier_graph(
        backbone.graph,
        [(layer.weight, layer.bias) for layer in head.layers],
        head.class_count,
        head.temperature,
        image_size=int(metadata["rendering"]["image_size"]),
        metadata={
            METADATA_KEY: json.dumps(metadata, sort_keys=True),
            "class_names": json.dumps(metadata["class_names"]),
        },
    )
    return bytes(model.SerializeToString())
