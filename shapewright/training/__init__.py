"""Learning classes from rendered variations of procedural models (paper section 3.2).

Names are loaded when first used: :func:`train_classifier` needs torch, settings and stores do not.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from shapewright.training.array_store import ArrayStore, FolderStore, MemoryStore
    from shapewright.training.learning import TrainedClassifier, train_classifier
    from shapewright.training.settings import TrainingSettings

_HOMES = {
    "ArrayStore": "array_store",
    "FolderStore": "array_store",
    "MemoryStore": "array_store",
    "TrainedClassifier": "learning",
    "TrainingSettings": "settings",
    "train_classifier": "learning",
}

__all__ = [
    "ArrayStore",
    "FolderStore",
    "MemoryStore",
    "TrainedClassifier",
    "TrainingSettings",
    "train_classifier",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
