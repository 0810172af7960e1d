"""Procedural models: content-addressed, immutable, with a thumbnail that a job draws."""

import hashlib
import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from datetime import datetime
from itertools import groupby
from typing import TYPE_CHECKING, Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.catalog.rows import get_row, insert_once
from models_store.errors import NotFoundError
from models_store.jobs import JobKind, create_job
from models_store.paging import Page, fetch_named_page, fetch_page
from models_store.tables import JobRow, ModelRow
from models_store.text import storable

if TYPE_CHECKING:
    from shapewright.modeling import Condition, Parameter, ProceduralModel


def add_model(
    session: Session, model: "ProceduralModel", *, now: datetime, document: str | None = None
) -> tuple[ModelRow, bool]:
    """Add a model. Returns its row, and whether it is new; the same document twice is one model.

    Args:
        session: a writing session.
        model: the model.
        now: the time, with a zone.
        document: its canonical text, where that is at hand.
    """
    document = model.to_json() if document is None else document
    row = ModelRow(
        id=hashlib.sha256(document.encode()).hexdigest(),
        name=storable(model.name),
        class_name=storable(model.class_name),
        description=storable(model.description),
        closed=model.closed,
        format_version=int(json.loads(document)["version"]),
        operation_count=len(model.operations),
        parameters=[_parameter(parameter) for parameter in model.parameters],
        parts=[{"name": storable(part.name), "present_when": _conditions(part.present_when)} for part in model.parts],
        symmetry={"mirrors": list(model.symmetry.mirrors), "axis": model.symmetry.axis, "order": model.symmetry.order},
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


def known_models(session: Session, model_ids: Sequence[str]) -> list[ModelRow]:
    """The models with these ids, without those that are not there; in the order of the ids."""
    rows = {row.id: row for row in session.scalars(select(ModelRow).where(ModelRow.id.in_(model_ids)))}
    return [rows[model_id] for model_id in model_ids if model_id in rows]


def list_models(
    session: Session, *, class_name: str | None = None, limit: int = 50, cursor: str | None = None
) -> Page[ModelRow]:
    """One page of models, newest first; of one class, if given.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    query = select(ModelRow)
    if class_name is not None:
        query = query.where(ModelRow.class_name == storable(class_name))
    return fetch_page(session, query, ModelRow, limit=limit, cursor=cursor)


def list_classes(
    session: Session, *, limit: int = 50, cursor: str | None = None
) -> Page[tuple[str, Sequence[ModelRow]]]:
    """One page of classes by name, each with its models (see :func:`models_of_class`).

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    names = fetch_named_page(session, ModelRow.class_name, limit=limit, cursor=cursor)
    rows = session.scalars(select(ModelRow).where(ModelRow.class_name.in_(names.items)).order_by(*_BY_NAME)).all()
    found = {name: _newest_of_each_name(group) for name, group in groupby(rows, key=lambda row: row.class_name)}
    return Page([(name, found[name]) for name in names.items], names.next_cursor)


def models_of_class(session: Session, class_name: str) -> list[ModelRow]:
    """The models of a class by name; of several with one name, which are versions of it, the newest.

    Raises:
        NotFoundError: there is none.
    """
    query = select(ModelRow).where(ModelRow.class_name == storable(class_name)).order_by(*_BY_NAME)
    rows = _newest_of_each_name(session.scalars(query))
    if not rows:
        raise NotFoundError("class", storable(class_name, limit=100))
    return rows


_BY_NAME = (ModelRow.class_name, ModelRow.name, ModelRow.created_at.desc(), ModelRow.id.desc())


def _newest_of_each_name(rows: Iterable[ModelRow]) -> list[ModelRow]:
    return [next(versions) for _, versions in groupby(rows, key=lambda row: row.name)]


def _parameter(parameter: "Parameter") -> dict[str, Any]:
    return {
        "name": storable(parameter.name),
        "label": storable(parameter.label),
        "unit": None if parameter.unit is None else storable(parameter.unit),
        "base_value": parameter.base_value,
        "kind": parameter.kind,
        "minimum": parameter.minimum,
        "maximum": parameter.maximum,
        "default": 1.0,
        "options": [{"value": x, "name": storable(option)} for x, option in parameter.named_options()],
        "active_when": _conditions(parameter.active_when),
        "limits": [asdict(limit) for limit in parameter.limits],
    }


def _conditions(conditions: "Sequence[Condition]") -> list[dict[str, Any]]:
    return [asdict(condition) for condition in conditions]


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
