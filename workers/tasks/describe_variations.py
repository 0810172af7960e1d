"""One part of a training: draw and describe a chunk of variations of one model, for the worker that trains."""

from typing import TYPE_CHECKING

from models_store import claims
from models_store.session import OUTAGES
from shapewright.errors import ClassifierError
from workers.context import JobContext, Outcome, utc_now
from workers.learning_plans import learning_plan
from workers.stopping import GivingWay
from workers.stored.arrays import ArtifactArrays

if TYPE_CHECKING:
    from sqlalchemy.orm import Session


class _Helping:
    """Progress of work that can wait (:class:`shapewright.progress.Progress`)."""

    def __init__(self, context: JobContext) -> None:
        self._context = context

    def report(self, fraction: float, message: str) -> None:
        """Note the progress, and stop when others want this worker.

        Raises:
            GivingWay: somebody's own job waits.
        """
        self._context.progress.report(fraction, message)
        try:
            with self._context.database.reading() as session:
                gives_way = claims.must_give_way(session, now=utc_now())
        except OUTAGES:  # the heartbeat tells of it
            return
        if gives_way:
            raise GivingWay


def describe_variations(context: JobContext) -> Outcome:
    """Leave the features, and the descriptors if wanted, where the training looks for them."""
    from shapewright.classification.chunks import descriptors_key, features_key, store_chunk

    helping = _Helping(context)
    work = learning_plan(context, str(context.claim.payload["classifier_id"]), helping)
    chunk, described = work.plan.chunks[int(context.claim.payload["chunk"])]
    store = ArtifactArrays.of(context)
    store_chunk(chunk, work.settings, work.extractor, store, described=described, progress=helping)
    keys = [features_key(chunk, work.settings, work.extractor.backbone)]
    if described:
        keys.append(descriptors_key(chunk, work.settings))
    for key in keys:
        if not context.artifacts.exists(key):
            raise ClassifierError("what was computed could not be stored", where=key)
    return Outcome(_nothing)


def _nothing(session: "Session") -> None:
    """The arrays are the result; there is no row to write."""
