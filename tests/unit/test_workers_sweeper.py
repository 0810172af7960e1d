"""The sweeper lives through outages, and does what the sweep says."""

import threading
from datetime import timedelta
from pathlib import Path

import pytest
from prometheus_client import generate_latest
from services import free_port
from store_support import FakeClock, clock, database, queue_job  # noqa: F401 - fixtures

from models_store import claims
from models_store.broker import QUEUE, create_sender
from models_store.jobs import JobState, get_job
from models_store.session import Database
from workers.metrics import SweeperMetrics
from workers.settings import WorkerSettings
from workers.sweeper import Sweeper


def messages(settings: WorkerSettings) -> int:
    return len(list((settings.embedded_broker_folder / QUEUE).glob("*.message")))


def test_it_requeues_announces_and_counts(tmp_path: Path, clock: FakeClock) -> None:  # noqa: F811
    settings = WorkerSettings(data_dir=tmp_path)
    metrics = SweeperMetrics()
    sweeper = Sweeper(settings, create_sender(settings), metrics, clock)
    sweeper.sweep_once()  # makes the tables
    with_jobs = Database.connect(settings)
    job_id = queue_job(with_jobs, clock.now)
    with with_jobs.writing() as session:
        claims.claim(session, job_id, now=clock.now, lease=timedelta(seconds=30))
    sweeper.sweep_once()
    assert messages(settings) == 0
    clock.forward(31)
    sweeper.sweep_once()
    assert messages(settings) == 1
    with with_jobs.reading() as session:
        assert get_job(session, job_id).state is JobState.QUEUED
    with_jobs.close()
    text = generate_latest(metrics.registry).decode()
    assert 'shapewright_jobs{kind="estimate",state="queued"} 1.0' in text
    assert 'shapewright_lost_workers_total{state="queued"} 1.0' in text
    assert "shapewright_wakeups_resent_total 1.0" in text


def test_it_waits_for_the_broker(tmp_path: Path, clock: FakeClock) -> None:  # noqa: F811
    settings = WorkerSettings(data_dir=tmp_path)
    sweeper = Sweeper(settings, create_sender(settings), clock=clock)
    sweeper.sweep_once()
    jobs = Database.connect(settings)
    for _ in range(3):
        queue_job(jobs, clock.now)
    jobs.close()
    settings.embedded_broker_folder.write_text("in the way")
    sweeper.sweep_once()
    settings.embedded_broker_folder.unlink()
    clock.forward(settings.wakeup_after_s)
    sweeper.sweep_once()
    assert messages(settings) == 3


def test_it_waits_for_the_database(tmp_path: Path) -> None:
    url = f"postgresql://nobody@127.0.0.1:{free_port()}/nothing"
    settings = WorkerSettings(data_dir=tmp_path, database_url=url, sweep_interval_s=0.01)
    sweeper = Sweeper(settings, create_sender(settings))
    sweeper.start()
    alive = [thread for thread in threading.enumerate() if thread.name == "sweeper"]
    assert alive
    sweeper.stop()


@pytest.mark.parametrize("word", ["app", "nothing"])
def test_the_application_is_made_when_it_is_asked_for(
    word: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import workers.app

    monkeypatch.setenv("SHAPEWRIGHT_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setattr(workers.app, "_app", None)
    if word == "app":
        assert workers.app.app is workers.app.app
        assert not (tmp_path / "data").exists()
    else:
        with pytest.raises(AttributeError):
            _ = workers.app.nothing
