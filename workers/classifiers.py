"""Classifiers out of the store."""

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from models_store import catalog
from workers.context import JobContext

if TYPE_CHECKING:
    from shapewright.classification import Classifier


@dataclass(frozen=True, eq=False)
class LoadedClassifier:
    """A classifier and the SHA-256 of its file."""

    classifier: "Classifier"
    digest: str


_kept: Final[dict[str, LoadedClassifier]] = {}
"""The classifier of the last job by its key, as most jobs ask the same one; keys never change their content."""


def stored_classifier(context: JobContext, classifier_id: str) -> LoadedClassifier:
    """Load a classifier that is trained.

    Raises:
        ClassifierError: its file is damaged.
        ArtifactError: its file cannot be read.
    """
    from shapewright.classification import Classifier

    with context.database.reading() as session:
        key = str(catalog.get_classifier(session, classifier_id).onnx_key)
    if key not in _kept:
        content = context.artifacts.get(key)
        _kept.clear()
        _kept[key] = LoadedClassifier(Classifier(content), hashlib.sha256(content).hexdigest())
    return _kept[key]
