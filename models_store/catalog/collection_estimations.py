"""Estimations of many meshes as one job, which fills in one row for each mesh."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from models_store.catalog.collections import get_collection
from models_store.catalog.meshes import mesh_names, require_faces
from models_store.catalog.models import get_model, models_of_class
from models_store.catalog.rows import get_row
from models_store.errors import StoreError
from models_store.jobs import JobKind, create_job, new_id
from models_store.paging import Page, fetch_page
from models_store.tables import CollectionEstimationRow, EstimatedMeshRow
from models_store.text import storable


@dataclass(frozen=True)
class DoneCounts:
    """How many meshes have a row, and how many of those say why nothing could be estimated."""

    done: int = 0
    failed: int = 0


def request_collection_estimation(
    session: Session,
    settings: dict[str, Any],
    *,
    collection_id: str | None = None,
    mesh_ids: Sequence[str] | None = None,
    model_id: str | None = None,
    class_name: str | None = None,
    units: str | None = None,
    up: str | None = None,
    time_limit_s: float | None = None,
    now: datetime,
    max_attempts: int = 3,
) -> CollectionEstimationRow:
    """Queue the estimation of many meshes; the row's ``job`` is the job.

    Args:
        session: a writing session.
        settings: fields of :class:`shapewright.estimation.EstimationSettings` that differ from the default.
        collection_id: whose meshes are estimated, whether it is indexed or not. The rows of point clouds among them
            say that these have no surface.
        mesh_ids: the meshes, without a collection. Repeated ids count once.
        model_id: the procedural model that rebuilds them.
        class_name: without a model, the class whose models (as they are now) are tried for each mesh.
        units: unit of the meshes' coordinates, as :class:`shapewright.estimation.Query` has it.
        up: axis of the meshes' files that points up.
        time_limit_s: seconds after which a mesh has the best answer until then.
        now: the time, with a zone.
        max_attempts: of the job.

    Raises:
        NotFoundError: the collection, a mesh, the model or the class is not there.
        MeshError: one of ``mesh_ids`` is a point cloud.
        StoreError: neither a collection nor meshes, neither a model nor a class, or both.
    """
    if (collection_id is None) == (mesh_ids is None):
        raise StoreError("expected either a collection or meshes", where="collection_id")
    if (model_id is None) == (class_name is None):
        raise StoreError("expected either a model or a class", where="model_id")
    if collection_id is not None:
        wanted = get_collection(session, collection_id).mesh_ids
    else:
        wanted = list(dict.fromkeys(mesh_ids or ()))
        if not wanted:
            raise StoreError("expected at least one mesh", where="mesh_ids")
        mesh_names(session, wanted)
        require_faces(session, list(mesh_ids or ()), "mesh_ids[{}]")
    if model_id is not None:
        model_ids = [get_model(session, model_id).id]
    else:
        model_ids = [model.id for model in models_of_class(session, str(class_name))]
    identifier = new_id()
    payload = {"collection_estimation_id": identifier}
    kind = JobKind.ESTIMATE_COLLECTION
    row = CollectionEstimationRow(
        id=identifier,
        job=create_job(session, kind, identifier, payload, now=now, max_attempts=max_attempts),
        collection_id=collection_id,
        mesh_ids=wanted,
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


def get_collection_estimation(session: Session, identifier: str) -> CollectionEstimationRow:
    """The estimation of a collection with this id.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, CollectionEstimationRow, "collection estimation", identifier)


def list_collection_estimations(
    session: Session, *, limit: int = 50, cursor: str | None = None
) -> Page[CollectionEstimationRow]:
    """One page of estimations of collections, newest first.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    return fetch_page(session, select(CollectionEstimationRow), CollectionEstimationRow, limit=limit, cursor=cursor)


def count_estimated(session: Session, identifiers: Iterable[str]) -> dict[str, DoneCounts]:
    """How far each of these estimations of collections is."""
    wanted = list(identifiers)
    identifier = EstimatedMeshRow.estimation_id
    counts = select(identifier, func.count(), func.count(EstimatedMeshRow.error))
    found = session.execute(counts.where(identifier.in_(wanted)).group_by(identifier)).all()
    return dict.fromkeys(wanted, DoneCounts()) | {row[0]: DoneCounts(row[1], row[2]) for row in found}
