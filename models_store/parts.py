"""Parts of a running job: pieces that any worker may take, as jobs of their own.

Whoever works on the job adds its parts, withdraws and does one after the other itself, and invites others to take
some (:func:`models_store.broker.send_wakeup`); the sweeper announces none. A part's outcome is something that the job
finds where it looks for it, such as an array in a store, so a part that is lost or fails costs time and nothing else.
"""

from collections.abc import Sequence
from datetime import datetime
from typing import Any, Final

from sqlalchemy import delete, or_, select
from sqlalchemy.orm import Session, aliased

from models_store.claims import Claim, look
from models_store.job_kinds import FINAL_STATES, JobKind, JobState
from models_store.jobs import create_job
from models_store.tables import JobRow

MAX_ATTEMPTS: Final = 2


def add_parts(
    session: Session, held: Claim, kind: JobKind, payloads: Sequence[dict[str, Any]], *, now: datetime
) -> list[str]:
    """Queue parts of a job, in place of what an earlier attempt has left queued. Returns their ids.

    Args:
        session: a writing session.
        held: the claim on the job.
        kind: of all parts.
        payloads: ids of what each part needs.
        now: the time, with a zone.

    Raises:
        StaleClaim: the job is no longer ours.
    """
    look(session, held)
    _delete(session, JobRow.parent_id == held.job_id)
    return [
        create_job(session, kind, held.result_id, payload, now=now, max_attempts=MAX_ATTEMPTS, parent_id=held.job_id).id
        for payload in payloads
    ]


def withdraw_part(session: Session, part_id: str) -> bool:
    """Take a part off the queue, to do its work outside of it. Returns whether nobody had taken it."""
    return _delete(session, JobRow.id == part_id)


def part_states(session: Session, job_id: str) -> dict[str, JobState]:
    """The state of every part of a job, by its id."""
    rows = session.execute(select(JobRow.id, JobRow.state).where(JobRow.parent_id == job_id))
    return {row.id: row.state for row in rows}


def is_in_vain(session: Session, part_id: str) -> bool:
    """Whether nobody wants the outcome of this part any more: its job has ended, or is asked to stop."""
    job = aliased(JobRow)
    ended = or_(job.state.in_(FINAL_STATES), job.cancel_requested)
    query = select(JobRow.id).join(job, job.id == JobRow.parent_id).where(JobRow.id == part_id, ended)
    return session.scalar(query) is not None


def _delete(session: Session, condition: Any) -> bool:
    statement = delete(JobRow).where(condition, JobRow.state == JobState.QUEUED)
    return bool(session.connection().execute(statement).rowcount)
