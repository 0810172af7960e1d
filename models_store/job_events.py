"""The event stream of a job: numbered without gaps, in commit order, replayable from any number."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any, Literal

from sqlalchemy import ColumnElement, select, update
from sqlalchemy.orm import Session

from models_store.job_kinds import JobState
from models_store.tables import JobEventRow, JobRow


def update_job(
    session: Session, conditions: Sequence[ColumnElement[bool]], values: dict[str, Any], *, event: bool = True
) -> JobRow | None:
    """Update the one job that meets the conditions, in one statement; ``None`` if none does.

    With ``event`` the statement also takes the next number of the stream (``row.event_count``). It holds the
    row until the transaction ends, so numbers become visible in order and a reader misses none.
    """
    if event:
        values = {**values, "event_count": JobRow.event_count + 1}
    statement = update(JobRow).where(*conditions).values(values).returning(JobRow)
    options = {"synchronize_session": False, "populate_existing": True}
    return session.scalars(statement, execution_options=options).one_or_none()


def add_event(
    session: Session, job: JobRow, type_: Literal["state", "progress"], data: dict[str, Any], now: datetime
) -> None:
    """Write the event whose number the last :func:`update_job` took."""
    session.add(JobEventRow(job_id=job.id, sequence=job.event_count, type=type_, data=data, created_at=now))


def add_state_event(session: Session, job: JobRow, now: datetime) -> None:
    """Write down the state that the job has come into."""
    data: dict[str, Any] = {"state": job.state.value, "attempt": job.attempt}
    if job.cancel_requested and job.state is JobState.RUNNING:
        data["cancel_requested"] = True
    if job.state is JobState.FAILED:
        data["error"] = {"title": job.error_title, "detail": job.error_detail, "where": job.error_where}
    add_event(session, job, "state", data, now)


def list_events(session: Session, job_id: str, *, after: int = 0, limit: int = 1000) -> Sequence[JobEventRow]:
    """The events of a job with a number above ``after``, oldest first."""
    query = select(JobEventRow).where(JobEventRow.job_id == job_id, JobEventRow.sequence > after)
    return session.scalars(query.order_by(JobEventRow.sequence).limit(limit)).all()
