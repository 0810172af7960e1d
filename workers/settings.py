"""Settings of a worker, read from ``SHAPEWRIGHT_*``."""

from typing import Literal

from pydantic import Field

from models_store.settings import StoreSettings


class WorkerSettings(StoreSettings):
    """What a worker needs beyond the store.

    Attributes:
        worker_concurrency: jobs at the same time, each in a child process of its own.
        warm_up: whether each child process, as it starts, imports what an estimation needs and loads its compiled
            kernels, so that its first estimation need not; it occupies some 200 MB more from the start.
        sweep_interval_s: how often the worker looks for jobs of lost workers and for forgotten ones.
        progress_interval_s: progress is written at most so often.
        cancel_check_s: how often a running job looks whether it shall stop.
        shutdown_grace_s: a job that has not ended so long after SIGTERM goes back to the queue.
        result_patience_s: how long a finished job tries to write its result while the database is away.
        retry_delay_s: a job that broke unexpectedly is tried again after so long.
        metrics_port: serve Prometheus metrics on this port; ``None`` for none.
        log_level: of everything.
        log_format: ``json`` for machines, ``text`` for people.
    """

    worker_concurrency: int = Field(default=1, ge=1)
    warm_up: bool = True
    sweep_interval_s: float = Field(default=2.0, gt=0)
    progress_interval_s: float = Field(default=0.5, gt=0)
    cancel_check_s: float = Field(default=1.0, gt=0)
    shutdown_grace_s: float = Field(default=3.0, ge=0)
    result_patience_s: float = Field(default=60.0, ge=0)
    retry_delay_s: float = Field(default=5.0, ge=0)
    metrics_port: int | None = Field(default=None, ge=1, le=65535)
    log_level: Literal["DEBUG", "INFO", "WARNING", "ERROR"] = "INFO"
    log_format: Literal["json", "text"] = "json"
