"""Look at every mesh of a collection, once."""

import time
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import structlog

from models_store import catalog
from models_store.errors import ArtifactError, ArtifactNotFoundError
from shapewright.errors import Cancelled, ClassifierError, MeshError
from shapewright.progress import PartialProgress
from workers.context import JobContext, Outcome
from workers.stopping import WorkerStopping
from workers.stored.classifiers import LoadedClassifier, stored_classifier
from workers.stored.indexes import load_changing_index, load_index, store_index

if TYPE_CHECKING:
    from shapewright.mesh import PointCloud, TriangleMesh
    from shapewright.retrieval import CollectionIndex, SkippedMesh

log = structlog.get_logger(__name__)

KEEP_EVERY_S: Final = 60.0
"""A job that another worker has to take up again loses so much work."""
EARLIER_INDEXES: Final = 5
"""Indexes of other collections that are searched for meshes that the same classifier has looked at."""


def index_collection(context: JobContext) -> Outcome:
    """Index the meshes of the row that no earlier index and no interrupted attempt has; keep the whole."""
    identifier = str(context.claim.payload["collection_id"])
    with context.database.reading() as session:
        row = catalog.get_collection(session, identifier)
        earlier = catalog.index_keys(session, row.classifier_id, limit=EARLIER_INDEXES)
    context.progress.report(0.0, "reading the classifier")
    loaded = stored_classifier(context, row.classifier_id)
    part_key = f"collections/{identifier}-part.npz"
    known = _known(context, loaded, row.mesh_ids, part_key, earlier)
    index, skipped = _extended(context, loaded, known, row.mesh_ids, part_key)
    if not len(index):
        first = f"{skipped[0].name}: {skipped[0].reason}"
        raise MeshError(f"no mesh of the collection can be used ({first})", where="mesh_ids")
    key = context.own_key(f"collections/{identifier}", "npz")
    store_index(context, key, index)
    context.artifacts.delete(part_key)
    record = partial(
        catalog.record_collection,
        identifier=identifier,
        index_key=key,
        skipped=[{"mesh_id": one.name, "reason": one.reason} for one in skipped],
        seconds=context.seconds,
    )
    return Outcome(record, (key,))


def _known(
    context: JobContext, loaded: LoadedClassifier, mesh_ids: Sequence[str], part_key: str, earlier: Sequence[str]
) -> "CollectionIndex":
    """What is known about these meshes: from an attempt that was interrupted, and from other collections."""
    from shapewright.retrieval import CollectionIndex

    index = CollectionIndex.empty(loaded.classifier.class_names, loaded.digest)
    readers = [partial(load_changing_index, context, part_key)]
    readers += [partial(load_index, context, key) for key in earlier]
    for read in readers:
        if len(index) == len(mesh_ids):
            break
        try:
            found = read()
            found.check_fits(index.class_names, index.classifier_digest)
        except ArtifactNotFoundError:
            continue
        except (ClassifierError, ArtifactError, OSError) as error:
            log.warning("an earlier index is of no use", error=str(error))
            continue
        index = index.joined(found.taken(list(found.rows_of(mesh_ids).values())))
    return index


def _extended(
    context: JobContext, loaded: LoadedClassifier, index: "CollectionIndex", mesh_ids: Sequence[str], part_key: str
) -> "tuple[CollectionIndex, list[SkippedMesh]]":
    """Index the other meshes; now and then, and when this worker stops, what is done is kept."""
    from shapewright.retrieval.indexing import index_chunks

    here = index.rows_of(mesh_ids)
    new = [mesh_id for mesh_id in mesh_ids if mesh_id not in here]
    skipped: list[SkippedMesh] = []
    kept, kept_s = len(index), time.monotonic()

    def keep() -> None:
        try:
            store_index(context, part_key, index)
        except (ArtifactError, OSError) as error:  # the indexing itself needs no room yet
            log.warning("half an index could not be kept", error=str(error))

    try:
        for chunk in index_chunks(
            _meshes(context, new),
            loaded.classifier,
            loaded.digest,
            total=len(new),
            progress=PartialProgress(context.progress, 0.05, 1.0),
        ):
            index = index.joined(chunk.index)
            skipped.extend(chunk.skipped)
            if time.monotonic() - kept_s >= KEEP_EVERY_S:
                keep()
                kept, kept_s = len(index), time.monotonic()
    except WorkerStopping:
        if len(index) > kept:
            keep()
        raise
    except Cancelled:
        context.artifacts.delete(part_key)
        raise
    rows = index.rows_of(mesh_ids)
    return index.taken(list(rows.values())), skipped


def _meshes(context: JobContext, mesh_ids: Sequence[str]) -> "Iterator[tuple[str, TriangleMesh | PointCloud | str]]":
    for mesh_id in mesh_ids:
        try:
            yield mesh_id, context.load_query(mesh_id)
        except MeshError as error:
            yield mesh_id, str(error)
