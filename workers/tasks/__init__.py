"""The work itself, one file a kind of job. A task takes a context and returns its outcome."""

from collections.abc import Callable, Mapping
from typing import Final

from models_store.job_kinds import JobKind
from workers.context import JobContext, Outcome
from workers.tasks.classify import classify
from workers.tasks.describe_variations import describe_variations
from workers.tasks.estimate import estimate
from workers.tasks.estimate_collection import estimate_collection
from workers.tasks.estimate_meshes import estimate_meshes
from workers.tasks.index_collection import index_collection
from workers.tasks.render_thumbnail import render_thumbnail
from workers.tasks.retrieve import retrieve
from workers.tasks.train_classifier import train_classifier

TASKS: Final[Mapping[JobKind, Callable[[JobContext], Outcome]]] = {
    JobKind.TRAIN_CLASSIFIER: train_classifier,
    JobKind.DESCRIBE_VARIATIONS: describe_variations,
    JobKind.CLASSIFY: classify,
    JobKind.ESTIMATE: estimate,
    JobKind.ESTIMATE_COLLECTION: estimate_collection,
    JobKind.ESTIMATE_MESHES: estimate_meshes,
    JobKind.RENDER_THUMBNAIL: render_thumbnail,
    JobKind.INDEX_COLLECTION: index_collection,
    JobKind.RETRIEVE: retrieve,
}
