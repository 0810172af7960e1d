"""Classifications: a mesh, the classifier that is asked, and its answer."""

from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.catalog.classifiers import ready_classifier
from models_store.catalog.meshes import get_mesh
from models_store.catalog.rows import get_row
from models_store.jobs import JobKind, create_job, new_id
from models_store.paging import Page, fetch_page
from models_store.tables import ClassificationRow


def request_classification(
    session: Session,
    mesh_id: str,
    classifier_id: str | None,
    settings: dict[str, Any],
    *,
    now: datetime,
    max_attempts: int = 3,
) -> ClassificationRow:
    """Queue a classification; the row's ``job`` is the job.

    Args:
        session: a writing session.
        mesh_id: the query.
        classifier_id: which classifier to ask; ``None`` is the one that ships, or without it the newest.
        settings: ``views`` (count of rendered views), ``seed`` and ``fit`` (whether classes are fitted).
        now: the time, with a zone.
        max_attempts: of the job.

    Raises:
        NotFoundError: the mesh or the classifier is not there.
        NotReadyError: the classifier is not trained yet, or there is none.
    """
    get_mesh(session, mesh_id)
    classifier = ready_classifier(session, classifier_id)
    identifier = new_id()
    payload = {"classification_id": identifier}
    row = ClassificationRow(
        id=identifier,
        job=create_job(session, JobKind.CLASSIFY, identifier, payload, now=now, max_attempts=max_attempts),
        mesh_id=mesh_id,
        classifier_id=classifier.id,
        settings=settings,
        created_at=now,
    )
    session.add(row)
    session.flush()
    return row


def record_classification(
    session: Session, identifier: str, result: dict[str, Any], *, pictures_key: str | None = None
) -> None:
    """Write the answer; in the transaction that ends the job."""
    row = get_classification(session, identifier)
    row.result = result
    row.pictures_key = pictures_key


def get_classification(session: Session, identifier: str) -> ClassificationRow:
    """The classification with this id.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, ClassificationRow, "classification", identifier)


def list_classifications(session: Session, *, limit: int = 50, cursor: str | None = None) -> Page[ClassificationRow]:
    """One page of classifications, newest first.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    return fetch_page(session, select(ClassificationRow), ClassificationRow, limit=limit, cursor=cursor)
