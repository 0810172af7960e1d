"""The API process: what it may load, and that it goes when it is told to."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import httpx
from service_support import box, tetrahedron
from services import free_port, logged_process
from waiting import PATIENCE_S

from models_store.library.shipped import list_classes

HEAVY = ("torch", "moderngl", "numba", "llvmlite", "onnxruntime", "onnx", "workers", "cli", "matplotlib")

PROGRAM = """
import json, sys, threading
sys.path.insert(0, sys.argv[2])
from pathlib import Path
from service_support import box, running, tetrahedron

def loaded(names):
    return [name for name in names if name in sys.modules]

with running(Path(sys.argv[1]), add_shipped_on_start=True) as live:
    heavy = sys.argv[3].split(",")
    at_start = loaded(heavy)
    shipped = len(live.client.get("/v1/classes").json()["items"])
    model, mesh = live.add_model("box"), live.upload(tetrahedron()).json()
    crate = live.add_model("crate")
    post = live.client.post
    answers = [
        post(f"/v1/models/{model['id']}/instances", json={"seed": 1}),
        post("/v1/classifiers", json={"model_ids": [model["id"], crate["id"]], "settings": {"epochs": 2}}),
        post("/v1/estimations", json={"mesh_id": mesh["id"], "model_id": model["id"], "settings": {"samples": 9}}),
        live.client.get(mesh["content_url"]),
        live.client.get("/v1/jobs"),
        live.client.get("/metrics"),
        live.client.get("/readyz"),
        live.client.get("/openapi.json"),
    ]
    statuses = [answer.status_code for answer in answers]
    print(json.dumps({"at_start": at_start, "after_requests": loaded(heavy), "statuses": statuses, "shipped": shipped}))
"""


def test_the_api_loads_what_evaluates_models_when_asked_and_nothing_else_that_is_heavy(
    repository: Path, tmp_path: Path
) -> None:
    command = [sys.executable, "-c", PROGRAM, str(tmp_path / "data"), str(repository / "tests"), ",".join(HEAVY)]
    run = subprocess.run(command, cwd=repository, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    told = json.loads(run.stdout.splitlines()[-1])
    assert told.pop("shipped") == len(list_classes())
    evaluates = ["numba", "llvmlite"]
    assert told == {"at_start": [], "after_requests": evaluates, "statuses": [200, 202, 202, 200, 200, 200, 200, 200]}


def test_nothing_is_opened_at_import(repository: Path, tmp_path: Path) -> None:
    code = "import os, service.app, service.openapi; print(os.listdir('.'))"
    environment = {**os.environ, "PYTHONPATH": str(repository)}
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert run.stdout.strip() == "[]"


def test_a_server_that_is_stopped_ends_its_streams(repository: Path, tmp_path: Path) -> None:
    """Without a grace period the server would wait for the open stream for ever, if nobody ended it."""
    port = free_port()
    command = [
        *(sys.executable, "-m", "uvicorn", "--factory", "service.app:create_app"),
        *("--host", "127.0.0.1", "--port", str(port)),
    ]
    environment = {**os.environ, "SHAPEWRIGHT_DATA_DIR": str(tmp_path / "data"), "PYTHONPATH": str(repository)}
    transport = httpx.HTTPTransport(retries=8)
    with (
        logged_process(command, log=tmp_path / "api.log", cwd=tmp_path, env=environment) as process,
        httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE_S, transport=transport) as client,
    ):
        model = client.post("/v1/models", json=box()).json()
        mesh = client.post("/v1/meshes", files={"file": ("a.off", tetrahedron())}).json()
        body = {"mesh_id": mesh["id"], "model_id": model["id"]}
        job = client.post("/v1/estimations", json=body).json()["job"]
        with client.stream("GET", job["events_url"]) as response:
            lines = response.iter_lines()
            assert any(line.startswith("data:") for line in lines)
            process.send_signal(signal.SIGTERM)
            try:
                for _ in lines:
                    pass
            except httpx.RemoteProtocolError:
                pass  # the stream is cut: a client comes back with the last id it saw
        process.wait(timeout=PATIENCE_S)
    log = (tmp_path / "api.log").read_text()
    assert "Application shutdown complete" in log
    assert "Traceback" not in log
