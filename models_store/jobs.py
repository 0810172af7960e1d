"""Jobs as those see them who ask for work: create, look at, list, cancel, follow.

The rules (states, claims, leases) are conditional updates, one statement each, so they hold between processes
and machines on SQLite and PostgreSQL alike. Workers use :mod:`models_store.claims`, the sweeper
:mod:`models_store.sweep`. Times are passed in.
"""

from datetime import datetime
from typing import Any
from uuid import uuid4

from sqlalchemy import case, literal, select
from sqlalchemy.orm import Session

from models_store.errors import JobFinishedError, NotFoundError
from models_store.job_events import add_event, add_state_event, list_events, update_job
from models_store.job_kinds import FINAL_STATES, TASK_NAMES, JobKind, JobState
from models_store.paging import Page, fetch_page
from models_store.tables import JobRow
from models_store.text import check_id

__all__ = [
    "FINAL_STATES",
    "TASK_NAMES",
    "JobKind",
    "JobState",
    "create_job",
    "get_job",
    "list_events",
    "list_jobs",
    "new_id",
    "request_cancel",
]


def new_id() -> str:
    """A fresh id: 32 hexadecimal digits."""
    return uuid4().hex


def create_job(
    session: Session,
    kind: JobKind,
    result_id: str,
    payload: dict[str, Any],
    *,
    now: datetime,
    max_attempts: int = 3,
    parent_id: str | None = None,
) -> JobRow:
    """Add a queued job. Commit, then announce it with :func:`models_store.broker.send_wakeup`.

    Args:
        session: a writing session.
        kind: what is to be done.
        result_id: id of the row that the result belongs to.
        payload: ids of what the work needs; no data.
        now: the time, with a zone.
        max_attempts: how often it may be claimed before it counts as failed.
        parent_id: id of the job that this one is a part of; see :mod:`models_store.parts`.
    """
    job = JobRow(
        id=new_id(),
        parent_id=parent_id,
        kind=kind,
        state=JobState.QUEUED,
        payload=payload,
        result_id=result_id,
        attempt=0,
        max_attempts=max_attempts,
        token=0,
        event_count=1,
        cancel_requested=False,
        progress_fraction=0.0,
        progress_message="",
        created_at=now,
        next_wakeup_at=now,
        wakeup_count=0,
    )
    session.add(job)
    session.flush()
    add_event(session, job, "state", {"state": job.state.value, "attempt": 0}, now)
    return job


def get_job(session: Session, job_id: str) -> JobRow:
    """The job with this id.

    Raises:
        NotFoundError: there is none.
    """
    job = session.get(JobRow, check_id("job", job_id))
    if job is None:
        raise NotFoundError("job", job_id)
    return job


def list_jobs(
    session: Session,
    *,
    state: JobState | None = None,
    kind: JobKind | None = None,
    parent_id: str | None = None,
    limit: int = 50,
    cursor: str | None = None,
) -> Page[JobRow]:
    """One page of jobs, newest first: those that somebody asked for, or the parts of one of them.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    query = select(JobRow).where(JobRow.parent_id == parent_id)  # no parent is "IS NULL"
    if state is not None:
        query = query.where(JobRow.state == state)
    if kind is not None:
        query = query.where(JobRow.kind == kind)
    return fetch_page(session, query, JobRow, limit=limit, cursor=cursor)


def request_cancel(session: Session, job_id: str, *, now: datetime) -> JobRow:
    """Ask for the job to stop: a queued one is cancelled at once, a running one when its worker looks.

    Asking twice is no error.

    Raises:
        NotFoundError: there is no such job.
        JobFinishedError: it has ended already.
    """
    was_queued = JobRow.state == JobState.QUEUED
    job = update_job(
        session,
        [JobRow.id == check_id("job", job_id), JobRow.state.not_in(FINAL_STATES), ~JobRow.cancel_requested],
        {
            "cancel_requested": True,
            "state": case((was_queued, literal(JobState.CANCELLED, JobRow.state.type)), else_=JobRow.state),
            "finished_at": case((was_queued, literal(now, JobRow.finished_at.type)), else_=None),
            "next_wakeup_at": None,
        },
    )
    if job is not None:
        add_state_event(session, job, now)
        return job
    job = get_job(session, job_id)
    if job.state.is_final:
        raise JobFinishedError(f"the job has ended already ({job.state.value})")
    return job
