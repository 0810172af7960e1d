"""A service with its worker in a child process, for programs that want one for a while."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cli.child_process import die_with_parent
from cli.client import ServiceError

STOP_TIMEOUT_S = 30.0


@contextmanager
def local_service(data_dir: Path, *, port: int, log: Path) -> Iterator[dict[str, Any]]:
    """Run `shapewright serve` until the end of the block; yields the document that it prints (``url``, ``pid``…).

    Args:
        data_dir: its folder.
        port: 0 takes a free one.
        log: file for the messages of the service and the worker.

    Raises:
        ServiceError: it does not start; the message holds its last line.
    """
    command = [sys.executable, "-m", "cli", "serve", "--json", "--port", str(port), "--data-dir", str(data_dir)]
    with log.open("wb") as messages:
        process = subprocess.Popen(
            [*command, "--log-level", "info"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=messages,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
            start_new_session=True,  # Ctrl-C is for us; we then stop the service in order
            preexec_fn=die_with_parent,
        )
    try:
        yield _read_announcement(process, log)
    finally:
        _stop(process)


def _read_announcement(process: "subprocess.Popen[bytes]", log: Path) -> dict[str, Any]:
    assert process.stdout is not None
    text = ""
    for line in process.stdout:
        text += line.decode(errors="replace")
        if line.rstrip() == b"}":
            document: dict[str, Any] = json.loads(text)
            return document
    lines = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    raise ServiceError(f"the service did not start: {lines[-1] if lines else 'no message'}", where=str(log))


def _stop(process: "subprocess.Popen[bytes]") -> None:
    if process.poll() is None:
        process.send_signal(signal.SIGTERM)
    try:
        process.wait(timeout=STOP_TIMEOUT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    if process.stdout is not None:
        process.stdout.close()
