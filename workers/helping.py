"""Work on a part of somebody's job, which ends early when it is in vain or other work is wanted more."""

import time
from typing import Final

from models_store import claims, parts
from models_store.session import OUTAGES
from shapewright.errors import Cancelled
from workers.context import JobContext, utc_now
from workers.stopping import GivingWay

LOOK_EVERY_S: Final = 0.3


class Helping:
    """Progress of work that can wait (:class:`shapewright.progress.Progress`)."""

    def __init__(self, context: JobContext) -> None:
        self._context = context
        self._looked_s = -LOOK_EVERY_S

    def report(self, fraction: float, message: str) -> None:
        """Note the progress, and stop when this worker is wanted elsewhere, or nowhere.

        Raises:
            Cancelled: the job that this is a part of has ended, or is asked to stop.
            GivingWay: somebody's own job waits.
        """
        self._context.progress.report(fraction, message)
        if time.monotonic() - self._looked_s < LOOK_EVERY_S:
            return
        self._looked_s = time.monotonic()
        try:
            with self._context.database.reading() as session:
                in_vain = parts.is_in_vain(session, self._context.claim.job_id)
                gives_way = claims.must_give_way(session, now=utc_now())
        except OUTAGES:  # the heartbeat tells of it
            return
        if in_vain:
            raise Cancelled
        if gives_way:
            raise GivingWay
