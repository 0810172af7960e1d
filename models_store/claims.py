"""Jobs as workers see them: claim one, keep it, report, and end it.

A claim carries the fencing token that its conditional update handed out. Every later write asks for this token
in its ``WHERE``: a worker that was believed dead, or a second delivery of the same message, changes nothing and
hears :class:`~models_store.errors.StaleClaim`.

Leases compare the clocks of the machines that work together: they should agree within a few seconds. A clock that
is wrong costs work that is done twice, never a wrong result.
"""

import math
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import ColumnElement, and_, case, exists, func, literal, or_, select
from sqlalchemy.orm import Session, aliased

from models_store.errors import NotFoundError, StaleClaim
from models_store.job_events import add_event, add_state_event, update_job
from models_store.job_kinds import JobKind, JobState
from models_store.tables import JobRow
from models_store.text import check_id, storable

QUIET: Final = timedelta(seconds=3)
"""No part of another job is given out while somebody's job waits, nor so soon after one has ended: who classifies one
mesh after the other shall not find the worker busy in between."""
IDLE_WORKERS_TAKE_IT: Final = timedelta(seconds=0.5)
"""A job that has waited longer finds no idle worker; then those that work on parts give way."""


@dataclass(frozen=True)
class Claim:
    """The right to work on a job, as long as the token is the newest."""

    job_id: str
    kind: JobKind
    token: int
    attempt: int
    max_attempts: int
    result_id: str
    payload: dict[str, Any]


@dataclass(frozen=True)
class JobError:
    """Why a job failed, in words for the one who asked for it."""

    title: str
    detail: str
    where: str | None = None


def claim(session: Session, job_id: str, *, now: datetime, lease: timedelta, worker: str = "") -> Claim | None:
    """Take a queued job; of any number of workers that try, one gets it.

    A part of another job is given out only while that job runs and no other work is wanted.

    Returns ``None`` if it is not queued (taken, ended, or not there), or not given out: a delivery without a job is
    harmless.
    """
    try:
        check_id("job", job_id)
    except NotFoundError:
        return None
    job = update_job(
        session,
        [JobRow.id == job_id, JobRow.state == JobState.QUEUED, or_(JobRow.parent_id.is_(None), _is_wanted(now))],
        {
            "state": JobState.RUNNING,
            "token": JobRow.token + 1,
            "attempt": JobRow.attempt + 1,
            "lease_expires_at": now + lease,
            "started_at": func.coalesce(JobRow.started_at, literal(now, JobRow.started_at.type)),
            "next_wakeup_at": None,
            "worker": worker,
        },
    )
    if job is None:
        return None
    add_state_event(session, job, now)
    return Claim(
        job_id=job.id,
        kind=job.kind,
        token=job.token,
        attempt=job.attempt,
        max_attempts=job.max_attempts,
        result_id=job.result_id,
        payload=dict(job.payload),
    )


def claim_waiting(session: Session, *, now: datetime, lease: timedelta, worker: str = "") -> Claim | None:
    """Take the job that has waited longest of those that nobody has tried; for a worker whose wake-up was for nothing.

    Wake-ups of a busy worker pile up, and each is a while on its way: new work shall not wait behind all of them. One
    that has been tried comes back when the sweeper says so.
    """
    waits = (JobRow.state == JobState.QUEUED, JobRow.parent_id.is_(None), JobRow.attempt == 0)
    job_id = session.scalar(select(JobRow.id).where(*waits).order_by(JobRow.created_at, JobRow.id).limit(1))
    return None if job_id is None else claim(session, job_id, now=now, lease=lease, worker=worker)


def others_wait(session: Session, *, now: datetime) -> bool:
    """Whether somebody's own job waits, or has just ended: no part of another job is given out then."""
    return bool(session.scalar(select(_others_wait(now))))


def must_give_way(session: Session, *, now: datetime) -> bool:
    """Whether somebody's own job waits in vain for a worker that has nothing else to do."""
    other = aliased(JobRow)
    waits = (other.state == JobState.QUEUED, other.created_at < now - IDLE_WORKERS_TAKE_IT)
    return bool(session.scalar(select(exists().where(other.parent_id.is_(None), *waits))))


def _is_wanted(now: datetime) -> ColumnElement[bool]:
    parent = aliased(JobRow)
    parent_runs = exists().where(parent.id == JobRow.parent_id, parent.state == JobState.RUNNING)
    return and_(parent_runs, ~_others_wait(now))


def _others_wait(now: datetime) -> ColumnElement[bool]:
    other = aliased(JobRow)
    waits = or_(other.state == JobState.QUEUED, other.finished_at.between(now - QUIET, now + QUIET))
    return exists().where(other.parent_id.is_(None), waits)


def renew(session: Session, held: Claim, *, now: datetime, lease: timedelta) -> bool:
    """Keep the job for another ``lease``. Returns whether somebody has asked for it to be cancelled.

    Raises:
        StaleClaim: the job is no longer ours.
    """
    return _write(session, held, {"lease_expires_at": now + lease}, event=False).cancel_requested


def look(session: Session, held: Claim) -> bool:
    """Whether somebody has asked for the job to be cancelled; writes nothing.

    Raises:
        StaleClaim: the job is no longer ours.
    """
    cancelled = session.scalars(select(JobRow.cancel_requested).where(*_held(held))).one_or_none()
    if cancelled is None:
        raise StaleClaim(_stale_message(held))
    return cancelled


def report_progress(
    session: Session, held: Claim, fraction: float, message: str, *, now: datetime, lease: timedelta
) -> bool:
    """Write progress, which also renews the lease. Returns whether cancellation was asked for.

    Raises:
        StaleClaim: the job is no longer ours.
    """
    fraction = min(max(fraction, 0.0), 1.0) if math.isfinite(fraction) else 0.0
    message = storable(message, limit=500)
    values = {
        "lease_expires_at": now + lease,
        "progress_fraction": fraction,
        "progress_message": message,
    }
    job = _write(session, held, values)
    add_event(session, job, "progress", {"fraction": fraction, "message": message}, now)
    return job.cancel_requested


def finish(session: Session, held: Claim, *, now: datetime) -> None:
    """End the job well. Write its results in the same transaction, after this call.

    Raises:
        StaleClaim: the job is no longer ours; nothing of the transaction may be kept.
    """
    values = {"state": JobState.SUCCEEDED, "progress_fraction": 1.0, **_ended(now)}
    add_state_event(session, _write(session, held, values), now)


def finish_cancelled(session: Session, held: Claim, *, now: datetime) -> None:
    """End the job because somebody asked for it; a best result so far may be written beside it.

    Raises:
        StaleClaim: the job is no longer ours.
    """
    add_state_event(session, _write(session, held, {"state": JobState.CANCELLED, **_ended(now)}), now)


def fail(session: Session, held: Claim, error: JobError, *, now: datetime) -> None:
    """End the job badly; the error is for the one who asked for the job.

    Raises:
        StaleClaim: the job is no longer ours.
    """
    values = {"state": JobState.FAILED, **error_values(error), **_ended(now)}
    add_state_event(session, _write(session, held, values), now)


def release(
    session: Session, held: Claim, *, now: datetime, delay: timedelta = timedelta(0), counted: bool = False
) -> None:
    """Give the job back to the queue, e.g. because this worker is about to stop.

    Args:
        session: a writing session.
        held: the claim that ends with this.
        now: the time, with a zone.
        delay: how long the sweeper waits before it announces the job again.
        counted: whether this was an attempt (a crash) or none (a planned stop).

    A job that was asked to stop meanwhile is cancelled instead.

    Raises:
        StaleClaim: the job is no longer ours.
    """
    values = {**back_to_queue(now + delay, now), "attempt": JobRow.attempt - (0 if counted else 1)}
    add_state_event(session, _write(session, held, values), now)


def error_values(error: JobError) -> dict[str, Any]:
    """The columns of a failure."""
    return {
        "error_title": storable(error.title, limit=200),
        "error_detail": storable(error.detail, limit=4000),
        "error_where": None if error.where is None else storable(error.where, limit=500),
    }


def back_to_queue(wakeup_at: datetime, now: datetime) -> dict[str, Any]:
    """The columns of a running job that goes back to the queue, or ends if it was asked to."""
    cancelled, state, time = JobRow.cancel_requested, JobRow.state.type, JobRow.finished_at.type
    return {
        "state": case((cancelled, literal(JobState.CANCELLED, state)), else_=literal(JobState.QUEUED, state)),
        "finished_at": case((cancelled, literal(now, time)), else_=None),
        "next_wakeup_at": case((cancelled, None), else_=literal(wakeup_at, time)),
        "wakeup_count": 0,
        "lease_expires_at": None,
        "worker": None,
        "progress_fraction": 0.0,
        "progress_message": "",
    }


def _ended(now: datetime) -> dict[str, Any]:
    return {"finished_at": now, "lease_expires_at": None, "next_wakeup_at": None}


def _held(held: Claim) -> list[ColumnElement[bool]]:
    return [JobRow.id == held.job_id, JobRow.token == held.token, JobRow.state == JobState.RUNNING]


def _write(session: Session, held: Claim, values: dict[str, Any], *, event: bool = True) -> JobRow:
    job = update_job(session, _held(held), values, event=event)
    if job is None:
        raise StaleClaim(_stale_message(held))
    return job


def _stale_message(held: Claim) -> str:
    return f"claim {held.token} on job {held.job_id} is no longer the current one"
