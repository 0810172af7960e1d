"""Database work that waits while the database is away for a moment."""

import time
from collections.abc import Callable
from typing import Final, TypeVar

import structlog

from models_store.session import OUTAGES

log = structlog.get_logger(__name__)

Result = TypeVar("Result")
_RETRY_S: Final = 0.5


def patiently(work: Callable[[], Result], patience_s: float) -> Result:
    """Do the work, again and again while the database is away; it must do no harm twice.

    Args:
        work: opens a session of its own.
        patience_s: seconds after which the outage is raised.
    """
    give_up_at_s = time.monotonic() + patience_s
    while True:
        try:
            return work()
        except OUTAGES as error:
            if time.monotonic() >= give_up_at_s:
                raise
            log.warning("database away, a row waits", error=str(error))
            time.sleep(_RETRY_S)
