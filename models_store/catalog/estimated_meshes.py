"""The rows of an estimation of many meshes: written once each, read in any order."""

import base64
import binascii
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import ColumnElement, Float, Select, and_, cast, func, or_, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from models_store.claims import Claim, look
from models_store.errors import CursorError
from models_store.paging import MAX_LIMIT
from models_store.tables import EstimatedMeshRow, MeshRow
from models_store.text import storable

CHUNK: Final = 200


@dataclass(frozen=True)
class RankedMesh:
    """A row, the name of its mesh, and the value that it is sorted by."""

    row: EstimatedMeshRow
    file_name: str
    value: float | None


@dataclass(frozen=True)
class RowOrder:
    """What rows are sorted by.

    Attributes:
        columns: of ``measures``: one, or numerator and denominator of a ratio; none for the order of the meshes. They
            are trusted: check what comes from outside.
        descending: whether the largest comes first.
    """

    columns: tuple[str, ...] = ()
    descending: bool = False

    def value(self) -> ColumnElement[float]:
        """What a row is sorted by; rows in which it is null come last."""
        if not self.columns:
            return cast(EstimatedMeshRow.position, Float)
        first, *second = (EstimatedMeshRow.measures[column].as_float() for column in self.columns)
        return first / func.nullif(second[0], 0.0) if second else first


def record_estimated_mesh(
    session: Session,
    held: Claim,
    estimation_id: str,
    position: int,
    *,
    mesh_id: str,
    answer: dict[str, Any] | None,
    measures: dict[str, float],
    error: str | None,
    seconds: float | None,
    now: datetime,
) -> None:
    """Write the row of a mesh, unless it is there; two workers that estimate the same mesh come to the same.

    Args:
        session: a writing session.
        held: the claim on the job, or on the part of it, that the mesh belongs to.
        estimation_id: of the whole.
        position: of the mesh among those of the whole.
        mesh_id: of the mesh.
        answer: what was found.
        measures: numbers to sort by.
        error: why nothing was found.
        seconds: that it took.
        now: the time, with a zone.

    Raises:
        StaleClaim: the work belongs to somebody else now.
    """
    look(session, held)
    if session.get(EstimatedMeshRow, (estimation_id, position)) is not None:
        return
    row = EstimatedMeshRow(
        estimation_id=estimation_id,
        position=position,
        mesh_id=mesh_id,
        answer=answer,
        measures=measures,
        error=None if error is None else storable(error, limit=1000),
        seconds=seconds,
        created_at=now,
    )
    try:
        with session.begin_nested():
            session.add(row)
    except IntegrityError:  # another worker was a moment earlier
        if session.get(EstimatedMeshRow, (estimation_id, position)) is None:
            raise


def estimated_positions(session: Session, estimation_id: str) -> set[int]:
    """Which meshes have a row."""
    position = EstimatedMeshRow.position
    return set(session.scalars(select(position).where(EstimatedMeshRow.estimation_id == estimation_id)))


def page_of_estimated(
    session: Session, estimation_id: str, order: RowOrder, *, limit: int = 50, cursor: str | None = None
) -> tuple[list[RankedMesh], str | None]:
    """One page of rows in an order, and the cursor of the next page; rows that come meanwhile do not shift it.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    if not 1 <= limit <= MAX_LIMIT:
        raise CursorError(f"the limit must be between 1 and {MAX_LIMIT}, got {limit}", where="limit")
    value = order.value()
    query = _rows(estimation_id, value)
    if cursor is not None:
        query = query.where(_after(value, order, *_decoded(cursor, order)))
    sorted_value = value.desc() if order.descending else value.asc()
    query = query.order_by(value.is_(None), sorted_value, EstimatedMeshRow.position).limit(limit + 1)
    found = [RankedMesh(*row) for row in session.execute(query)]
    if len(found) <= limit:
        return found, None
    last = found[limit - 1]
    token = json.dumps([order.columns, order.descending, last.value, last.row.position])
    return found[:limit], base64.urlsafe_b64encode(token.encode()).decode()


def all_estimated(session: Session, estimation_id: str, order: RowOrder) -> Iterator[RankedMesh]:
    """All rows in an order, a few of them in memory at a time."""
    cursor: str | None = None
    while True:
        found, cursor = page_of_estimated(session, estimation_id, order, limit=CHUNK, cursor=cursor)
        yield from found
        session.expunge_all()
        if cursor is None:
            return


def _rows(estimation_id: str, value: ColumnElement[float]) -> Select[EstimatedMeshRow, str, float]:
    joined = select(EstimatedMeshRow, MeshRow.file_name, value.label("sorted_by")).join(MeshRow, MeshRow.id == EstimatedMeshRow.mesh_id)
    return joined.where(EstimatedMeshRow.estimation_id == estimation_id)


def _after(value: ColumnElement[float], order: RowOrder, last: float | None, position: int) -> ColumnElement[bool]:
    later = EstimatedMeshRow.position > position
    if last is None:
        return and_(value.is_(None), later)
    beyond = value < last if order.descending else value > last
    return or_(beyond, and_(value == last, later), value.is_(None))


def _decoded(cursor: str, order: RowOrder) -> tuple[float | None, int]:
    try:
        columns, descending, value, position = json.loads(base64.b64decode(cursor, altchars=b"-_", validate=True))
        known = value is None or (isinstance(value, float | int) and math.isfinite(value))
        whole = isinstance(position, int) and 0 <= position < 2**31
        if (tuple(columns), descending) != (order.columns, order.descending) or not (known and whole):
            raise ValueError(cursor)
    except (ValueError, TypeError, binascii.Error, OverflowError, RecursionError):
        raise CursorError("this cursor was not handed out by a list in this order", where="cursor") from None
    return (None if value is None else float(value)), position
