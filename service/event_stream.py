"""The events of a job as they are written: replayed from the database, so a client that reconnects misses none."""

import json
from collections.abc import AsyncIterator

import anyio
from sse_starlette.event import ServerSentEvent
from starlette.concurrency import run_in_threadpool

from models_store import jobs
from models_store.errors import NotFoundError
from models_store.session import Database
from models_store.tables import JobEventRow

_PAGE = 1000


def read_events(database: Database, job_id: str, after: int) -> tuple[list[JobEventRow], bool]:
    """The events after a number, and whether no more will come.

    Raises:
        NotFoundError: there is no such job.
    """
    with database.reading() as session:
        # The state is read first: an event that is written in between then makes one more round, not a gap.
        ended = jobs.get_job(session, job_id).state.is_final
        events = list(jobs.list_events(session, job_id, after=after, limit=_PAGE))
    return events, ended and len(events) < _PAGE


async def job_events(database: Database, job_id: str, after: int, *, poll_s: float) -> AsyncIterator[ServerSentEvent]:
    """Yield the events after a number as they come, until the job has ended."""
    while True:
        try:
            events, ended = await run_in_threadpool(read_events, database, job_id, after)
        except NotFoundError:  # a part of another job, withdrawn by the worker of that job
            return
        for event in events:
            after = event.sequence
            yield ServerSentEvent(data=json.dumps(event.data), event=event.type, id=str(event.sequence))
        if ended:
            return
        if not events:
            await anyio.sleep(poll_s)
