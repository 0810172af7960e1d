"""Learning classes from rendered variations and classifying meshes (paper section 3.2).

Names are loaded when first used: :class:`Classifier` needs ONNX Runtime, only training needs torch.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from shapewright.classification.backbone import BACKBONES, Backbone, load_backbone
    from shapewright.classification.classifier import Classification, Classifier
    from shapewright.classification.dataset import InstanceGenerator
    from shapewright.classification.features import FeatureExtractor
    from shapewright.classification.settings import TrainingSettings
    from shapewright.classification.training import TrainedClassifier, train_classifier

_HOMES = {
    "BACKBONES": "backbone",
    "Backbone": "backbone",
    "Classification": "classifier",
    "Classifier": "classifier",
    "FeatureExtractor": "features",
    "InstanceGenerator": "dataset",
    "TrainedClassifier": "training",
    "TrainingSettings": "settings",
    "load_backbone": "backbone",
    "train_classifier": "training",
}

__all__ = [
    "BACKBONES",
    "Backbone",
    "Classification",
    "Classifier",
    "FeatureExtractor",
    "InstanceGenerator",
    "TrainedClassifier",
    "TrainingSettings",
    "load_backbone",
    "train_classifier",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
