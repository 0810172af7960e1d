"""Classifiers out of the store."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from models_store import catalog
from workers.context import JobContext

if TYPE_CHECKING:
    from shapewright.classification import Classifier
    from shapewright.modeling import CompiledModel


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


_compiled: "Final[dict[str, CompiledModel]]" = {}
"""Models that were fitted last, by their ids."""
_MOST_COMPILED: Final = 16


class StoredModels(Mapping[str, "CompiledModel"]):
    """The models that a classifier learned from by their digests, which are their ids; compiled when asked for.

    Args:
        context: of the job.
        classifier_id: of the classifier.
    """

    def __init__(self, context: JobContext, classifier_id: str) -> None:
        self._context = context
        with context.database.reading() as session:
            self._ids = tuple(catalog.get_classifier(session, classifier_id).model_ids)

    def __getitem__(self, model_id: str) -> "CompiledModel":
        if model_id not in self._ids:
            raise KeyError(model_id)
        if model_id not in _compiled:
            from shapewright.modeling import compile_model

            while len(_compiled) >= _MOST_COMPILED:
                del _compiled[next(iter(_compiled))]
            _compiled[model_id] = compile_model(self._context.load_model(model_id))
        return _compiled[model_id]

    def __iter__(self) -> Iterator[str]:
        return iter(self._ids)

    def __len__(self) -> int:
        return len(self._ids)
