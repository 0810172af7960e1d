"""The Celery application of the workers: ``celery -A workers.app worker``."""

import os
from typing import TYPE_CHECKING, Any, Final

from celery import Celery, bootsteps, signals

from models_store.broker import celery_options
from models_store.job_kinds import TASK_NAMES, JobKind
from workers.settings import WorkerSettings
from workers.stopping import StopNotice

if TYPE_CHECKING:
    from workers.runner import Runner


_START_WITHIN_S: Final = 60.0
"""Seconds in which a child must have started; importing what an estimation needs takes seconds on a busy machine."""


class WorkerCelery(Celery):  # type: ignore[misc]
    """A Celery that knows its settings."""

    def __init__(self, settings: WorkerSettings, **options: Any) -> None:
        super().__init__("shapewright", **options)
        self.settings = settings
        self.stop_notice = StopNotice()
        self._runner: Runner | None = None
        self._runner_pid = 0

    def run_job(self, job_id: str) -> None:
        """Carry out a job in this process, whose connections are opened with its first one."""
        self._runner_here().run(job_id)

    def warm_up(self) -> None:
        """Load into this process what its first job may need; what takes longest goes on in the background."""
        self._runner_here().warm_up()

    def _runner_here(self) -> "Runner":
        from workers.runner import Runner

        if self._runner is None or self._runner_pid != os.getpid():
            self._runner, self._runner_pid = Runner(self.settings, self.stop_notice), os.getpid()
        return self._runner


class SweeperStep(bootsteps.StartStopStep):  # type: ignore[misc]
    """Runs the sweeper in the worker's main process, once its first children are forked."""

    requires = ("celery.worker.components:Pool",)

    def __init__(self, worker: Any, **options: Any) -> None:
        super().__init__(worker, **options)
        self._sweeper: Any = None

    def start(self, worker: Any) -> None:
        """Celery starts the worker."""
        from workers.metrics import SweeperMetrics
        from workers.sweeper import Sweeper

        settings: WorkerSettings = worker.app.settings
        metrics = None
        if settings.metrics_port is not None:
            metrics = SweeperMetrics()
            metrics.serve(settings.metrics_port)
        self._sweeper = Sweeper(settings, worker.app, metrics)
        self._sweeper.start()

    def stop(self, worker: Any) -> None:
        """Celery stops the worker."""
        if self._sweeper is not None:
            self._sweeper.stop()

    terminate = stop


def create_celery(settings: WorkerSettings | None = None) -> WorkerCelery:
    """Make the application; nothing is connected or opened yet.

    Args:
        settings: read from the environment if not given.
    """
    # Idle OpenMP threads would spin until the next kernel, and slow down the code that runs in between.
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    settings = settings or WorkerSettings()
    celery = WorkerCelery(settings, set_as_current=False)
    celery.conf.update(celery_options(settings))
    celery.conf.update(
        worker_pool="prefork",  # a GL context a process, and a crash of a native library takes one job with it
        worker_concurrency=settings.worker_concurrency,
        worker_hijack_root_logger=False,
        worker_send_task_events=False,
        worker_cancel_long_running_tasks_on_connection_loss=False,
        worker_proc_alive_timeout=_START_WITHIN_S,
        broker_connection_retry=True,
    )
    for kind in JobKind:
        _register(celery, kind)
    celery.steps["worker"].add(SweeperStep)

    def configure(**_: Any) -> None:
        from workers.logging import configure_logging

        configure_logging(settings)

    def announce_stop(**_: Any) -> None:
        celery.stop_notice.announce(settings.shutdown_grace_s)

    def prepare_child(**_: Any) -> None:
        if settings.warm_up:
            celery.warm_up()

    # Signals belong to the process, not to an application; a process has one worker.
    signals.setup_logging.connect(configure, weak=False, dispatch_uid="shapewright")
    signals.worker_process_init.connect(prepare_child, weak=False, dispatch_uid="shapewright")
    signals.worker_shutting_down.connect(announce_stop, weak=False, dispatch_uid="shapewright")

    return celery


def _register(celery: WorkerCelery, kind: JobKind) -> None:
    @celery.task(name=TASK_NAMES[kind], shared=False, ignore_result=True)  # type: ignore[untyped-decorator]
    def run(job_id: str) -> None:
        """The message is a hint; kind and work are in the row."""
        celery.run_job(job_id)


_app: WorkerCelery | None = None


def __getattr__(name: str) -> Any:
    """Make ``app`` when Celery's command line asks for it, not at import."""
    global _app
    if name != "app":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if _app is None:
        _app = create_celery()
    return _app
