"""Jobs over HTTP: look, cancel, follow; what a client missed is replayed."""

import json
import threading
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any

import httpx
import pytest
from httpx_sse import ServerSentEvent, connect_sse
from service_support import LiveService, problem, running, service, shared_service, tetrahedron
from waiting import PATIENCE_S

from models_store import claims, parts
from models_store.claims import Claim
from models_store.job_kinds import JobKind

__all__ = ["service", "shared_service"]

LEASE = timedelta(minutes=5)


def queue_estimation(service: LiveService) -> str:
    body = {"mesh_id": service.upload(tetrahedron()).json()["id"], "model_id": service.add_model()["id"]}
    job_id: str = service.client.post("/v1/estimations", json=body).json()["job"]["id"]
    return job_id


def follow(service: LiveService, job_id: str, last: str | None = None) -> list[ServerSentEvent]:
    headers = {} if last is None else {"Last-Event-ID": last}
    with connect_sse(service.client, "GET", f"/v1/jobs/{job_id}/events", headers=headers) as source:
        return list(source.iter_sse())


def report(service: LiveService, held: Claim, fraction: float) -> None:
    now = datetime.now(UTC)
    with service.services.database.writing() as session:
        claims.report_progress(session, held, fraction, f"at {fraction}", now=now, lease=LEASE)


def finish(service: LiveService, held: Claim) -> None:
    with service.services.database.writing() as session:
        claims.finish(session, held, now=datetime.now(UTC))


def words(events: list[ServerSentEvent]) -> list[tuple[str, Any]]:
    data = [(event.event, json.loads(event.data)) for event in events]
    return [(kind, content["state"] if kind == "state" else content["fraction"]) for kind, content in data]


def test_a_job_tells_how_it_stands(service: LiveService) -> None:
    job_id = queue_estimation(service)
    url = f"/v1/jobs/{job_id}"
    queued = service.client.get(url).json()
    assert (queued["id"], queued["url"], queued["events_url"]) == (job_id, url, f"{url}/events")
    assert (queued["kind"], queued["state"], queued["attempt"]) == ("estimate", "queued", 0)
    assert queued["progress"] == {"fraction": 0.0, "message": ""}
    assert (queued["error"], queued["started_at"], queued["finished_at"]) == (None, None, None)
    assert queued["created_at"].endswith("Z")
    held = service.claim(job_id)
    report(service, held, 0.25)
    running_job = service.client.get(url).json()
    assert (running_job["state"], running_job["attempt"]) == ("running", 1)
    assert running_job["progress"] == {"fraction": 0.25, "message": "at 0.25"}
    finish(service, held)
    assert service.client.get(url).json()["state"] == "succeeded"


def test_jobs_are_listed_by_state_and_kind(service: LiveService) -> None:
    job_id = queue_estimation(service)

    def listed(**query: str) -> list[str]:
        return [job["id"] for job in service.client.get("/v1/jobs", params=query).json()["items"]]

    assert len(listed()) == 2  # the thumbnail's is the other one
    assert listed(kind="estimate") == [job_id]
    assert listed(kind="estimate", state="running") == []
    service.claim(job_id)
    assert listed(state="running") == [job_id]
    for query in ("state=sleeping", "kind=cook", "limit=0", "limit=201", "limit=many"):
        problem(service.client.get(f"/v1/jobs?{query}"), 422, f"query.{query.partition('=')[0]}")


def test_a_queued_job_is_cancelled_at_once_and_only_once(service: LiveService) -> None:
    url = f"/v1/jobs/{queue_estimation(service)}/cancel"
    response = service.client.post(url)
    assert response.status_code == 202
    assert (response.json()["state"], response.json()["cancel_requested"]) == ("cancelled", True)
    problem(service.client.post(url), 409)


def test_a_running_job_is_asked_to_stop(service: LiveService) -> None:
    job_id = queue_estimation(service)
    held = service.claim(job_id)
    for _ in range(2):  # asking twice is no error
        job = service.client.post(f"/v1/jobs/{job_id}/cancel").json()
        assert (job["state"], job["cancel_requested"]) == ("running", True)
    with service.services.database.writing() as session:
        claims.finish_cancelled(session, held, now=datetime.now(UTC))
    assert words(follow(service, job_id))[-1] == ("state", "cancelled")


def test_a_job_that_is_not_there(shared_service: LiveService) -> None:
    for job_id in ("nope", "0" * 32):
        for method, path in (("GET", ""), ("POST", "/cancel"), ("GET", "/events")):
            problem(shared_service.client.request(method, f"/v1/jobs/{job_id}{path}"), 404)


def test_every_event_is_replayed_after_the_one_seen_last(service: LiveService) -> None:
    job_id = queue_estimation(service)
    held = service.claim(job_id)
    report(service, held, 0.5)
    finish(service, held)
    events = follow(service, job_id)
    assert words(events) == [("state", "queued"), ("state", "running"), ("progress", 0.5), ("state", "succeeded")]
    assert [event.id for event in events] == ["1", "2", "3", "4"]
    for seen in range(4):
        replayed = follow(service, job_id, str(seen))
        assert [(e.id, e.event, e.data) for e in replayed] == [(e.id, e.event, e.data) for e in events[seen:]]
    url = f"/v1/jobs/{job_id}/events"
    done = service.client.get(url, headers={"Last-Event-ID": "4"})
    assert (done.status_code, done.content) == (204, b"")  # tells a browser not to come back
    for wrong in ("-1", "x", "9" * 30):
        problem(service.client.get(url, headers={"Last-Event-ID": wrong}), 422, "header.last-event-id")


@dataclass
class Watcher(threading.Thread):
    """Follows a job from another thread and can be waited for, event by event."""

    service: LiveService
    url: str

    def __post_init__(self) -> None:
        super().__init__(daemon=True)
        self.events: list[ServerSentEvent] = []
        self._more = threading.Condition()
        self.start()

    __hash__ = threading.Thread.__hash__

    def run(self) -> None:
        with (
            httpx.Client(base_url=self.service.client.base_url, timeout=PATIENCE_S) as client,
            connect_sse(client, "GET", self.url) as source,
        ):
            for event in source.iter_sse():
                with self._more:
                    self.events.append(event)
                    self._more.notify_all()

    def wait_for(self, count: int) -> None:
        with self._more:
            assert self._more.wait_for(lambda: len(self.events) >= count, timeout=PATIENCE_S)


def test_a_stream_goes_along_with_the_job_and_ends_with_it(service: LiveService) -> None:
    job_id = queue_estimation(service)
    watchers = [Watcher(service, f"/v1/jobs/{job_id}/events") for _ in range(3)]
    for watcher in watchers:
        watcher.wait_for(1)
    held = service.claim(job_id)
    for watcher in watchers:
        watcher.wait_for(2)
    for step in range(1, 11):
        report(service, held, step / 10)
    finish(service, held)
    for watcher in watchers:
        watcher.join(PATIENCE_S)
        assert not watcher.is_alive()
        assert words(watcher.events) == words(follow(service, job_id))
        assert len(watcher.events) == 13


def test_parts_are_listed_with_their_job_and_a_stream_ends_with_a_withdrawn_one(service: LiveService) -> None:
    job_id = queue_estimation(service)
    held = service.claim(job_id)
    with service.services.database.writing() as session:
        payloads = [{"chunk": number} for number in range(2)]
        ids = parts.add_parts(session, held, JobKind.DESCRIBE_VARIATIONS, payloads, now=datetime.now(UTC))
    listed = service.client.get(f"/v1/jobs?parent_id={job_id}").json()["items"]
    assert {part["id"] for part in listed} == set(ids)
    assert {part["parent_id"] for part in listed} == {job_id}
    assert set(ids).isdisjoint(job["id"] for job in service.client.get("/v1/jobs").json()["items"])
    assert service.client.get("/v1/jobs?parent_id=nobody").json()["items"] == []
    problem(service.client.get("/v1/jobs?parent_id=%00"), 422, "query.parent_id")
    watcher = Watcher(service, f"/v1/jobs/{ids[0]}/events")
    watcher.wait_for(1)
    with service.services.database.writing() as session:
        assert parts.withdraw_part(session, ids[0])
    watcher.join(PATIENCE_S)
    assert not watcher.is_alive()
    assert words(watcher.events) == [("state", "queued")]
    problem(service.client.get(f"/v1/jobs/{ids[0]}"), 404)


def test_a_silent_stream_shows_that_it_is_alive(tmp_path) -> None:
    with running(tmp_path / "data", event_ping_s=0.05) as live:
        job_id = queue_estimation(live)
        with live.client.stream("GET", f"/v1/jobs/{job_id}/events") as response:
            assert response.headers["content-type"].startswith("text/event-stream")
            assert response.headers["cache-control"] == "no-store"
            lines = response.iter_lines()
            assert any(line.startswith(": ping") for line in lines)


def test_a_stream_longer_than_one_page_has_every_event(service: LiveService) -> None:
    job_id = queue_estimation(service)
    held = service.claim(job_id)
    now = datetime.now(UTC)
    with service.services.database.writing() as session:
        for _ in range(2500):
            claims.report_progress(session, held, 0.5, "", now=now, lease=LEASE)
    finish(service, held)
    events = follow(service, job_id)
    assert [event.id for event in events] == [str(number) for number in range(1, 2504)]


def test_head_of_a_stream_does_not_wait_for_it(service: LiveService) -> None:
    job_id = queue_estimation(service)
    response = service.client.head(f"/v1/jobs/{job_id}/events")
    assert (response.status_code, response.headers["allow"]) == (405, "GET")


@pytest.mark.parametrize("times", [1, 3])
def test_a_lost_worker_is_seen_in_the_stream(service: LiveService, times: int) -> None:
    job_id = queue_estimation(service)
    for _ in range(times):
        held = service.claim(job_id)
        with service.services.database.writing() as session:
            claims.release(session, held, now=datetime.now(UTC), counted=True)
    held = service.claim(job_id)
    finish(service, held)
    states = [word for _, word in words(follow(service, job_id))]
    assert states == ["queued", *(["running", "queued"] * times), "running", "succeeded"]
    attempts = [json.loads(event.data)["attempt"] for event in follow(service, job_id)]
    assert attempts[-1] == times + 1
