"""Real worker processes doing real jobs, on the embedded default and on PostgreSQL and Redis; and their accidents."""

import os
import signal
from collections.abc import Iterator
from contextlib import closing
from io import BytesIO
from pathlib import Path
from urllib.request import urlopen

import pytest
from PIL import Image
from processes import children_of, is_alive
from services import RedisServer, free_port
from waiting import PATIENCE_S, wait_until
from worker_support import ENDLESS, Site, brick, now, rod

from models_store import catalog
from models_store.broker import send_wakeup
from models_store.jobs import JobState, list_jobs, request_cancel
from models_store.tables import JobRow
from shapewright.mesh.file import parse_mesh

KINDS = ["embedded", pytest.param("production", marks=pytest.mark.services)]


SHORT_LEASE_S = "2"
"""Lease of a job whose worker is killed in a test."""


@pytest.fixture(params=KINDS)
def site(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Site]:
    settings = {}
    if request.param == "production":
        settings["database_url"] = request.getfixturevalue("postgres_url")
        settings["broker_url"] = request.getfixturevalue("redis_url")
    made = Site(tmp_path, **settings)
    yield made
    made.close()


@pytest.fixture
def embedded(tmp_path: Path) -> Iterator[Site]:
    made = Site(tmp_path)
    yield made
    made.close()


def assert_done_by_a_later_attempt(site: Site, done: JobRow) -> None:
    """However many attempts were lost (on a busy machine a short lease may run out): one succeeded, the last."""
    assert done.state is JobState.SUCCEEDED, done.error_detail
    assert done.attempt >= 2
    assert site.states(done.id) == [*["queued", "running"] * done.attempt, "succeeded"]


def test_jobs_are_done_and_leave_their_results(site: Site) -> None:
    model_id = site.add_model(brick())
    port = free_port()
    with site.worker(SHAPEWRIGHT_METRICS_PORT=str(port)):
        thumbnail_job = site.wait(site.queue_thumbnail(model_id))
        estimation = site.queue_estimation(200)
        done = site.wait(estimation.job_id)
        with urlopen(f"http://127.0.0.1:{port}/metrics") as answer:
            assert b'shapewright_jobs{kind="estimate",state="succeeded"}' in answer.read()
    assert thumbnail_job.state is JobState.SUCCEEDED, thumbnail_job.error_detail
    with site.database.reading() as session:
        key = catalog.get_model(session, model_id).thumbnail_key
    picture = Image.open(BytesIO(site.artifacts.get(key)))
    assert picture.size == (512, 512)
    assert len(picture.getcolors(512 * 512)) > 10

    assert done.state is JobState.SUCCEEDED, done.error_detail
    row = site.estimation(estimation.id)
    assert row.result["complete"] is True
    assert row.result["seconds"] > 0
    (parameter,) = row.result["parameters"]
    assert parameter["name"] == "height"
    assert parameter["value"] == pytest.approx(1.4, abs=0.1)
    assert len(parse_mesh(site.artifacts.get(row.mesh_key), "glb").faces) > 4
    assert site.states(estimation.job_id) == ["queued", "running", "succeeded"]
    log = site.log()
    assert f'"job_id": "{estimation.job_id}"' in log
    assert "Traceback" not in log


def test_a_job_whose_worker_child_is_killed_is_done_once(site: Site) -> None:
    with site.worker(SHAPEWRIGHT_LEASE_S=SHORT_LEASE_S) as worker:
        estimation = site.queue_estimation(ENDLESS, max_attempts=100)
        site.wait_until_working(estimation.job_id)
        site.shorten(estimation.id)
        (child,) = children_of(worker.pid)
        os.kill(child, signal.SIGKILL)
        done = site.wait(estimation.job_id)
        # nobody comes back and does it again: whatever was announced before this is through when it is done
        site.wait(site.queue_thumbnail(site.add_model(rod())))
    assert_done_by_a_later_attempt(site, done)
    assert site.estimation(estimation.id).mesh_key == f"estimations/{estimation.id}-{done.attempt}.glb"


def test_a_job_of_a_worker_that_is_killed_is_done_by_the_next(embedded: Site) -> None:
    estimation = embedded.queue_estimation(ENDLESS, max_attempts=100)
    with embedded.worker(SHAPEWRIGHT_LEASE_S=SHORT_LEASE_S) as worker:
        embedded.wait_until_working(estimation.job_id)
        embedded.shorten(estimation.id)
        children = children_of(worker.pid)
        worker.kill()
        worker.wait()
        wait_until(lambda: not any(is_alive(pid) for pid in children), lambda: "a child outlives its worker")
    with embedded.worker(SHAPEWRIGHT_LEASE_S=SHORT_LEASE_S):
        done = embedded.wait(estimation.job_id)
    assert_done_by_a_later_attempt(embedded, done)


def test_a_cancelled_estimation_stops_and_keeps_its_best(embedded: Site) -> None:
    with embedded.worker():
        estimation = embedded.queue_estimation(ENDLESS)
        embedded.wait_until_working(estimation.job_id)
        with embedded.database.writing() as session:
            request_cancel(session, estimation.job_id, now=now())
        ended = embedded.wait(estimation.job_id)
    assert ended.state is JobState.CANCELLED
    row = embedded.estimation(estimation.id)
    assert row.result["complete"] is False
    assert embedded.artifacts.exists(row.mesh_key)


def test_a_worker_that_is_told_to_stop_gives_its_job_back(embedded: Site) -> None:
    estimation = embedded.queue_estimation(ENDLESS, max_attempts=1)
    with embedded.worker(SHAPEWRIGHT_SHUTDOWN_GRACE_S="0.2") as worker:
        embedded.wait_until_working(estimation.job_id)
        children = children_of(worker.pid)
        worker.send_signal(signal.SIGTERM)
        assert worker.wait(PATIENCE_S) == 0
    assert not any(is_alive(pid) for pid in children)
    job = embedded.job(estimation.job_id)
    assert (job.state, job.attempt) == (JobState.QUEUED, 0)
    assert embedded.states(estimation.job_id) == ["queued", "running", "queued"]


@pytest.mark.services
def test_a_busy_worker_keeps_no_message_from_a_free_one(tmp_path: Path, postgres_url: str, redis_url: str) -> None:
    site = Site(tmp_path, database_url=postgres_url, broker_url=redis_url, wakeup_after_s=600.0)
    model_id = site.add_model(brick())
    with closing(site), site.worker():
        estimation = site.queue_estimation(ENDLESS)
        site.wait_until_working(estimation.job_id)
        with site.worker():
            for _ in range(4):
                assert site.wait(site.queue_thumbnail(model_id)).state is JobState.SUCCEEDED
        with site.database.writing() as session:
            request_cancel(session, estimation.job_id, now=now())
        site.wait(estimation.job_id)


def test_free_workers_take_parts_of_a_training(site: Site) -> None:
    settings = {
        "variations": 256, "images_per_variation": 2, "image_size": 64, "subdivision_steps": 1, "negatives": 0,
        "exemplars": False,
    }  # fmt: skip
    models = [site.add_model(brick()), site.add_model(rod())]
    with site.worker(), site.worker():
        with site.database.writing() as session:
            training = catalog.request_classifier(session, models, settings, now=now())
        send_wakeup(site.sender, training.job)
        done = site.wait(training.job_id)
    assert done.state is JobState.SUCCEEDED, done.error_detail
    with site.database.reading() as session:
        parts = list_jobs(session, parent_id=training.job_id).items
        assert catalog.get_classifier(session, training.id).metrics["images"] == 2 * 256 * 2
    assert {part.state for part in parts} == {JobState.SUCCEEDED}
    assert {part.worker for part in parts}.isdisjoint({None, done.worker})


@pytest.mark.services
def test_a_job_waits_for_the_broker_to_come_back(tmp_path: Path) -> None:
    server = RedisServer.start()
    site = Site(tmp_path, broker_url=server.url)
    try:
        model_id = site.add_model(brick())
        # No job before this one: an announcement that a worker has taken already makes it look for any job.
        with site.worker():
            server.stop()
            with site.database.writing() as session:
                job = catalog.request_thumbnail(session, model_id, now=now())
            assert send_wakeup(site.sender, job) is False
            wait_until(lambda: f"broker away, job {job.id} stays queued" in site.log(), site.log)
            assert site.states(job.id) == ["queued"]
            server = RedisServer.start(server.port)
            assert site.wait(job.id).state is JobState.SUCCEEDED
    finally:
        server.stop()
        site.close()
