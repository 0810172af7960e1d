"""Lists: a walk over the pages sees everything once, whatever comes in between; a cursor is ours or refused."""

import base64
import json
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from service_support import LiveService, problem, running
from sqlalchemy import delete

from models_store.jobs import JobKind, create_job, new_id
from models_store.tables import JobEventRow, JobRow

START = datetime(2030, 1, 1, tzinfo=UTC)


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveService]:
    with running(tmp_path_factory.mktemp("paging") / "data") as service:
        yield service


def add_jobs(live: LiveService, seconds: list[int]) -> set[str]:
    with live.services.database.writing() as session:
        return {
            create_job(session, JobKind.ESTIMATE, new_id(), {}, now=START + timedelta(seconds=second)).id
            for second in seconds
        }


def clear(live: LiveService) -> None:
    with live.services.database.writing() as session:
        session.execute(delete(JobEventRow))
        session.execute(delete(JobRow))


@settings(
    max_examples=25,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
@given(st.lists(st.integers(0, 3), max_size=25), st.integers(1, 8), st.lists(st.integers(0, 5), max_size=4))
@example([0] * 12, 4, [])
def test_a_walk_sees_everything_once(live: LiveService, seconds: list[int], limit: int, arriving: list[int]) -> None:
    """Jobs of the same moment, and new ones that arrive during the walk, neither hide nor repeat another."""
    clear(live)
    there = add_jobs(live, seconds)
    seen: list[str] = []
    moments: list[str] = []
    cursor = None
    while True:
        query = {"limit": str(limit)} | ({} if cursor is None else {"cursor": cursor})
        page = live.client.get("/v1/jobs", params=query).json()
        assert len(page["items"]) <= limit
        assert len(page["items"]) == limit or page["next_cursor"] is None
        seen += [job["id"] for job in page["items"]]
        moments += [job["created_at"] for job in page["items"]]
        cursor = page["next_cursor"]
        if cursor is None:
            break
        if arriving:
            add_jobs(live, [arriving.pop()])
    assert len(seen) == len(set(seen))
    assert there <= set(seen)
    assert moments == sorted(moments, reverse=True)


def forged(*content: object) -> str:
    return base64.urlsafe_b64encode(json.dumps(content).encode()).decode()


@pytest.mark.parametrize(
    "cursor",
    [
        "",
        "x",
        "%00",
        "====",
        "🙂",
        forged(),
        forged("2030-01-01T00:00:00+00:00"),
        forged("2030-01-01T00:00:00", "abc"),
        forged("yesterday", "abc"),
        forged("2030-01-01T00:00:00+00:00", "a' OR 1=1"),
        forged("2030-01-01T00:00:00+00:00", "a\0b"),
        forged(1, 2),
        "A" * 501,
    ],
)
@pytest.mark.parametrize("resource", ["models", "meshes", "classifiers", "classifications", "estimations", "jobs"])
def test_a_cursor_that_is_not_ours_is_refused(live: LiveService, resource: str, cursor: str) -> None:
    response = live.client.get(f"/v1/{resource}", params={"cursor": cursor})
    assert problem(response, 422)["where"] in ("cursor", "query.cursor")


def test_a_page_has_at_most_as_many_as_allowed(live: LiveService) -> None:
    for limit in ("0", "-1", "201", "1e3", ""):
        problem(live.client.get("/v1/models", params={"limit": limit}), 422, "query.limit")
    assert live.client.get("/v1/models", params={"limit": "200"}).status_code == 200


def test_a_cursor_outlives_the_service(tmp_path: Path) -> None:
    with running(tmp_path / "data") as first:
        there = add_jobs(first, [0, 1, 2])
        page = first.client.get("/v1/jobs", params={"limit": "2"}).json()
    with running(tmp_path / "data") as second:
        rest = second.client.get("/v1/jobs", params={"cursor": page["next_cursor"]}).json()
    assert {job["id"] for job in page["items"] + rest["items"]} == there
