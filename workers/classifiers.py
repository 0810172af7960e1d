"""Classifiers out of the store."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from models_store import catalog
from workers.context import JobContext

if TYPE_CHECKING:
    from shapewright.classification import Classifier


@dataclass(frozen=True, eq=False)
class LoadedClassifier:
    """A classifier with its exemplars, and the SHA-256 of its files: what it says depends on both."""

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
    from shapewright.classification import Classifier, Exemplars, files_digest

    with context.database.reading() as session:
        row = catalog.get_classifier(session, classifier_id)
        key, exemplars_key = str(row.onnx_key), row.exemplars_key
    if key not in _kept:
        content = context.artifacts.get(key)
        path = exemplars = None
        if exemplars_key is not None:
            path = context.artifacts.local_copy(exemplars_key, context.settings.data_dir / "cache")
            exemplars = Exemplars.load(path)
        _kept.clear()
        _kept[key] = LoadedClassifier(Classifier(content, exemplars=exemplars), files_digest(content, path))
    return _kept[key]
