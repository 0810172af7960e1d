"""Jobs and their events."""

from typing import Self

from pydantic import Field

from models_store.job_kinds import JobKind, JobState
from models_store.tables import JobRow
from service.schemas.common import Moment, OutBody, PageOut

RESULT_PATHS = {
    JobKind.TRAIN_CLASSIFIER: "/v1/classifiers",
    JobKind.DESCRIBE_VARIATIONS: "/v1/classifiers",
    JobKind.CLASSIFY: "/v1/classifications",
    JobKind.ESTIMATE: "/v1/estimations",
    JobKind.ESTIMATE_COLLECTION: "/v1/collection-estimations",
    JobKind.ESTIMATE_MESHES: "/v1/collection-estimations",
    JobKind.RENDER_THUMBNAIL: "/v1/models",
    JobKind.INDEX_COLLECTION: "/v1/collections",
    JobKind.RETRIEVE: "/v1/retrievals",
}
"""Where the result of each kind of job is found, followed by its id."""


class JobProgressOut(OutBody):
    """How far a job is."""

    fraction: float = Field(ge=0, le=1)
    message: str


class JobErrorOut(OutBody):
    """Why a job failed."""

    title: str
    detail: str
    where: str | None


class JobOut(OutBody):
    """A piece of long work, as its row says."""

    id: str
    parent_id: str | None = Field(description="The job that this one is a part of.")
    kind: JobKind
    state: JobState
    attempt: int = Field(description="How often a worker has taken the job.")
    max_attempts: int
    cancel_requested: bool
    progress: JobProgressOut
    error: JobErrorOut | None
    result_url: str | None = Field(description="Address of what the job fills in.")
    url: str
    events_url: str = Field(description="The job's server-sent events.")
    created_at: Moment
    started_at: Moment | None
    finished_at: Moment | None

    @classmethod
    def from_row(cls, row: JobRow) -> Self:
        """Write down a row."""
        error = None
        if row.error_title is not None:
            error = JobErrorOut(title=row.error_title, detail=row.error_detail or "", where=row.error_where)
        return cls(
            id=row.id,
            parent_id=row.parent_id,
            kind=row.kind,
            state=row.state,
            attempt=row.attempt,
            max_attempts=row.max_attempts,
            cancel_requested=row.cancel_requested,
            progress=JobProgressOut(fraction=row.progress_fraction, message=row.progress_message),
            error=error,
            result_url=f"{RESULT_PATHS[row.kind]}/{row.result_id}",
            url=f"/v1/jobs/{row.id}",
            events_url=f"/v1/jobs/{row.id}/events",
            created_at=row.created_at,
            started_at=row.started_at,
            finished_at=row.finished_at,
        )


class JobPageOut(PageOut[JobOut]):
    """A page of jobs."""


class AcceptedOut(OutBody):
    """Work that was accepted: the address of what comes out of it, and the job that does it."""

    id: str = Field(description="Id of the result.")
    url: str = Field(description="Address of the result; its `state` follows the job's.")
    job: JobOut

    @classmethod
    def from_row(cls, row: JobRow) -> Self:
        """Write down a job that was just created."""
        return cls(id=row.result_id, url=f"{RESULT_PATHS[row.kind]}/{row.result_id}", job=JobOut.from_row(row))
