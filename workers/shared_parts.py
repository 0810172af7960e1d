"""The parts of a running job, as the worker sees them that works on the job."""

import time
from collections.abc import Iterator, Sequence
from typing import Any, Final

import structlog

from models_store import claims, parts
from models_store.broker import create_sender, send_wakeup
from models_store.job_kinds import JobKind, JobState
from models_store.session import OUTAGES
from models_store.sweep import QueuedJob
from shapewright.progress import Progress
from workers.context import JobContext, utc_now

log = structlog.get_logger(__name__)

INVITATIONS: Final = 4
"""Parts that are announced at a time, beyond as many as others work on: so a few helpers become more."""
INVITE_AGAIN_S: Final = 30.0
"""A part that nobody took is announced again after so long."""
PATIENCE_S: Final = 60.0
"""Longest wait for parts at other workers, unless this worker's own have taken longer; then it does them itself."""
_POLL_S: Final = 0.3


class SharedParts:
    """Hands out the parts of a job, to this worker and to others.

    A database that is away for a while delays what others do, and stops nothing.

    Args:
        context: of the job.
        kind: of the parts.
        payloads: what each part needs.
        patience_s: see :data:`PATIENCE_S`.
    """

    def __init__(
        self, context: JobContext, kind: JobKind, payloads: Sequence[dict[str, Any]], *, patience_s: float = PATIENCE_S
    ) -> None:
        self._context = context
        self._kind = kind
        self._patience_s = patience_s
        self._sender = create_sender(context.settings)
        self._again_at_s: dict[str, float] = {}
        self._mine: set[str] = set()
        self._ids: list[str] = []
        if payloads:
            with context.database.writing() as session:
                self._ids = parts.add_parts(session, context.claim, kind, payloads, now=utc_now())

    def mine(self, progress: Progress) -> Iterator[tuple[int, float]]:
        """Parts for this worker, by number, each with the share of all that is done; ends when all are done.

        A part that another worker lost, or is too long about, comes up, too. One that failed elsewhere does not:
        look for what is missing.

        Args:
            progress: hears what others do while nothing is left for this worker.
        """
        waiting_since_s: float | None = None
        done = 0.0
        while True:
            try:
                queued, running = self._open()
            except OUTAGES as error:
                log.warning("database away, parts wait", error=str(error))
                progress.report(done, "waiting for the database")
                time.sleep(_POLL_S)
                continue
            if not queued and not running:
                return
            done = 1.0 - (len(queued) + len(running)) / len(self._ids)
            part_id: str | None = None
            if queued:
                part_id = self._withdrawn(queued, len(running))
            elif waiting_since_s is None:
                waiting_since_s = time.monotonic()
            elif time.monotonic() - waiting_since_s > self._patience_s:
                part_id = running[0]
            if part_id is not None:
                self._mine.add(part_id)
                waiting_since_s = None
                started_s = time.monotonic()
                yield self._ids.index(part_id), done
                self._patience_s = max(self._patience_s, 3 * (time.monotonic() - started_s))
            elif not queued:
                progress.report(done, f"waiting for {len(running)} at other workers")
                time.sleep(_POLL_S)

    def _open(self) -> tuple[list[str], list[str]]:
        """Parts that are queued, and that others work on."""
        with self._context.database.reading() as session:
            states = parts.part_states(session, self._context.claim.job_id)
        left = [part_id for part_id in self._ids if part_id not in self._mine]
        queued = [part_id for part_id in left if states.get(part_id) is JobState.QUEUED]
        return queued, [part_id for part_id in left if states.get(part_id) is JobState.RUNNING]

    def _withdrawn(self, queued: Sequence[str], running: int) -> str | None:
        """Invite others, and take the first part that is queued, if nobody has taken it just now."""
        try:
            self._invite(queued[1:][-(INVITATIONS + running) :])  # the ones that this worker would come to last
            with self._context.database.writing() as session:
                return queued[0] if parts.withdraw_part(session, queued[0]) else None
        except OUTAGES as error:
            log.warning("database away, part stays queued", error=str(error))
            time.sleep(_POLL_S)
            return None

    def _invite(self, part_ids: Sequence[str]) -> None:
        now_s = time.monotonic()
        due = [part_id for part_id in part_ids if now_s >= self._again_at_s.get(part_id, now_s)]
        if not due:
            return
        with self._context.database.reading() as session:
            if claims.others_wait(session, now=utc_now()):
                return  # they would all decline
        for part_id in due:
            self._again_at_s[part_id] = now_s + INVITE_AGAIN_S
            if not send_wakeup(self._sender, QueuedJob(part_id, self._kind)):
                return
