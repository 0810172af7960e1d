"""The models of a classifier out of the store, compiled."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final

from models_store import catalog
from workers.context import JobContext

if TYPE_CHECKING:
    from shapewright.modeling import CompiledModel

_compiled: "Final[dict[str, CompiledModel]]" = {}
"""Models that were fitted last, by their ids."""
_MOST_COMPILED: Final = 16


class StoredModels(Mapping[str, "CompiledModel"]):
    """The models that a classifier learned from by their digests, which are their ids; compiled when asked for.

    Models that are not in the catalog are left out: the ready classifier may have learned from others.

    Args:
        context: of the job.
        classifier_id: of the classifier.
    """

    def __init__(self, context: JobContext, classifier_id: str) -> None:
        self._context = context
        with context.database.reading() as session:
            learned_from = catalog.get_classifier(session, classifier_id).model_ids
            self._ids = tuple(row.id for row in catalog.known_models(session, learned_from))

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
