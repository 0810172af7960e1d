"""Real workers in processes of their own, and jobs for them, without a service in between."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from types import MappingProxyType
from typing import Any
from uuid import uuid4

import numpy as np
from services import logged_process
from waiting import wait_until

from models_store import catalog
from models_store.artifacts import ArtifactStore
from models_store.broker import create_sender, send_wakeup
from models_store.jobs import JobState, get_job, list_events
from models_store.session import Database, upgrade
from models_store.settings import StoreSettings
from models_store.tables import EstimationRow, JobRow
from shapewright.modeling import ProceduralModel, Recorder, compile_model

REPOSITORY = Path(__file__).resolve().parent.parent
QUICK = {
    "estimator": "reference",
    "subdivision_steps": 0,
    "surface_points": 50,
    "image_size": 16,
    "step_sizes": [1.0],
    "model_points": "vertices",
    "alignment": {"translation_step": 0.05, "rotation_step_rad": 0.15, "scale_step": 0.05},
}
"""Settings of an estimation that takes less than a second beside its bank, which takes about one for 1000 samples."""
ENDLESS = 10_000_000
"""Samples of an estimation that does not end while a test runs."""


def now() -> datetime:
    return datetime.now(UTC)


def brick() -> ProceduralModel:
    """A box on a box, whose height is a parameter."""
    recorder = Recorder("brick", "brick")
    box = recorder.box(1.0, 0.8, 0.4)
    recorder.extrude(box.top, 0.6, length="height")
    recorder.parameter("height", "height", 0.3, 2.0)
    return recorder.build()


def rod() -> ProceduralModel:
    """A long prism."""
    recorder = Recorder("rod", "rod")
    rod = recorder.prism(6, 0.2, 2.0)
    recorder.extrude(rod.top, 1.0, length="length")
    recorder.parameter("length", "length", 0.3, 2.0)
    return recorder.build()


class Site:
    """One installation: a database, artefacts, a broker, and a way to start workers on them."""

    def __init__(self, folder: Path, **settings: Any) -> None:
        given = {"wakeup_after_s": 0.5, **settings}
        self.settings = StoreSettings(data_dir=folder / "data", **given)
        self.database = Database.connect(self.settings)
        upgrade(self.database.engine)
        self.artifacts = ArtifactStore.open(self.settings.artifacts_url)
        self.sender = create_sender(self.settings)
        self._folder = folder
        self._logs: list[Path] = []
        self._environment = {
            **os.environ,
            "PYTHONPATH": str(REPOSITORY),
            "SHAPEWRIGHT_DATA_DIR": str(self.settings.data_dir),
            "SHAPEWRIGHT_DATABASE_URL": self.settings.database_url,
            "SHAPEWRIGHT_BROKER_URL": self.settings.broker_url,
            "SHAPEWRIGHT_SWEEP_INTERVAL_S": "0.3",
            "SHAPEWRIGHT_PROGRESS_INTERVAL_S": "0.1",
            "SHAPEWRIGHT_CANCEL_CHECK_S": "0.1",
            "SHAPEWRIGHT_RETRY_DELAY_S": "0",
            "SHAPEWRIGHT_WARM_UP": "false",
            **{f"SHAPEWRIGHT_{name.upper()}": str(value) for name, value in given.items()},
        }

    @contextmanager
    def worker(self, **environment: str) -> Iterator["subprocess.Popen[bytes]"]:
        """A worker as people start it, until the end of the block. It is ready for jobs when the block begins."""
        command = [sys.executable, "-m", "celery", "-A", "workers.app", "worker", "-n", f"{uuid4().hex}@%h"]
        env = self._environment | environment
        log = self._folder / f"worker-{len(self._logs)}.log"
        self._logs.append(log)
        with logged_process(command, log=log, cwd=self.settings.data_dir, env=env) as process:
            wait_until(lambda: process.poll() is not None or " ready." in log.read_text(), self.log)
            yield process

    def log(self) -> str:
        """What all workers of the site have written so far."""
        return "".join(path.read_text(errors="replace") for path in self._logs)

    def add_model(self, model: ProceduralModel) -> str:
        with self.database.writing() as session:
            return catalog.add_model(session, model, now=now())[0].id

    def queue_thumbnail(self, model_id: str) -> str:
        with self.database.writing() as session:
            job = catalog.request_thumbnail(session, model_id, now=now())
        send_wakeup(self.sender, job)
        return job.id

    def queue_estimation(
        self,
        samples: int,
        *,
        height: float = 1.4,
        send: bool = True,
        changes: Mapping[str, Any] = MappingProxyType({}),
        **options: Any,
    ) -> EstimationRow:
        """Queue a quick estimation of a brick of this height, by the brick; ``changes`` are other settings."""
        compiled = compile_model(brick())
        query = compiled.instance(np.array([height]), steps=0)
        mesh, _ = catalog.store_mesh(
            self.database, self.artifacts, query.to_bytes("off"),
            file_name="query.off", file_type="off", mesh=query, now=now(),
        )  # fmt: skip
        model_id = self.add_model(brick())
        settings = {**QUICK, "samples": samples, **changes}
        with self.database.writing() as session:
            row = catalog.request_estimation(session, mesh.id, model_id, settings, now=now(), **options)
        if send:
            send_wakeup(self.sender, row.job)
        return row

    def estimation(self, identifier: str) -> EstimationRow:
        with self.database.reading() as session:
            return catalog.get_estimation(session, identifier)

    def job(self, job_id: str) -> JobRow:
        with self.database.reading() as session:
            return get_job(session, job_id)

    def wait(self, job_id: str, until: Callable[[JobRow], bool] = lambda job: job.state.is_final) -> JobRow:
        """Wait until the job is as wished (default: ended)."""

        def found() -> JobRow | None:
            job = self.job(job_id)
            fits = until(job)
            assert fits or not job.state.is_final, f"job has ended: {job.state}\n{self.log()[-4000:]}"
            return job if fits else None

        job = wait_until(found, lambda: f"job is {self.job(job_id).state}\n{self.log()[-4000:]}")
        assert job is not None
        return job

    def wait_until_working(self, job_id: str) -> JobRow:
        """Wait until the job is in the middle of its work."""
        return self.wait(job_id, lambda job: job.state is JobState.RUNNING and job.progress_fraction > 0)

    def shorten(self, estimation_id: str) -> None:
        """Let the next attempt of an endless estimation take a second or two."""
        with self.database.writing() as session:
            row = catalog.get_estimation(session, estimation_id)
            row.settings = {**row.settings, "samples": 40}

    def states(self, job_id: str) -> list[str]:
        """The states that the job has gone through."""
        with self.database.reading() as session:
            events = list_events(session, job_id)
        assert [event.sequence for event in events] == list(range(1, len(events) + 1))
        return [event.data["state"] for event in events if event.type == "state"]

    def close(self) -> None:
        self.database.close()
