"""`shapewright serve`: service and worker together on the embedded default, and gone together."""

import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from command_line import write_lamp_model
from processes import children_of, is_alive
from waiting import PATIENCE_S, wait_until

from cli.client import Client, ServiceError, connected
from cli.local_service import local_service


@dataclass(frozen=True)
class Serving:
    """A running `shapewright serve`."""

    document: dict[str, Any]
    log: Path
    client: Client


@pytest.fixture
def serving(tmp_path: Path) -> Iterator[Serving]:
    log = tmp_path / "service.log"
    with (
        local_service(tmp_path / "data", port=0, log=log) as document,
        connected(document["url"], ready_within_s=PATIENCE_S) as client,
    ):
        yield Serving(document, log, client)


def _thumbnail(client: Client, model_id: str) -> bytes:
    def drawn() -> bytes:
        with contextlib.suppress(ServiceError):
            return client.get_bytes(f"/v1/models/{model_id}/thumbnail")
        return b""

    return wait_until(drawn)


def test_a_model_gets_its_thumbnail_also_after_the_worker_was_killed(serving: Serving, tmp_path: Path) -> None:
    lamp = write_lamp_model(tmp_path).read_text()
    model, new = serving.client.post_document("/v1/models", lamp)
    assert new
    assert _thumbnail(serving.client, model["id"])[:4] == b"\x89PNG"

    os.kill(serving.document["worker_pid"], signal.SIGKILL)
    second, _ = serving.client.post_document("/v1/models", lamp.replace('"lamp"', '"lamp_two"'))
    assert second["id"] != model["id"]
    assert _thumbnail(serving.client, second["id"])[:4] == b"\x89PNG"
    assert "the worker died (status -9); started again" in serving.log.read_text()


def test_the_address_of_the_dashboard_answers(serving: Serving) -> None:
    assert b"<html" in serving.client.get_bytes(serving.document["dashboard_url"]).lower()
    assert serving.client.get(serving.document["openapi_url"])["info"]["title"] == "Shapewright"


@pytest.mark.parametrize("request_to_stop", [signal.SIGINT, signal.SIGTERM])
def test_one_signal_ends_all_of_it(tmp_path: Path, request_to_stop: signal.Signals) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "cli", "serve", "--json", "--port", "0", "--data-dir", str(tmp_path / "data")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    assert process.stdout is not None
    text = b""
    while not text.endswith(b"}\n"):
        line = process.stdout.readline()
        assert line, process.stderr.read() if process.stderr else ""
        text += line
    worker = json.loads(text)["worker_pid"]
    everybody = [process.pid, worker, *children_of(worker)]
    process.send_signal(request_to_stop)
    _, messages = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0, messages.decode()
    wait_until(lambda: not any(is_alive(pid) for pid in everybody))


def test_a_busy_port_is_one_line(tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = subprocess.run(
            [sys.executable, "-m", "cli", "serve", "--port", str(port), "--data-dir", str(tmp_path / "data")],
            capture_output=True,
            text=True,
        )
    assert done.returncode == 2
    assert done.stderr == f"shapewright: 127.0.0.1:{port}: cannot listen there: Address already in use\n"
    assert not (tmp_path / "data").exists()


def test_a_wrong_setting_is_one_line_that_names_the_variable(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "cli", "serve", "--port", "0", "--data-dir", str(tmp_path / "data")],
        capture_output=True,
        text=True,
        env={**os.environ, "SHAPEWRIGHT_LEASE_S": "soon"},
    )
    assert done.returncode == 2
    assert done.stderr.startswith("shapewright: SHAPEWRIGHT_LEASE_S: ")
    assert len(done.stderr.strip().splitlines()) == 1
