"""What the tests of the service share: a real server in a thread, and small things to send to it."""

import json
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
import uvicorn
from fastapi import FastAPI
from waiting import PATIENCE_S

from models_store import claims
from models_store.jobs import get_job
from service.app import create_app
from service.dependencies import Services
from service.settings import ServiceSettings
from shapewright.modeling import Recorder

GLB = "model/gltf-binary"
PROBLEM = "application/problem+json"
NOWHERE = "redis://127.0.0.1:1/0"
"""A broker that is away: nothing listens on port 1."""


@dataclass
class LiveService:
    """A running service and a client that speaks with it."""

    app: FastAPI
    client: httpx.Client
    data_dir: Path

    @property
    def services(self) -> Services:
        services: Services = self.app.state.services
        return services

    def upload(self, data: bytes, file_name: str = "mesh.off") -> httpx.Response:
        return self.client.post("/v1/meshes", files={"file": (file_name, data)})

    def add_model(self, class_name: str = "box", height: float = 1.0) -> dict[str, Any]:
        return self.add_document(box(class_name, height))

    def add_document(self, document: Any) -> dict[str, Any]:
        response = self.client.post("/v1/models", json=document)
        assert response.status_code in (200, 201), response.text
        return response.json()

    def claim(self, job_id: str) -> claims.Claim:
        """Take a job as a worker does."""
        with self.services.database.writing() as session:
            held = claims.claim(session, job_id, now=datetime.now(UTC), lease=timedelta(minutes=5))
        assert held is not None
        return held

    def work(self, job_id: str, record: Callable[[Any], None]) -> None:
        """Take a job, report progress and end it well, writing its result in the same transaction."""
        held = self.claim(job_id)
        now = datetime.now(UTC)
        with self.services.database.writing() as session:
            claims.report_progress(session, held, 0.5, "half-way", now=now, lease=timedelta(minutes=5))
        with self.services.database.writing() as session:
            claims.finish(session, held, now=now)
            record(session)

    def fail(self, job_id: str, title: str, detail: str, where: str | None = None) -> None:
        held = self.claim(job_id)
        with self.services.database.writing() as session:
            claims.fail(session, held, claims.JobError(title, detail, where), now=datetime.now(UTC))

    def state_of(self, job_id: str) -> str:
        with self.services.database.reading() as session:
            return get_job(session, job_id).state.value

    def artifacts(self) -> list[Path]:
        """Every file in the artefact folder, half-written ones included."""
        return sorted(path for path in (self.data_dir / "artifacts").rglob("*") if path.is_file())

    def assert_nothing_left(self) -> None:
        asked = ("classifications", "estimations", "collection-estimations", "collections", "retrievals")
        for resource in ("models", "meshes", "classifiers", *asked, "jobs"):
            assert self.client.get(f"/v1/{resource}").json()["items"] == [], resource
        assert self.artifacts() == []


@contextmanager
def running(data_dir: Path, **settings: Any) -> Iterator[LiveService]:
    """Run the service on a free port in a thread of this process; without what ships, if the settings do not ask."""
    options = {
        "add_shipped_on_start": False,
        "event_poll_s": 0.02,
        "broker_timeout_s": 0.5,
        "log_level": "CRITICAL",
        **settings,
    }
    app = create_app(ServiceSettings(data_dir=data_dir, **options))
    with socket.create_server(("127.0.0.1", 0)) as listener:
        config = uvicorn.Config(app, log_config=None, ws="none", lifespan="on", timeout_graceful_shutdown=2)
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
        thread.start()
        try:
            with httpx.Client(base_url=f"http://127.0.0.1:{listener.getsockname()[1]}", timeout=PATIENCE_S) as client:
                client.get("/healthz").raise_for_status()
                yield LiveService(app, client, data_dir)
        finally:
            server.should_exit = True
            thread.join(PATIENCE_S)
    assert not thread.is_alive()


@pytest.fixture
def service(tmp_path: Path) -> Iterator[LiveService]:
    """A service with an empty store."""
    with running(tmp_path / "data") as live:
        yield live


@pytest.fixture(scope="module")
def shared_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveService]:
    """A service for the tests of a module that leave nothing behind, or do not care."""
    with running(tmp_path_factory.mktemp("service") / "data") as live:
        yield live


def box(class_name: str = "box", height: float = 1.0) -> dict[str, Any]:
    """The document of a box with a neck; ``neck_length`` and ``neck_size`` can be varied."""
    recorder = Recorder(class_name, class_name, description="a box with a neck")
    recorder.parameter("neck_length", "neck length", 0.5, 2.0, unit="mm", base_value=40.0)
    recorder.parameter("neck_size", "neck size", 0.5, 1.5)
    body = recorder.box(1.0, 1.0, height)
    recorder.extrude(body.top, 0.5, length="neck_length")
    recorder.scale(body.top, 0.5, "uv", size="neck_size")
    document: dict[str, Any] = json.loads(recorder.build().to_json())
    return document


def tetrahedron(size: float = 1.0) -> bytes:
    """An OFF file; each size is another mesh."""
    lines = ["OFF", "4 4 6", "0 0 0", f"{size} 0 0", f"0 {size} 0", f"0 0 {size}"]
    return "\n".join([*lines, "3 0 2 1", "3 0 1 3", "3 1 2 3", "3 0 3 2", ""]).encode()


def problem(response: httpx.Response, status: int, where: str | None = None) -> dict[str, Any]:
    """Check that a response is a problem document of this status and place, and return it."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == PROBLEM
    assert response.headers["cache-control"] == "no-store"
    document: dict[str, Any] = response.json()
    assert document["status"] == status
    assert document["type"].startswith("urn:problem-type:shapewright:")
    assert document["title"]
    assert document["detail"]
    assert document["request_id"] == response.headers["x-request-id"]
    if where is not None:
        assert document["where"] == where, document
    return document
