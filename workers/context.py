"""What a task works with: its claim, the store, and a progress that keeps the claim alive."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Any, Self

import structlog
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from models_store import catalog, claims
from models_store.artifacts import ArtifactStore
from models_store.claims import Claim
from models_store.errors import StaleClaim
from models_store.session import Database
from shapewright.errors import Cancelled
from workers.settings import WorkerSettings
from workers.stopping import StopNotice, WorkerStopping

if TYPE_CHECKING:
    from shapewright.mesh import PointCloud, TriangleMesh
    from shapewright.mesh.file import MeshReader
    from shapewright.modeling import ProceduralModel

log = structlog.get_logger(__name__)


def utc_now() -> datetime:
    """The time."""
    return datetime.now(UTC)


class WorkerProgress:
    """The progress of one job (:class:`shapewright.progress.Progress`).

    ``report`` only notes what it is told and raises what it has to; a thread of its own writes to the database,
    so reports are cheap at any rate, and the lease is renewed during long native calls, too.
    """

    def __init__(
        self,
        database: Database,
        claim: Claim,
        settings: WorkerSettings,
        stop_notice: StopNotice,
        clock: Callable[[], datetime] = utc_now,
    ) -> None:
        self._database = database
        self._claim = claim
        self._clock = clock
        self._stop_notice = stop_notice
        self._lease = timedelta(seconds=settings.lease_s)
        self._renew_after_s = settings.lease_s / 3
        self._check_after_s = min(settings.cancel_check_s, self._renew_after_s)
        self._tick_s = min(settings.progress_interval_s, self._check_after_s)
        self._latest: tuple[float, str] | None = None  # replaced as a whole, so it needs no lock
        self._written: tuple[float, str] | None = None
        self._cancelled = False
        self._lost: StaleClaim | None = None
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._keep_alive, name=f"heartbeat-{claim.job_id}", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop the heartbeat; nothing is written after this."""
        self._closed.set()
        self._thread.join()

    def report(self, fraction: float, message: str) -> None:
        """Note the progress.

        Raises:
            Cancelled: somebody asked for the job to stop.
            StaleClaim: the job was given to another worker.
            WorkerStopping: this worker stops and the job had its time to end.
        """
        if self._lost is not None:
            raise self._lost
        if self._cancelled:
            raise Cancelled
        if self._stop_notice.is_due:
            raise WorkerStopping
        self._latest = (float(fraction), message)

    def _keep_alive(self) -> None:
        renewed = checked = time.monotonic()
        while not self._closed.wait(self._tick_s):
            now, latest = time.monotonic(), self._latest
            try:
                if latest is not None and latest != self._written:
                    self._write(latest)
                    self._written = latest
                    renewed = checked = now
                elif now - renewed >= self._renew_after_s:
                    with self._database.writing() as session:
                        self._cancelled |= claims.renew(session, self._claim, now=self._clock(), lease=self._lease)
                    renewed = checked = now
                elif now - checked >= self._check_after_s:
                    with self._database.reading() as session:
                        self._cancelled |= claims.look(session, self._claim)
                    checked = now
            except StaleClaim as error:
                self._lost = error
                return
            except SQLAlchemyError as error:  # away for a while; the fencing token protects the row meanwhile
                log.warning("database away, heartbeat not written", error=str(error))

    def _write(self, latest: tuple[float, str]) -> None:
        with self._database.writing() as session:
            self._cancelled |= claims.report_progress(
                session, self._claim, *latest, now=self._clock(), lease=self._lease
            )


@dataclass(frozen=True)
class Outcome:
    """What a task hands back; it is written in the transaction that ends the job.

    Args:
        record: writes the rows of the result.
        artifacts: keys that the task has written, removed again should the job turn out to be another's.
        cancelled: the work was stopped on request, and this is its best so far.
    """

    record: Callable[[Session], None]
    artifacts: tuple[str, ...] = ()
    cancelled: bool = False


@dataclass(frozen=True)
class JobContext:
    """One job in the hands of one worker."""

    claim: Claim
    database: Database
    artifacts: ArtifactStore
    settings: WorkerSettings
    progress: WorkerProgress
    reader: "MeshReader"
    started_s: float = field(default_factory=time.perf_counter)

    @property
    def seconds(self) -> float:
        """Seconds since the work began."""
        return time.perf_counter() - self.started_s

    def own_key(self, name: str, file_type: str) -> str:
        """The key of an artefact that only this claim writes, so that a stale worker cannot change it."""
        return f"{name}-{self.claim.token}.{file_type}"

    def load_model(self, model_id: str) -> "ProceduralModel":
        """Read a procedural model from the catalogue."""
        from shapewright.modeling import ProceduralModel

        with self.database.reading() as session:
            document = catalog.get_model(session, model_id).document
        return ProceduralModel.from_json(document)

    def load_query(self, mesh_id: str) -> "TriangleMesh | PointCloud":
        """Read an uploaded mesh or point cloud, from the original bytes: the stored GLB has rounded coordinates."""
        from shapewright.mesh.file import parse_query

        return parse_query(*self._source(mesh_id), reader=self.reader)

    def load_mesh(self, mesh_id: str) -> "TriangleMesh":
        """Read an uploaded mesh, as :meth:`load_query`; a point cloud is refused."""
        from shapewright.mesh.file import parse_mesh

        return parse_mesh(*self._source(mesh_id), reader=self.reader)

    def _source(self, mesh_id: str) -> tuple[bytes, str]:
        with self.database.reading() as session:
            row = catalog.get_mesh(session, mesh_id)
        return self.artifacts.get(row.source_key), row.file_type


def with_tuples(settings: dict[str, Any]) -> dict[str, Any]:
    """Settings as the library's dataclasses want them: JSON has lists where they have tuples."""
    return {name: tuple(value) if isinstance(value, list) else value for name, value in settings.items()}
