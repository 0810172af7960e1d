"""Learning classes from rendered variations and classifying meshes (paper section 3.2).

Names are loaded when first used: :class:`Classifier` needs ONNX Runtime, only training needs torch.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from shapewright.classification.array_store import ArrayStore, FolderStore, MemoryStore
    from shapewright.classification.class_instances import gather_instances, instances_of_each
    from shapewright.classification.classifier import (
        Classification,
        Classifier,
        exemplars_file,
        files_digest,
        load_classifier,
    )
    from shapewright.classification.evidence import UNKNOWN
    from shapewright.classification.exemplars import Exemplars
    from shapewright.classification.settings import TrainingSettings
    from shapewright.classification.training import TrainedClassifier, train_classifier

_HOMES = {
    "ArrayStore": "array_store",
    "Classification": "classifier",
    "Classifier": "classifier",
    "Exemplars": "exemplars",
    "FolderStore": "array_store",
    "MemoryStore": "array_store",
    "TrainedClassifier": "training",
    "TrainingSettings": "settings",
    "UNKNOWN": "evidence",
    "exemplars_file": "classifier",
    "files_digest": "classifier",
    "gather_instances": "class_instances",
    "instances_of_each": "class_instances",
    "load_classifier": "classifier",
    "train_classifier": "training",
}

__all__ = [
    "UNKNOWN",
    "ArrayStore",
    "Classification",
    "Classifier",
    "Exemplars",
    "FolderStore",
    "MemoryStore",
    "TrainedClassifier",
    "TrainingSettings",
    "exemplars_file",
    "files_digest",
    "gather_instances",
    "instances_of_each",
    "load_classifier",
    "train_classifier",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
