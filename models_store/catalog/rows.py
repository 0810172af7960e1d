"""What the parts of the catalogue share: insert once, get or refuse."""

from typing import Any, TypeVar

from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from models_store.errors import NotFoundError
from models_store.text import check_id

RowT = TypeVar("RowT", bound=Any)


def insert_once(session: Session, row: RowT) -> tuple[RowT, bool]:
    """Insert a row whose id is its content. Returns the row that is there, and whether it is this one."""
    table = type(row)
    existing = session.get(table, row.id)
    if existing is not None:
        return existing, False
    try:
        with session.begin_nested():
            session.add(row)
    except IntegrityError:  # another process inserted the same content in between
        existing = session.get(table, row.id)
        if existing is None:
            raise
        return existing, False
    return row, True


def get_row(session: Session, table: type[RowT], what: str, identifier: str) -> RowT:
    """The row with this id.

    Raises:
        NotFoundError: there is none.
    """
    row = session.get(table, check_id(what, identifier))
    if row is None:
        raise NotFoundError(what, identifier)
    return row
