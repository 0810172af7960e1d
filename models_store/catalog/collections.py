"""Collections: meshes that are looked through together, and the index that a job makes of them."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.catalog.classifiers import ready_classifier
from models_store.catalog.meshes import mesh_names
from models_store.catalog.rows import get_row
from models_store.errors import StoreError
from models_store.jobs import JobKind, create_job, new_id
from models_store.paging import Page, fetch_page
from models_store.tables import CollectionRow
from models_store.text import storable


def request_collection(
    session: Session,
    mesh_ids: Sequence[str],
    classifier_id: str | None,
    *,
    name: str | None = None,
    now: datetime,
    max_attempts: int = 3,
) -> CollectionRow:
    """Queue the indexing of meshes; the row's ``job`` is the job.

    Args:
        session: a writing session.
        mesh_ids: the meshes. Repeated ids count once.
        classifier_id: which classifier looks at them; ``None`` is the one that ships, or without it the newest.
        name: a name for people.
        now: the time, with a zone.
        max_attempts: of the job.

    Raises:
        NotFoundError: a mesh or the classifier is not there.
        NotReadyError: the classifier is not trained yet, or there is none.
        StoreError: no meshes.
    """
    unique_ids = list(dict.fromkeys(mesh_ids))
    if not unique_ids:
        raise StoreError("a collection needs at least one mesh", where="mesh_ids")
    mesh_names(session, unique_ids)
    classifier = ready_classifier(session, classifier_id)
    identifier = new_id()
    payload = {"collection_id": identifier}
    row = CollectionRow(
        id=identifier,
        job=create_job(session, JobKind.INDEX_COLLECTION, identifier, payload, now=now, max_attempts=max_attempts),
        name=None if name is None else storable(name, limit=200),
        mesh_ids=unique_ids,
        classifier_id=classifier.id,
        created_at=now,
    )
    session.add(row)
    session.flush()
    return row


def record_collection(
    session: Session, identifier: str, *, index_key: str, skipped: list[dict[str, Any]], seconds: float
) -> None:
    """Write the outcome of an indexing; in the transaction that ends the job."""
    row = get_collection(session, identifier)
    row.index_key = index_key
    row.skipped = skipped
    row.seconds = seconds


def get_collection(session: Session, identifier: str) -> CollectionRow:
    """The collection with this id, whatever its state.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, CollectionRow, "collection", identifier)


def index_keys(session: Session, classifier_id: str, *, limit: int) -> list[str]:
    """Where the newest indexes are that this classifier made."""
    made = (CollectionRow.classifier_id == classifier_id, CollectionRow.index_key.is_not(None))
    order = (CollectionRow.created_at.desc(), CollectionRow.id.desc())
    found = session.scalars(select(CollectionRow.index_key).where(*made).order_by(*order).limit(limit))
    return [key for key in found if key is not None]


def list_collections(session: Session, *, limit: int = 50, cursor: str | None = None) -> Page[CollectionRow]:
    """One page of collections, newest first.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    return fetch_page(session, select(CollectionRow), CollectionRow, limit=limit, cursor=cursor)
