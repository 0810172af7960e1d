"""Carry out one job: claim it, run its task, end it. Whatever is delivered, nothing is done twice."""

import os
import socket
import time
from collections.abc import Callable
from datetime import datetime, timedelta
from typing import Final

import structlog
from sqlalchemy.orm import Session

from models_store import claims
from models_store.artifacts import ArtifactStore
from models_store.claims import Claim, JobError
from models_store.errors import ArtifactError, StaleClaim
from models_store.job_kinds import JobState
from models_store.jobs import get_job
from models_store.session import OUTAGES, Database
from shapewright.errors import Cancelled, ShapewrightError
from shapewright.mesh.file import MeshReader
from workers.context import JobContext, Outcome, WorkerProgress, utc_now
from workers.settings import WorkerSettings
from workers.stopping import GivingWay, StopNotice, WorkerStopping
from workers.tasks import TASKS
from workers.warming import load_estimation

log = structlog.get_logger(__name__)

UNEXPECTED: Final = JobError(
    "Unexpected error", "something broke inside the worker; its log tells more under the id of this job"
)
_RETRY_S: Final = 0.5


class Runner:
    """Carries out jobs in one process."""

    def __init__(
        self,
        settings: WorkerSettings,
        stop_notice: StopNotice,
        *,
        database: Database | None = None,
        artifacts: ArtifactStore | None = None,
        clock: Callable[[], datetime] = utc_now,
    ) -> None:
        """Open what the settings name, unless it is given."""
        self._settings = settings
        self._stop_notice = stop_notice
        self._database = database or Database.connect(settings)
        self._artifacts = artifacts or ArtifactStore.open(settings.artifacts_url)
        self._clock = clock
        self._reader = MeshReader()
        self._worker = f"{socket.gethostname()}:{os.getpid()}"

    def run(self, job_id: str) -> None:
        """Carry out the job if it is queued; for a doubled, late or unknown delivery the one that waits longest."""
        if self._stop_notice.is_due:
            return  # it stays queued for another worker
        try:
            held = self._claim(job_id)
        except OUTAGES as error:
            log.warning("database away, job stays queued", job_id=job_id, error=str(error))
            return
        if held is None:
            log.info("nothing to do for this delivery", job_id=job_id)
            return
        with structlog.contextvars.bound_contextvars(job_id=held.job_id, kind=held.kind.value, attempt=held.attempt):
            self._work(held)

    def warm_up(self) -> None:
        """Start the process that reads files, and load what an estimation needs."""
        self._reader.prepare()
        load_estimation()

    def close(self) -> None:
        """Close the database connections, and end the process that reads files."""
        self._database.close()
        self._reader.close()

    def _claim(self, job_id: str) -> Claim | None:
        lease, now = timedelta(seconds=self._settings.lease_s), self._clock()
        with self._database.writing() as session:
            held = claims.claim(session, job_id, now=now, lease=lease, worker=self._worker)
            return held or claims.claim_waiting(session, now=now, lease=lease, worker=self._worker)

    def _work(self, held: Claim) -> None:
        log.info("job started")
        started = time.perf_counter()
        outcome: Outcome | None = None
        end = "lost"
        try:
            with WorkerProgress(self._database, held, self._settings, self._stop_notice, self._clock) as progress:
                context = JobContext(held, self._database, self._artifacts, self._settings, progress, self._reader)
                write, outcome = self._carry_out(context)
                try:
                    end = self._write(held, write).value
                except (StaleClaim, *OUTAGES):
                    raise
                except Exception:
                    log.exception("the result cannot be written")
                    self._remove(outcome)
                    end = self._write(held, self._broken(held)).value
        except StaleClaim:
            log.warning("the job belongs to somebody else now, nothing was written")
            self._remove(outcome)
        except OUTAGES as error:  # the artefacts stay: the last try may have been written after all
            log.warning("database away, the lease will run out", error=str(error))
        log.info("job left", state=end, seconds=round(time.perf_counter() - started, 3))

    def _carry_out(self, context: JobContext) -> tuple[Callable[[Session], None], Outcome | None]:
        """Run the task. Returns what is to be written at its end, and its outcome if it has one."""
        held = context.claim
        try:
            outcome = TASKS[held.kind](context)
        except (StaleClaim, *OUTAGES):
            raise
        except (WorkerStopping, GivingWay) as stop:
            log.info("job goes back to the queue", reason=type(stop).__name__)
            return lambda session: claims.release(session, held, now=self._clock()), None
        except Cancelled:
            log.info("job cancelled")
            return lambda session: claims.finish_cancelled(session, held, now=self._clock()), None
        except ShapewrightError as error:
            log.info("job failed", error=str(error))
            reason = JobError(_title(error), error.message, error.where)
            return lambda session: claims.fail(session, held, reason, now=self._clock()), None
        except Exception:
            log.exception("job broke")
            return self._broken(held), None

        def end(session: Session) -> None:
            finish = claims.finish_cancelled if outcome.cancelled else claims.finish
            finish(session, held, now=self._clock())
            outcome.record(session)

        return end, outcome

    def _broken(self, held: Claim) -> Callable[[Session], None]:
        """The end of an attempt that broke: the job is tried again, or has failed with its last attempt."""
        if held.attempt >= held.max_attempts:
            return lambda session: claims.fail(session, held, UNEXPECTED, now=self._clock())
        delay = timedelta(seconds=self._settings.retry_delay_s)
        return lambda session: claims.release(session, held, now=self._clock(), delay=delay, counted=True)

    def _write(self, held: Claim, end: Callable[[Session], None]) -> JobState:
        """Write the end of the job, patiently: the work of an hour must not be lost with a short outage."""
        give_up_at = time.monotonic() + self._settings.result_patience_s
        unsure = False
        while True:
            try:
                with self._database.writing() as session:
                    row = get_job(session, held.job_id)
                    if not (unsure and row.token == held.token and row.state.is_final):
                        end(session)
                    # else the connection broke after the commit of an earlier try, and before its answer
                return row.state
            except OUTAGES as error:
                if time.monotonic() >= give_up_at:
                    raise
                unsure = True
                log.warning("database away, result waits", error=str(error))
                time.sleep(_RETRY_S)

    def _remove(self, outcome: Outcome | None) -> None:
        for key in outcome.artifacts if outcome else ():
            try:
                self._artifacts.delete(key)
            except ArtifactError as error:
                log.warning("artefact without a result stays behind", key=key, error=str(error))


def _title(error: ShapewrightError) -> str:
    """``MeshFileError`` is for programmers; people read ``Mesh file error``."""
    name = type(error).__name__.removesuffix("Error")
    words = "".join(f" {letter.lower()}" if letter.isupper() else letter for letter in name).strip()
    return f"{words.capitalize()} error"
