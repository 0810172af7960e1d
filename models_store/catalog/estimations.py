"""Estimations: a mesh, the model that shall rebuild it, and the parameter values found."""

from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.catalog.meshes import get_mesh, require_faces
from models_store.catalog.models import get_model, models_of_class
from models_store.catalog.rows import get_row
from models_store.errors import StoreError
from models_store.jobs import JobKind, create_job, new_id
from models_store.paging import Page, fetch_page
from models_store.tables import EstimationRow
from models_store.text import storable


def request_estimation(
    session: Session,
    mesh_id: str,
    model_id: str | None,
    settings: dict[str, Any],
    *,
    class_name: str | None = None,
    units: str | None = None,
    up: str | None = None,
    time_limit_s: float | None = None,
    now: datetime,
    max_attempts: int = 3,
) -> EstimationRow:
    """Queue an estimation; the row's ``job`` is the job.

    Args:
        session: a writing session.
        mesh_id: the query.
        model_id: the procedural model that shall rebuild it; ``None`` leaves the choice to the estimation.
        settings: fields of :class:`shapewright.estimation.EstimationSettings` that differ from the default.
        class_name: without a model, the class whose models (as they are now) are tried.
        units: unit of the mesh's coordinates, as :class:`shapewright.estimation.Query` has it.
        up: axis of the mesh's file that points up.
        time_limit_s: seconds after which the best answer until then is taken.
        now: the time, with a zone.
        max_attempts: of the job.

    Raises:
        NotFoundError: the mesh, the model or the class is not there.
        MeshError: the mesh is a point cloud.
        StoreError: neither a model nor a class, or both.
    """
    if (model_id is None) == (class_name is None):
        raise StoreError("an estimation is asked for with either a model or a class", where="model_id")
    get_mesh(session, mesh_id)
    require_faces(session, [mesh_id], "mesh_id")
    model_ids = None
    if model_id is not None:
        get_model(session, model_id)
    elif class_name is not None:
        model_ids = [model.id for model in models_of_class(session, class_name)]
    identifier = new_id()
    payload = {"estimation_id": identifier}
    row = EstimationRow(
        id=identifier,
        job=create_job(session, JobKind.ESTIMATE, identifier, payload, now=now, max_attempts=max_attempts),
        mesh_id=mesh_id,
        model_id=model_id,
        class_name=None if class_name is None else storable(class_name),
        model_ids=model_ids,
        units=units,
        up=up,
        time_limit_s=time_limit_s,
        settings=settings,
        created_at=now,
    )
    session.add(row)
    session.flush()
    return row


def record_estimation(
    session: Session,
    identifier: str,
    result: dict[str, Any],
    mesh_key: str | None,
    residuals_key: str | None = None,
) -> None:
    """Write the parameter values and which model they belong to; in the transaction that ends the job."""
    row = get_estimation(session, identifier)
    row.model_id = result["model"]["id"]
    row.result = result
    row.mesh_key = mesh_key
    row.residuals_key = residuals_key


def get_estimation(session: Session, identifier: str) -> EstimationRow:
    """The estimation with this id.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, EstimationRow, "estimation", identifier)


def list_estimations(session: Session, *, limit: int = 50, cursor: str | None = None) -> Page[EstimationRow]:
    """One page of estimations, newest first.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    return fetch_page(session, select(EstimationRow), EstimationRow, limit=limit, cursor=cursor)
