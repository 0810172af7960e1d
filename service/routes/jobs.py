"""Jobs: look at, cancel, follow."""

from typing import Annotated, Any

from fastapi import APIRouter, Header, Query, Response
from sse_starlette.sse import EventSourceResponse
from starlette.concurrency import run_in_threadpool

from models_store import jobs
from models_store.job_kinds import JobKind, JobState
from service.dependencies import CursorQuery, IdPath, IdQuery, LimitQuery, ServicesDep, now
from service.event_stream import job_events, read_events
from service.routes import problems
from service.schemas.jobs import JobOut, JobPageOut

router = APIRouter(prefix="/v1/jobs", tags=["jobs"])

_EVENT = {
    "type": "object",
    "description": "One event of the stream.",
    "properties": {
        "id": {"type": "string", "pattern": "^[0-9]+$"},
        "event": {"type": "string", "enum": ["state", "progress"]},
        "data": {"type": "string", "contentMediaType": "application/json"},
    },
    "required": ["id", "event", "data"],
}


@router.get("", response_model=JobPageOut, responses=problems(422))
def list_jobs(
    services: ServicesDep,
    state: Annotated[JobState | None, Query(description="Only jobs in this state.")] = None,
    kind: Annotated[JobKind | None, Query(description="Only jobs of this kind.")] = None,
    parent_id: Annotated[
        IdQuery,
        Query(description="The parts of this job; one vanishes when the job's own worker does it."),
    ] = None,
    limit: LimitQuery = 50,
    cursor: CursorQuery = None,
) -> Any:
    """List the jobs, newest first."""
    with services.database.reading() as session:
        page = jobs.list_jobs(session, state=state, kind=kind, parent_id=parent_id, limit=limit, cursor=cursor)
    return JobPageOut(items=[JobOut.from_row(row) for row in page.items], next_cursor=page.next_cursor)


@router.get("/{id}", response_model=JobOut, responses=problems(404, 422))
def get_job(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at a job."""
    with services.database.reading() as session:
        return JobOut.from_row(jobs.get_job(session, id))


@router.post("/{id}/cancel", status_code=202, response_model=JobOut, responses=problems(404, 409, 422, 503, 507))
def cancel_job(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002
    """Ask for a job to stop. A queued one ends at once, a running one when its worker looks; 409 if it has ended."""
    with services.database.writing() as session:
        return JobOut.from_row(jobs.request_cancel(session, id, now=now()))


@router.get(
    "/{id}/events",
    response_class=EventSourceResponse,
    responses={
        200: {
            "description": "`state` events with the state and the attempt, `progress` events with fraction and "
            "message; the id of an event is its number. The stream ends after the job's last state.",
            "content": {"text/event-stream": {"schema": _EVENT}},
        },
        204: {"description": "The job has ended and every event was seen: do not reconnect."},
        **problems(404, 422),
    },
)
async def follow_job(
    services: ServicesDep,
    id: IdPath,  # noqa: A002
    last_event_id: Annotated[
        int | None, Header(ge=0, le=2**53, description="Number of the last event that was seen.")
    ] = None,
) -> Response:
    """Follow a job: server-sent events from its start, or from the last one seen."""
    after = last_event_id or 0
    events, ended = await run_in_threadpool(read_events, services.database, id, after)
    if ended and not events:
        return Response(status_code=204)
    settings = services.settings
    stream = job_events(services.database, id, after, poll_s=settings.event_poll_s)
    return EventSourceResponse(stream, ping=settings.event_ping_s, sep="\n")
