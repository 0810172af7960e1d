"""Texts and ids from outside, made safe for every database (PostgreSQL refuses NUL, UTF-8 lone surrogates)."""

import re
from typing import Final

from models_store.errors import NotFoundError

_ID: Final = re.compile(r"[0-9a-f]{32}|[0-9a-f]{64}")


def storable(text: str, *, limit: int = 10_000) -> str:
    """The text without what a database cannot hold, cut at ``limit`` characters."""
    return text.encode("utf-8", "replace").decode("utf-8").replace("\0", "")[:limit]


def check_id(what: str, identifier: str) -> str:
    """Return the id if it looks like one of ours.

    Raises:
        NotFoundError: it does not, so nothing can have it.
    """
    if not _ID.fullmatch(identifier):
        raise NotFoundError(what, storable(identifier, limit=100))
    return identifier
