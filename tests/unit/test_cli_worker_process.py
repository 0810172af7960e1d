"""The watcher of the worker, tried on small programs that stand in for it."""

import os
import sys
import threading
from pathlib import Path

from processes import is_alive
from waiting import PATIENCE_S, wait_until

from cli.worker_process import GIVE_UP_AFTER, WorkerProcess


def _program(source: str) -> list[str]:
    return [sys.executable, "-c", source]


def _wait_for(path: Path, lines: int) -> list[str]:
    wait_until(lambda: path.exists() and path.read_text().count("\n") >= lines)
    return path.read_text().splitlines()


def test_a_worker_that_dies_is_reported_and_started_again(tmp_path: Path) -> None:
    starts = tmp_path / "starts"
    source = f"import os, time; open({str(starts)!r}, 'a').write(f'{{os.getpid()}}\\n'); time.sleep(600)"
    told: list[str] = []
    worker = WorkerProcess(_program(source), os.environ, told.append)
    first = worker.start()
    try:
        assert _wait_for(starts, 1) == [str(first)]
        os.kill(first, 9)
        assert int(_wait_for(starts, 2)[1]) != first
    finally:
        worker.stop()
    assert "died (status -9)" in told[0]
    assert not any(is_alive(int(pid)) for pid in starts.read_text().split())


def test_a_worker_that_keeps_dying_is_given_up() -> None:
    given_up = threading.Event()
    told: list[str] = []

    def say(message: str) -> None:
        told.append(message)
        if "not started again" in message:
            given_up.set()

    worker = WorkerProcess(_program("raise SystemExit(3)"), os.environ, say, pause_s=0.01)
    worker.start()
    assert given_up.wait(PATIENCE_S)
    worker.stop()
    assert len(told) == GIVE_UP_AFTER
    assert "status 3" in told[-1]


def test_stop_ends_a_worker_that_will_not_and_its_children(tmp_path: Path) -> None:
    pids = tmp_path / "pids"
    source = (
        "import os, signal, subprocess, sys, time\n"
        "signal.signal(signal.SIGTERM, signal.SIG_IGN); signal.signal(signal.SIGQUIT, signal.SIG_IGN)\n"
        "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)'])\n"
        f"open({str(pids)!r}, 'w').write(f'{{os.getpid()}}\\n{{child.pid}}\\n')\n"
        "time.sleep(600)\n"
    )
    worker = WorkerProcess(_program(source), os.environ, print, grace_s=0.3)
    worker.start()
    stubborn, child = (int(line) for line in _wait_for(pids, 2))
    worker.stop()
    assert not is_alive(stubborn)
    wait_until(lambda: not isis_alive(child))  # an orphan is reaped by init, which may take a moment
