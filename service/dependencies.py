"""What routes need, made once by ``create_app`` and handed to them."""

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Annotated

import anyio
import structlog
from celery import Celery
from fastapi import Depends, Path, Query, Request

from models_store.artifacts import ArtifactStore
from models_store.broker import Waking, create_sender, send_wakeup
from models_store.paging import MAX_LIMIT
from models_store.session import Database
from models_store.sweep import count_jobs
from service.compiled_models import CompiledModels
from service.errors import Problem, ProblemError
from service.metrics import JobCounts, Metrics
from service.settings import ServiceSettings
from shapewright.mesh.file import MeshReader

log = structlog.stdlib.get_logger("shapewright.service")


@dataclass(frozen=True, eq=False)
class Services:
    """The parts of a running service. Nothing is connected before it is used."""

    settings: ServiceSettings
    database: Database
    artifacts: ArtifactStore
    celery: Celery
    mesh_reader: MeshReader
    models: CompiledModels
    metrics: Metrics
    upload_limiter: anyio.CapacityLimiter
    instance_limiter: anyio.CapacityLimiter

    @classmethod
    def build(cls, settings: ServiceSettings) -> "Services":
        """Make all parts from the settings."""
        database = Database.connect(settings)

        def counts() -> JobCounts:
            with database.reading() as session:
                return count_jobs(session)

        return cls(
            settings=settings,
            database=database,
            artifacts=ArtifactStore.open(settings.artifacts_url),
            celery=create_sender(settings),
            mesh_reader=MeshReader(),
            models=CompiledModels(settings.compiled_models),
            metrics=Metrics(counts),
            upload_limiter=anyio.CapacityLimiter(settings.parallel_uploads),
            instance_limiter=anyio.CapacityLimiter(settings.parallel_instances),
        )

    def announce(self, job: Waking) -> None:
        """Tell the workers of a job whose row is committed; if the broker is away a sweeper does it later."""
        if not send_wakeup(self.celery, job):
            self.metrics.wakeups_lost.inc()

    def close(self) -> None:
        """Close what was opened."""
        self.celery.close()
        self.mesh_reader.close()
        self.database.close()


def now() -> datetime:
    """The time, in UTC."""
    return datetime.now(UTC)


def get_services(request: Request) -> Services:
    """The services of the app that the request came to."""
    services = request.app.state.services
    assert isinstance(services, Services)
    return services


def require_json(request: Request) -> None:
    """Refuse a body that does not say that it is JSON.

    Raises:
        ProblemError: 415.
    """
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type != "application/json" and not (
        media_type.startswith("application/") and media_type.endswith("+json")
    ):
        raise ProblemError(
            Problem(
                415,
                "unsupported-media-type",
                "The body is of another type",
                "a body of the type application/json is needed",
                "header.content-type",
                headers=(("Accept", "application/json"),),
            )
        )


ServicesDep = Annotated[Services, Depends(get_services)]
_ID_PATTERN = r"^[0-9A-Za-z_-]+$"
IdPath = Annotated[str, Path(min_length=1, max_length=128, pattern=_ID_PATTERN)]
IdQuery = Annotated[str | None, Query(min_length=1, max_length=128, pattern=_ID_PATTERN)]
LimitQuery = Annotated[int, Query(ge=1, le=MAX_LIMIT, description="Most items of a page.")]
CursorQuery = Annotated[
    str | None, Query(max_length=500, description="`next_cursor` of the page before; none for the first page.")
]
