"""Keyset paging: newest first, a cursor names the last row seen, so new rows never shift a page."""

import base64
import binascii
import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final, Generic, TypeVar

from sqlalchemy import Select, select, tuple_
from sqlalchemy.orm import InstrumentedAttribute, Session

from models_store.errors import CursorError
from models_store.text import storable

MAX_LIMIT: Final = 200
RowT = TypeVar("RowT", bound=Any)


@dataclass(frozen=True)
class Page(Generic[RowT]):
    """Some rows and the cursor of the next page (``None`` on the last one)."""

    items: Sequence[RowT]
    next_cursor: str | None


def fetch_page(
    session: Session, query: Select[Any], table: type[RowT], *, limit: int = 50, cursor: str | None = None
) -> Page[RowT]:
    """Fetch one page of ``query``, ordered by (created_at, id) downwards.

    Raises:
        CursorError: ``cursor`` is not one of ours, or ``limit`` is not within 1..MAX_LIMIT.
    """
    _check_limit(limit)
    if cursor is not None:
        created_at, identifier = _decode(cursor)
        query = query.where(tuple_(table.created_at, table.id) < tuple_(created_at, identifier))
    query = query.order_by(table.created_at.desc(), table.id.desc()).limit(limit + 1)
    rows = session.scalars(query).all()
    more = len(rows) > limit
    rows = rows[:limit]
    return Page(rows, _encode(rows[-1].created_at, rows[-1].id) if more else None)


def fetch_named_page(
    session: Session, column: InstrumentedAttribute[str], *, limit: int = 50, cursor: str | None = None
) -> Page[str]:
    """Fetch one page of the different texts of a column, in order.

    Raises:
        CursorError: ``cursor`` is not one of ours, or ``limit`` is not within 1..MAX_LIMIT.
    """
    _check_limit(limit)
    query = select(column).distinct().order_by(column).limit(limit + 1)
    if cursor is not None:
        query = query.where(column > _decode_name(cursor))
    names = session.scalars(query).all()
    more = len(names) > limit
    names = names[:limit]
    return Page(names, base64.urlsafe_b64encode(names[-1].encode()).decode() if more else None)


def _check_limit(limit: int) -> None:
    if not 1 <= limit <= MAX_LIMIT:
        raise CursorError(f"the limit must be between 1 and {MAX_LIMIT}, got {limit}", where="limit")


def _decode_name(cursor: str) -> str:
    try:
        return storable(base64.b64decode(cursor, altchars=b"-_", validate=True).decode())
    except ValueError:
        raise _foreign() from None


def _encode(created_at: datetime, identifier: str) -> str:
    return base64.urlsafe_b64encode(json.dumps([created_at.isoformat(), identifier]).encode()).decode()


def _decode(cursor: str) -> tuple[datetime, str]:
    try:
        time, identifier = json.loads(base64.b64decode(cursor, altchars=b"-_", validate=True))
        created_at = datetime.fromisoformat(time)
        if created_at.tzinfo is None or not (isinstance(identifier, str) and identifier.isalnum()):
            raise ValueError(cursor)
        identifier.encode()
    except (ValueError, TypeError, binascii.Error, OverflowError, RecursionError):
        raise _foreign() from None
    return created_at, identifier


def _foreign() -> CursorError:
    return CursorError("this cursor was not handed out by a list of this service", where="cursor")
