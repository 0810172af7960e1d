"""Learning classes from rendered variations of procedural models (paper section 3.2).

Names are loaded when first used: :func:`train_classifier` needs torch, settings and stores do not.
"""

from typing import TYPE_CHECKING

from shapewright.lazy_names import lazy_names

if TYPE_CHECKING:
    from shapewright.training.array_store import ArrayStore, FolderStore, MemoryStore
    from shapewright.training.extending import extend_classifier
    from shapewright.training.extension_settings import ExtensionSettings
    from shapewright.training.learning import TrainedClassifier, train_classifier
    from shapewright.training.settings import TrainingSettings

_HOMES = {
    "ArrayStore": "array_store",
    "ExtensionSettings": "extension_settings",
    "FolderStore": "array_store",
    "MemoryStore": "array_store",
    "TrainedClassifier": "learning",
    "TrainingSettings": "settings",
    "extend_classifier": "extending",
    "train_classifier": "learning",
}

__all__ = [
    "ArrayStore",
    "ExtensionSettings",
    "FolderStore",
    "MemoryStore",
    "TrainedClassifier",
    "TrainingSettings",
    "extend_classifier",
    "train_classifier",
]

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
