"""The parts of a running job, as the worker sees them that works on the job."""

import time
from collections.abc import Iterator, Sequence
from typing import Any, Final

from models_store import parts
from models_store.broker import create_sender, send_wakeup
from models_store.job_kinds import JobKind, JobState
from models_store.sweep import QueuedJob
from shapewright.progress import Progress
from workers.context import JobContext, utc_now

INVITATIONS: Final = 4
"""Parts that are announced at a time. A worker without anything else to do takes one; then another is announced."""
_INVITE_AGAIN_S: Final = 20.0
"""A part that nobody took is announced again after so long, doubled each time."""
_POLL_S: Final = 0.3


class SharedParts:
    """Hands out the parts of a job, to this worker and to others.

    Args:
        context: of the job.
        kind: of the parts.
        payloads: what each part needs.
    """

    def __init__(self, context: JobContext, kind: JobKind, payloads: Sequence[dict[str, Any]]) -> None:
        self._context = context
        self._kind = kind
        self._sender = create_sender(context.settings)
        self._again_at_s: dict[str, float] = {}
        self._waits_s: dict[str, float] = {}
        with context.database.writing() as session:
            self._ids = parts.add_parts(session, context.claim, kind, payloads, now=utc_now())

    def mine(self, progress: Progress) -> Iterator[tuple[int, float]]:
        """Parts for this worker, by number, each with the share of all that is done; ends when all are done.

        A part that another worker lost comes up, too. One that failed elsewhere does not: look for what is missing.

        Args:
            progress: hears what others do while nothing is left for this worker.
        """
        while True:
            states = self._states()
            unfinished = [part_id for part_id in self._ids if part_id in states and not states[part_id].is_final]
            if not unfinished:
                return
            queued = [part_id for part_id in unfinished if states[part_id] is JobState.QUEUED]
            done = 1.0 - len(unfinished) / len(self._ids)
            if not queued:
                progress.report(done, f"waiting for {_count(len(unfinished), 'part')} at other workers")
                time.sleep(_POLL_S)
                continue
            self._invite(queued[1:])
            with self._context.database.writing() as session:
                is_mine = parts.withdraw_part(session, queued[0])
            if is_mine:
                yield self._ids.index(queued[0]), done

    def _states(self) -> dict[str, JobState]:
        with self._context.database.reading() as session:
            return parts.part_states(session, self._context.claim.job_id)

    def _invite(self, queued: Sequence[str]) -> None:
        now_s = time.monotonic()
        for part_id in queued[-INVITATIONS:]:  # the ones that this worker would come to last
            if now_s >= self._again_at_s.get(part_id, now_s):
                wait_s = self._waits_s.get(part_id, _INVITE_AGAIN_S)
                self._again_at_s[part_id], self._waits_s[part_id] = now_s + wait_s, 2 * wait_s
                if not send_wakeup(self._sender, QueuedJob(part_id, self._kind)):
                    break


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
