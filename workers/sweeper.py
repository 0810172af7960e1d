"""The sweeper: a thread of the worker's main process that keeps jobs from being forgotten."""

import os
import threading
from collections.abc import Callable
from datetime import datetime, timedelta

import structlog
from celery import Celery
from sqlalchemy.exc import SQLAlchemyError

from models_store.broker import send_wakeup
from models_store.session import Database, upgrade
from models_store.sweep import count_jobs, sweep, wakeups_sent
from workers.context import utc_now
from workers.metrics import SweeperMetrics
from workers.settings import WorkerSettings

log = structlog.get_logger(__name__)


class Sweeper:
    """Sweeps every ``sweep_interval_s``, whatever becomes of the database and the broker meanwhile."""

    def __init__(
        self,
        settings: WorkerSettings,
        celery: Celery,
        metrics: SweeperMetrics | None = None,
        clock: Callable[[], datetime] = utc_now,
    ) -> None:
        self._settings = settings
        self._celery = celery
        self._metrics = metrics
        self._clock = clock
        self._wakeup_after = timedelta(seconds=settings.wakeup_after_s)
        self._database = Database.connect(settings, pooled=False)
        self._upgraded = False
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="sweeper", daemon=True)
        # This process forks children. None may be forked while a database connection is open: SQLite forbids
        # that a child so much as closes it.
        self._connected = threading.Lock()

    def start(self) -> None:
        """Sweep once, then from time to time."""
        os.register_at_fork(
            before=self._connected.acquire,
            after_in_parent=self._connected.release,
            after_in_child=self._connected.release,
        )
        self.sweep_once()
        self._thread.start()

    def stop(self) -> None:
        """Stop sweeping."""
        self._stopped.set()
        if self._thread.is_alive():
            self._thread.join()

    def sweep_once(self) -> None:
        """Sweep; a database or a broker that is away is logged and tried again next time."""
        with self._connected:
            try:
                self._sweep()
            except SQLAlchemyError as error:
                log.warning("database away, not swept", error=str(error).splitlines()[0])
            except Exception:  # the thread must live
                log.exception("sweep broke")

    def _run(self) -> None:
        while not self._stopped.wait(self._settings.sweep_interval_s):
            self.sweep_once()

    def _sweep(self) -> None:
        if not self._upgraded:
            upgrade(self._database.engine)
            self._upgraded = True
        with self._database.writing() as session:
            swept = sweep(session, now=self._clock(), wakeup_after=self._wakeup_after)
        for state, job_ids in (
            ("queued", swept.requeued),
            ("failed", swept.failed),
            ("cancelled", swept.cancelled),
        ):
            for job_id in job_ids:
                log.warning("worker of a job was lost", job_id=job_id, state=state)
        sent: list[str] = []
        for job in swept.to_wake:
            if not send_wakeup(self._celery, job):
                break  # the rest would wait for the same broker, one timeout each
            sent.append(job.id)
        if sent:
            with self._database.writing() as session:
                wakeups_sent(session, sent, now=self._clock(), wakeup_after=self._wakeup_after)
        if self._metrics is not None:
            with self._database.reading() as session:
                self._metrics.observe(swept, len(sent), count_jobs(session))
