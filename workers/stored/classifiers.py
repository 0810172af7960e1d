"""Classifiers as artefacts: one ONNX file each, and exemplars beside it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from models_store import catalog
from workers.context import JobContext
from workers.stored.saving import saved_bytes

if TYPE_CHECKING:
    from shapewright.classification import Classifier
    from shapewright.training import TrainedClassifier


@dataclass(frozen=True, eq=False)
class LoadedClassifier:
    """A classifier with its exemplars, and the SHA-256 of its files: what it says depends on both."""

    classifier: "Classifier"
    digest: str


@dataclass(frozen=True)
class ClassifierKeys:
    """Where the files of a classifier are stored; ``exemplars`` is ``None`` if it has none."""

    onnx: str
    exemplars: str | None

    @property
    def all(self) -> tuple[str, ...]:
        """The keys that there are."""
        return (self.onnx,) if self.exemplars is None else (self.onnx, self.exemplars)


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


def stored_base(context: JobContext, classifier_id: str) -> "TrainedClassifier":
    """Load a classifier that is to be extended.

    Raises:
        NotFoundError: it is not there.
        ClassifierError: its file is damaged.
        ArtifactError: its file cannot be read.
    """
    from shapewright.classification import Exemplars
    from shapewright.training import TrainedClassifier

    with context.database.reading() as session:
        row = catalog.get_classifier(session, classifier_id)
    exemplars = None
    if row.exemplars_key is not None:
        exemplars = Exemplars.load(context.artifacts.local_copy(row.exemplars_key, context.settings.data_dir / "cache"))
    return TrainedClassifier.read(context.artifacts.get(str(row.onnx_key)), exemplars)


def store_classifier(context: JobContext, classifier_id: str, trained: "TrainedClassifier") -> ClassifierKeys:
    """Write the files of a classifier that was trained now.

    Raises:
        ArtifactError: there is no room for them.
    """
    exemplars_key = None
    if trained.exemplars is not None:
        exemplars_key = context.own_key(f"classifiers/{classifier_id}", "npz")
        context.artifacts.put(exemplars_key, saved_bytes(trained.exemplars.save))
    onnx_key = context.own_key(f"classifiers/{classifier_id}", "onnx")
    context.artifacts.put(onnx_key, trained.onnx)
    return ClassifierKeys(onnx_key, exemplars_key)
