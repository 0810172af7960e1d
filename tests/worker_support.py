"""Real workers in processes of their own, and jobs for them, without a service in between."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from types import MappingProxyType
from typing import Any
from uuid import uuid4

import numpy as np
from services import logged_process

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
}
"""Settings of an estimation that takes a second beside its bank, which takes about one for 1000 samples."""
TIMEOUT_S = 90.0


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
        given = {"lease_s": 2.0, "wakeup_after_s": 0.5, **settings}
        self.settings = StoreSettings(data_dir=folder / "data", **given)
        self.database = Database.connect(self.settings)
        upgrade(self.database.engine)
        self.artifacts = ArtifactStore.open(self.settings.artifacts_url)
        self.sender = create_sender(self.settings)
        self.log = folder / "worker.log"
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
            **{f"SHAPEWRIGHT_{name.upper()}": str(value) for name, value in given.items()},
        }

    @contextmanager
    def worker(self, **environment: str) -> Iterator["subprocess.Popen[bytes]"]:
        """A worker as people start it, until the end of the block."""
        command = [sys.executable, "-m", "celery", "-A", "workers.app", "worker", "-n", f"{uuid4().hex}@%h"]
        env = self._environment | environment
        with logged_process(command, log=self.log, cwd=self.settings.data_dir, env=env) as process:
            yield process

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
        deadline = time.monotonic() + TIMEOUT_S
        while not until(job := self.job(job_id)):
            if time.monotonic() > deadline:
                log = self.log.read_text(errors="replace")[-4000:] if self.log.exists() else ""
                raise AssertionError(f"job is {job.state} at {job.progress_fraction}\n{log}")
            time.sleep(0.05)
        return job

    def wait_until_working(self, job_id: str) -> JobRow:
        """Wait until the job is in the middle of its work."""
        return self.wait(job_id, lambda job: job.state is JobState.RUNNING and job.progress_fraction > 0)

    def states(self, job_id: str) -> list[str]:
        """The states that the job has gone through."""
        with self.database.reading() as session:
            events = list_events(session, job_id)
        assert [event.sequence for event in events] == list(range(1, len(events) + 1))
        return [event.data["state"] for event in events if event.type == "state"]

    def close(self) -> None:
        self.database.close()


def children_of(process: "subprocess.Popen[bytes]") -> list[int]:
    path = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    return [int(pid) for pid in path.read_text().split()]


def is_alive(pid: int) -> bool:
    """Whether a process runs; a zombie that waits for init does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False
