"""The service on PostgreSQL: what SQLite lets pass and PostgreSQL does not."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from service_support import box, problem, running, tetrahedron

from models_store import claims


@pytest.mark.services
def test_the_service_on_postgresql(postgres_url: str, tmp_path: Path) -> None:
    with running(tmp_path / "data", database_url=postgres_url) as live:
        client = live.client
        # PostgreSQL stores no NUL in a text
        model = client.post("/v1/models", json=box() | {"description": "a\0b"}).json()
        assert model["description"] == "ab"
        assert client.get(f"/v1/models/{model['id']}").json()["document"]["description"] == "a\0b"
        crate = live.add_model("crate")
        body = {"name": "na\0me", "model_ids": [model["id"], crate["id"]], "settings": {"epochs": 2}}
        classifier = client.post("/v1/classifiers", json=body).json()
        assert client.get(classifier["url"]).json()["name"] == "name"
        mesh = live.upload(tetrahedron(), "mo\u0308bius \U0001f600.off").json()
        assert live.upload(tetrahedron()).status_code == 200
        for path in ("models/%00", "jobs/a%00b", "meshes/%F0%9F%99%82"):
            problem(client.get(f"/v1/{path}"), 422)

        job_id = classifier["job"]["id"]
        held = live.claim(job_id)
        lease = timedelta(minutes=1)
        with live.services.database.writing() as session:
            claims.report_progress(session, held, 0.5, "half\0way", now=datetime.now(UTC), lease=lease)
        assert client.post(f"/v1/jobs/{job_id}/cancel").json()["state"] == "running"
        with live.services.database.writing() as session:
            claims.finish_cancelled(session, held, now=datetime.now(UTC))
        events = client.get(f"/v1/jobs/{job_id}/events").text
        assert [line for line in events.splitlines() if line.startswith("id:")] == [f"id: {n}" for n in range(1, 6)]

        ids = []
        cursor = None
        while True:
            page = client.get("/v1/jobs", params={"limit": "1"} | ({"cursor": cursor} if cursor else {})).json()
            ids += [job["id"] for job in page["items"]]
            cursor = page["next_cursor"]
            if cursor is None:
                break
        assert len(ids) == len(set(ids)) == 3
        assert client.get("/v1/meshes").json()["items"] == [mesh]
        assert client.get("/readyz").json()["ready"]
        assert 'shapewright_jobs{kind="train_classifier",state="cancelled"} 1.0' in client.get("/metrics").text
