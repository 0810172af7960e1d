"""One part of a training: draw and describe a chunk of variations of one model, for the worker that trains."""

from typing import TYPE_CHECKING

from shapewright.errors import ClassifierError
from workers.context import JobContext, Outcome
from workers.helping import Helping
from workers.learning_plans import learning_plan
from workers.stored.arrays import ArtifactArrays

if TYPE_CHECKING:
    from sqlalchemy.orm import Session


def describe_variations(context: JobContext) -> Outcome:
    """Leave the features, and the descriptors if wanted, where the training looks for them."""
    from shapewright.training.chunks import descriptors_key, features_key, store_chunk

    helping = Helping(context)
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
