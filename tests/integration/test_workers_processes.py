"""Real worker processes doing real jobs, on the embedded default and on PostgreSQL and Redis; and their accidents."""

import os
import signal
import time
from collections.abc import Iterator
from contextlib import closing
from io import BytesIO
from pathlib import Path
from urllib.request import urlopen

import pytest
from PIL import Image
from services import RedisServer, free_port
from worker_support import Site, brick, children_of, is_alive, now, rod

from models_store import catalog
from models_store.broker import send_wakeup
from models_store.jobs import JobState, list_jobs, request_cancel
from shapewright.mesh.file import parse_mesh

KINDS = ["embedded", pytest.param("production", marks=pytest.mark.services)]


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
    log = site.log.read_text()
    assert f'"job_id": "{estimation.job_id}"' in log
    assert "Traceback" not in log


def test_a_job_whose_worker_child_is_killed_is_done_once(site: Site) -> None:
    with site.worker() as worker:
        estimation = site.queue_estimation(800)
        site.wait_until_working(estimation.job_id)
        (child,) = children_of(worker)
        os.kill(child, signal.SIGKILL)
        done = site.wait(estimation.job_id)
        time.sleep(1.0)  # nobody comes back and does it again
    assert (done.state, done.attempt) == (JobState.SUCCEEDED, 2)
    assert site.states(estimation.job_id) == ["queued", "running", "queued", "running", "succeeded"]
    assert site.estimation(estimation.id).mesh_key == f"estimations/{estimation.id}-2.glb"


def test_a_job_of_a_worker_that_is_killed_is_done_by_the_next(embedded: Site) -> None:
    estimation = embedded.queue_estimation(800)
    with embedded.worker() as worker:
        embedded.wait_until_working(estimation.job_id)
        children = children_of(worker)
        worker.kill()
        worker.wait()
        deadline = time.monotonic() + 20
        while any(is_alive(pid) for pid in children):
            assert time.monotonic() < deadline, "a child outlives its worker"
            time.sleep(0.05)
    with embedded.worker():
        done = embedded.wait(estimation.job_id)
    assert (done.state, done.attempt) == (JobState.SUCCEEDED, 2)
    assert embedded.states(estimation.job_id) == ["queued", "running", "queued", "running", "succeeded"]


def test_a_cancelled_estimation_stops_and_keeps_its_best(embedded: Site) -> None:
    with embedded.worker():
        estimation = embedded.queue_estimation(200_000)
        embedded.wait_until_working(estimation.job_id)
        with embedded.database.writing() as session:
            request_cancel(session, estimation.job_id, now=now())
        ended = embedded.wait(estimation.job_id)
    assert ended.state is JobState.CANCELLED
    row = embedded.estimation(estimation.id)
    assert row.result["complete"] is False
    assert embedded.artifacts.exists(row.mesh_key)


def test_a_worker_that_is_told_to_stop_gives_its_job_back(embedded: Site) -> None:
    estimation = embedded.queue_estimation(200_000, max_attempts=1)
    with embedded.worker(SHAPEWRIGHT_SHUTDOWN_GRACE_S="0.2") as worker:
        embedded.wait_until_working(estimation.job_id)
        children = children_of(worker)
        worker.send_signal(signal.SIGTERM)
        assert worker.wait(30) == 0
    assert not any(is_alive(pid) for pid in children)
    job = embedded.job(estimation.job_id)
    assert (job.state, job.attempt) == (JobState.QUEUED, 0)
    assert embedded.states(estimation.job_id) == ["queued", "running", "queued"]


@pytest.mark.services
def test_a_busy_worker_keeps_no_message_from_a_free_one(tmp_path: Path, postgres_url: str, redis_url: str) -> None:
    site = Site(tmp_path, database_url=postgres_url, broker_url=redis_url, wakeup_after_s=600.0)
    model_id = site.add_model(brick())
    with closing(site), site.worker():
        estimation = site.queue_estimation(200_000)
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
        with site.worker():
            assert site.wait(site.queue_thumbnail(model_id)).state is JobState.SUCCEEDED
            server.stop()
            with site.database.writing() as session:
                job = catalog.request_thumbnail(session, model_id, now=now())
            assert send_wakeup(site.sender, job) is False
            time.sleep(2.0)  # sweeps come and go
            assert site.job(job.id).state is JobState.QUEUED
            server = RedisServer.start(server.port)
            assert site.wait(job.id).state is JobState.SUCCEEDED
    finally:
        server.stop()
        site.close()
