"""Retrievals: a collection, a query, and the meshes in the order of their likeness to it."""

from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.catalog.classifiers import get_classifier
from models_store.catalog.collections import get_collection
from models_store.catalog.meshes import get_mesh
from models_store.catalog.models import get_model
from models_store.catalog.rows import get_row
from models_store.errors import NotReadyError, StoreError
from models_store.jobs import JobKind, create_job, new_id
from models_store.paging import Page, fetch_page
from models_store.tables import CollectionRow, RetrievalRow


def request_retrieval(
    session: Session,
    collection_id: str,
    settings: dict[str, Any],
    *,
    class_name: str | None = None,
    model_id: str | None = None,
    mesh_id: str | None = None,
    now: datetime,
    max_attempts: int = 3,
) -> RetrievalRow:
    """Queue a retrieval; the row's ``job`` is the job.

    Args:
        session: a writing session.
        collection_id: what is looked through.
        settings: ``evidence``, ``limit``, ``instances`` and ``seed``.
        class_name: find meshes of this class, one of the classifier's,
        model_id: or meshes like instances of this model,
        mesh_id: or meshes like this one.
        now: the time, with a zone.
        max_attempts: of the job.

    Raises:
        NotFoundError: the collection, the model or the mesh is not there.
        NotReadyError: the collection has no index.
        StoreError: not exactly one query, or a class that the classifier does not know.
    """
    if sum(query is not None for query in (class_name, model_id, mesh_id)) != 1:
        raise StoreError("a retrieval is asked for with one of a class, a model and a mesh", where="class_name")
    collection = get_collection(session, collection_id)
    if collection.index_key is None:
        state = collection.job.state.value
        raise NotReadyError(f"this collection has no index (its job is {state})", where="collection_id")
    if class_name is not None:
        _check_class(session, collection, class_name, where="class_name")
    elif model_id is not None:
        model = get_model(session, model_id)
        if settings.get("evidence") != "panorama":
            _check_class(session, collection, model.class_name, where="model_id")
    elif mesh_id is not None:
        get_mesh(session, mesh_id)
    identifier = new_id()
    payload = {"retrieval_id": identifier}
    row = RetrievalRow(
        id=identifier,
        job=create_job(session, JobKind.RETRIEVE, identifier, payload, now=now, max_attempts=max_attempts),
        collection_id=collection_id,
        class_name=class_name,
        model_id=model_id,
        mesh_id=mesh_id,
        settings=settings,
        created_at=now,
    )
    session.add(row)
    session.flush()
    return row


def _check_class(session: Session, collection: CollectionRow, class_name: str, *, where: str) -> None:
    known = get_classifier(session, collection.classifier_id).class_names
    if class_name not in known:
        names = ", ".join(known)
        detail = f"the classifier of this collection does not know the class {class_name!r} (but: {names})"
        raise StoreError(detail, where=where)


def record_retrieval(session: Session, identifier: str, result: dict[str, Any], sheet_key: str | None) -> None:
    """Write what was found; in the transaction that ends the job."""
    row = get_retrieval(session, identifier)
    row.result = result
    row.sheet_key = sheet_key


def get_retrieval(session: Session, identifier: str) -> RetrievalRow:
    """The retrieval with this id.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, RetrievalRow, "retrieval", identifier)


def list_retrievals(session: Session, *, limit: int = 50, cursor: str | None = None) -> Page[RetrievalRow]:
    """One page of retrievals, newest first.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    return fetch_page(session, select(RetrievalRow), RetrievalRow, limit=limit, cursor=cursor)
