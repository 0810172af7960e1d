"""Procedural models: content-addressed, immutable, with a thumbnail that a job draws."""

import json
from datetime import datetime
from typing import TYPE_CHECKING

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.catalog.rows import get_row, insert_once
from models_store.jobs import JobKind, create_job
from models_store.paging import Page, fetch_page
from models_store.tables import JobRow, ModelRow
from models_store.text import storable

if TYPE_CHECKING:
    from shapewright.modeling import ProceduralModel


def add_model(session: Session, model: "ProceduralModel", *, now: datetime) -> tuple[ModelRow, bool]:
    """Add a model. Returns its row, and whether it is new; the same document twice is one model."""
    document = model.to_json()
    row = ModelRow(
        id=model.digest,
        name=storable(model.name),
        class_name=storable(model.class_name),
        description=storable(model.description),
        closed=model.closed,
        format_version=int(json.loads(document)["version"]),
        operation_count=len(model.operations),
        parameters=[
            {
                "name": storable(parameter.name),
                "label": storable(parameter.label),
                "unit": None if parameter.unit is None else storable(parameter.unit),
                "base_value": parameter.base_value,
                "minimum": parameter.minimum,
                "maximum": parameter.maximum,
                "default": 1.0,
            }
            for parameter in model.parameters
        ],
        document=document,
        created_at=now,
    )
    return insert_once(session, row)


def get_model(session: Session, model_id: str) -> ModelRow:
    """The model with this id.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, ModelRow, "model", model_id)


def list_models(session: Session, *, limit: int = 50, cursor: str | None = None) -> Page[ModelRow]:
    """One page of models, newest first.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    return fetch_page(session, select(ModelRow), ModelRow, limit=limit, cursor=cursor)


def request_thumbnail(session: Session, model_id: str, *, now: datetime, max_attempts: int = 3) -> JobRow:
    """Queue the drawing of a model's thumbnail.

    Raises:
        NotFoundError: there is no such model.
    """
    get_model(session, model_id)
    payload = {"model_id": model_id}
    return create_job(session, JobKind.RENDER_THUMBNAIL, model_id, payload, now=now, max_attempts=max_attempts)


def record_thumbnail(session: Session, model_id: str, thumbnail_key: str) -> None:
    """Note where the thumbnail is; in the transaction that ends the job."""
    get_model(session, model_id).thumbnail_key = thumbnail_key
