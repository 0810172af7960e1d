"""Learning classes from rendered variations, classifying meshes and finding them (paper sections 3.2 and 4.2).

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
    from shapewright.classification.collection_index import CollectionIndex
    from shapewright.classification.evidence import UNKNOWN
    from shapewright.classification.exemplars import Exemplars
    from shapewright.classification.indexing import Indexed, SkippedMesh, index_meshes, look_at
    from shapewright.classification.retrieval import ClassQuery, MeshQuery, RankedMesh, rank
    from shapewright.classification.settings import TrainingSettings
    from shapewright.classification.training import TrainedClassifier, train_classifier

_HOMES = {
    "ArrayStore": "array_store",
    "ClassQuery": "retrieval",
    "Classification": "classifier",
    "Classifier": "classifier",
    "CollectionIndex": "collection_index",
    "Exemplars": "exemplars",
    "FolderStore": "array_store",
    "Indexed": "indexing",
    "MemoryStore": "array_store",
    "MeshQuery": "retrieval",
    "RankedMesh": "retrieval",
    "SkippedMesh": "indexing",
    "TrainedClassifier": "training",
    "TrainingSettings": "settings",
    "UNKNOWN": "evidence",
    "exemplars_file": "classifier",
    "files_digest": "classifier",
    "gather_instances": "class_instances",
    "instances_of_each": "class_instances",
    "index_meshes": "indexing",
    "load_classifier": "classifier",
    "look_at": "indexing",
    "rank": "retrieval",
    "train_classifier": "training",
}

__all__ = [
    "UNKNOWN",
    "ArrayStore",
    "ClassQuery",
    "Classification",
    "Classifier",
    "CollectionIndex",
    "Exemplars",
    "FolderStore",
    "Indexed",
    "MemoryStore",
    "MeshQuery",
    "RankedMesh",
    "SkippedMesh",
    "TrainedClassifier",
    "TrainingSettings",
    "exemplars_file",
    "files_digest",
    "gather_instances",
    "index_meshes",
    "instances_of_each",
    "load_classifier",
    "look_at",
    "rank",
    "train_classifier",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
