"""What the sweeper does: jobs of lost workers go back to the queue, forgotten ones are announced again.

Any number of sweepers may run at the same time; every step is a conditional update.
"""

from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Final

from sqlalchemy import Text, and_, case, func, literal, or_, select, update
from sqlalchemy.orm import Session, aliased

from models_store.claims import JobError, back_to_queue, error_values
from models_store.errors import JobFinishedError, NotFoundError
from models_store.job_events import add_state_event, update_job
from models_store.job_kinds import FINAL_STATES, JobKind, JobState
from models_store.jobs import request_cancel
from models_store.tables import JobRow

BATCH: Final = 50
MAX_WAKEUP_INTERVAL: Final = timedelta(minutes=5)
LOST: Final = JobError(
    "The worker was lost",
    "the worker stopped without a word (killed, out of memory, or its machine went away) each time this job was tried",
)


@dataclass(frozen=True)
class QueuedJob:
    """What a wake-up needs to know."""

    id: str
    kind: JobKind


@dataclass(frozen=True)
class Sweep:
    """What one sweep did to the jobs of lost workers (ids), and which queued jobs want to be announced."""

    requeued: list[str] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    cancelled: list[str] = field(default_factory=list)
    to_wake: list[QueuedJob] = field(default_factory=list)


def sweep(session: Session, *, now: datetime, wakeup_after: timedelta) -> Sweep:
    """End or re-queue running jobs whose lease ran out, and pick the queued jobs that are due a wake-up.

    Commit, send the wake-ups, then tell with :func:`wakeups_sent` which ones went out. One that could not be
    sent is due again after ``wakeup_after``.
    """
    done = Sweep()
    _end_leases(session, now, done)
    _end_parts(session, now)
    _pick_wakeups(session, now, wakeup_after, done)
    return done


def _end_leases(session: Session, now: datetime, done: Sweep) -> None:
    expired = and_(JobRow.state == JobState.RUNNING, JobRow.lease_expires_at < now)
    for job_id in session.scalars(select(JobRow.id).where(expired).order_by(JobRow.id).limit(BATCH)).all():
        exhausted = and_(JobRow.attempt >= JobRow.max_attempts, ~JobRow.cancel_requested)
        values = back_to_queue(now, now)
        for name, value in error_values(LOST).items():
            values[name] = case((exhausted, literal(value, Text)), else_=None)
        values["state"] = case((exhausted, literal(JobState.FAILED, JobRow.state.type)), else_=values["state"])
        ended_at = literal(now, JobRow.finished_at.type)
        values["finished_at"] = case((exhausted, ended_at), else_=values["finished_at"])
        values["next_wakeup_at"] = case((exhausted, None), else_=values["next_wakeup_at"])
        job = update_job(session, [JobRow.id == job_id, expired], values)
        if job is None:  # renewed or swept by another in between
            continue
        add_state_event(session, job, now)
        outcome = {JobState.FAILED: done.failed, JobState.CANCELLED: done.cancelled}
        outcome.get(job.state, done.requeued).append(job.id)


def _end_parts(session: Session, now: datetime) -> None:
    """Ask the parts of jobs that have ended to stop."""
    parent = aliased(JobRow)
    query = select(JobRow.id).join(parent, parent.id == JobRow.parent_id)
    query = query.where(parent.state.in_(FINAL_STATES), JobRow.state.not_in(FINAL_STATES), ~JobRow.cancel_requested)
    for job_id in session.scalars(query.order_by(JobRow.id).limit(BATCH)).all():
        with suppress(JobFinishedError, NotFoundError):  # ended, or withdrawn, in between
            request_cancel(session, job_id, now=now)


def _pick_wakeups(session: Session, now: datetime, wakeup_after: timedelta, done: Sweep) -> None:
    # parts are announced by the worker of their job, which would otherwise do them itself
    queued = and_(JobRow.state == JobState.QUEUED, JobRow.parent_id.is_(None))
    due = and_(queued, or_(JobRow.next_wakeup_at <= now, JobRow.next_wakeup_at.is_(None)))
    for job_id in session.scalars(select(JobRow.id).where(due).order_by(JobRow.created_at).limit(BATCH)).all():
        values = {"next_wakeup_at": now + wakeup_after}
        job = update_job(session, [JobRow.id == job_id, due], values, event=False)
        if job is not None:
            done.to_wake.append(QueuedJob(job.id, job.kind))


def wakeups_sent(session: Session, job_ids: list[str], *, now: datetime, wakeup_after: timedelta) -> None:
    """Note that these jobs were announced; each waits twice as long for the next time, at most 5 minutes."""
    for job_id in job_ids:
        row = session.execute(
            select(JobRow.wakeup_count).where(JobRow.id == job_id, JobRow.state == JobState.QUEUED)
        ).one_or_none()
        if row is None:
            continue
        wait = min(wakeup_after * 2 ** min(row.wakeup_count, 16), MAX_WAKEUP_INTERVAL)
        session.execute(
            update(JobRow)
            .where(JobRow.id == job_id, JobRow.state == JobState.QUEUED)
            .values(wakeup_count=row.wakeup_count + 1, next_wakeup_at=now + wait)
            .execution_options(synchronize_session=False)
        )


def count_jobs(session: Session) -> dict[tuple[JobKind, JobState], int]:
    """How many jobs of each kind are in each state; for metrics."""
    query = select(JobRow.kind, JobRow.state, func.count()).group_by(JobRow.kind, JobRow.state)
    return {(kind, state): count for kind, state, count in session.execute(query)}
