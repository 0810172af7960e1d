"""What a worker's child process loads as it starts, and its parent does not."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from structlog.testing import capture_logs

from shapewright.estimation.fast import warm_up
from workers.warming import load_estimation

CHILD = """
import json, sys, threading
from celery import signals
from workers.app import create_celery
from workers.settings import WorkerSettings

WATCHED = ("numba", "sqlalchemy", "shapewright.estimation.fast.estimator", "workers.runner")

def loaded():
    return [name for name in WATCHED if name in sys.modules]

celery = create_celery(WorkerSettings(data_dir=sys.argv[1], warm_up=sys.argv[2] == "warm"))
parent = loaded()
signals.worker_process_init.send(sender="test")
for thread in threading.enumerate():
    if thread.name == "warm-up":
        thread.join()
kernels = "numba" in sys.modules and {
    name: bool(getattr(sys.modules["shapewright.estimation.fast." + module], name).signatures)
    for module, name in (("pose_kernels", "score_rotations"), ("matching_kernels", "match_to_triangles"))
}
print(json.dumps({"parent": parent, "child": loaded(), "kernels": kernels}))
"""


def started(folder: Path, how: str) -> dict[str, object]:
    """Start what becomes a child process; return what was loaded before and after."""
    command = [sys.executable, "-c", CHILD, str(folder), how]
    run = subprocess.run(command, check=True, capture_output=True, text=True)
    found: dict[str, object] = json.loads(run.stdout.splitlines()[-1])  # after the log
    return found


def test_a_child_is_ready_for_an_estimation_before_its_first_job(tmp_path: Path) -> None:
    warm_up.warm_up()  # compiled kernels lie in the cache
    found = started(tmp_path, "warm")
    assert found["parent"] == []
    assert found["child"] == ["numba", "sqlalchemy", "shapewright.estimation.fast.estimator", "workers.runner"]
    assert found["kernels"] == {"score_rotations": True, "match_to_triangles": True}


def test_a_child_loads_nothing_if_it_is_told_so(tmp_path: Path) -> None:
    found = started(tmp_path, "cold")
    assert found == {"parent": [], "child": [], "kernels": False}


def test_a_child_starts_although_its_kernels_cannot_be_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> bool:
        raise RuntimeError("the cache is broken")

    monkeypatch.setattr(warm_up, "load_kernels", broken)
    with capture_logs() as logs:
        load_estimation().join()
    assert [entry["log_level"] for entry in logs] == ["error"]
