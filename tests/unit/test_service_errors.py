"""What holds for every request: problem documents, ids, headers, methods, figures, the page at the root."""

import json
import logging
from pathlib import Path

import pytest
from service_support import PROBLEM, LiveService, box, problem, running, service, shared_service
from sqlalchemy import event

from service.settings import ServiceSettings
from shapewright.errors import Cancelled, ShapewrightError

__all__ = ["service", "shared_service"]


def test_nothing_at_this_path_and_not_in_this_way(shared_service: LiveService) -> None:
    client = shared_service.client
    for path in (
        "/v1",
        "/v1/nope",
        "/v1/models/x/y/z",
        "/nope",
        "/assets/nope.js",
        "/assets/%2e%2e/index.html",
        "/%00",
    ):
        problem(client.get(path), 404)
    for method, path, allow in (
        ("DELETE", "/v1/models", "GET, HEAD, POST"),
        ("PUT", "/v1/models/x", "GET, HEAD"),
        ("GET", "/v1/jobs/x/cancel", "POST"),
        ("POST", "/healthz", "GET, HEAD"),
        ("OPTIONS", "/v1/meshes", "GET, HEAD, POST"),
        ("TRACE", "/", "GET, HEAD"),
    ):
        response = client.request(method, path)
        problem(response, 405)
        assert response.headers["allow"] == allow


def test_head_is_get_without_the_body(shared_service: LiveService) -> None:
    for path in ("/v1/models", "/healthz", "/", "/v1/models/nope"):
        head, get = shared_service.client.head(path), shared_service.client.get(path)
        assert head.content == b""
        for name in ("content-type", "content-length"):
            assert head.headers[name] == get.headers[name]
        assert head.status_code == get.status_code


def test_json_is_asked_for(shared_service: LiveService) -> None:
    paths = ["/v1/models", "/v1/models/x/instances", "/v1/classifiers", "/v1/classifications", "/v1/estimations"]
    for path in paths:
        for headers in ({}, {"Content-Type": "text/plain"}, {"Content-Type": "application/xml"}):
            problem(shared_service.client.post(path, content=b"{}", headers=headers), 415)
        document = problem(
            shared_service.client.post(path, content=b'{"a": \n x', headers={"Content-Type": "application/json"}), 422
        )
        assert document["where"] in ("byte 8", "line 2 column 2")


def test_a_json_body_is_limited(tmp_path: Path) -> None:
    with running(tmp_path / "data", max_body_bytes=1000) as live:
        body = {"model_ids": ["x" * 64] * 100}
        problem(live.client.post("/v1/classifiers", json=body), 413, "byte 1000")


def test_an_error_inside_tells_nothing_but_its_id(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with running(tmp_path / "data") as live:

        def broken() -> None:
            raise RuntimeError("the password is swordfish")

        def cancelled() -> None:
            raise Cancelled

        def refused() -> None:
            raise ShapewrightError("not like this", where="somewhere")

        live.app.add_api_route("/test/broken", broken)
        live.app.add_api_route("/test/refused", refused)
        live.app.add_api_route("/test/cancelled", cancelled)
        logging.getLogger("shapewright.service").setLevel(logging.ERROR)
        response = live.client.get("/test/broken", headers={"X-Request-ID": "my-request.1"})
        document = problem(response, 500)
        assert document["request_id"] == "my-request.1"
        assert "swordfish" not in response.text
        assert "RuntimeError" not in response.text
        [entry] = [json.loads(record.message) for record in caplog.records if "swordfish" in record.message]
        assert entry["request_id"] == "my-request.1"
        assert problem(live.client.get("/test/refused"), 422, "somewhere")["detail"] == "not like this"
        problem(live.client.get("/test/cancelled"), 422)


def test_a_request_has_an_id(shared_service: LiveService) -> None:
    client = shared_service.client
    assert client.get("/healthz", headers={"X-Request-ID": "abc-1"}).headers["x-request-id"] == "abc-1"
    made = client.get("/healthz").headers["x-request-id"]
    assert len(made) == 32
    for harmful in ("a b", "x" * 65, '"><script>'):
        assert client.get("/healthz", headers={"X-Request-ID": harmful}).headers["x-request-id"] != harmful


def test_requests_are_logged_with_their_id(shared_service: LiveService, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, logger="shapewright.access")
    shared_service.client.get("/v1/models/nope", headers={"X-Request-ID": "seen"})
    shared_service.client.get("/v1/models")
    shared_service.client.get("/healthz")  # not worth a line
    lines = [json.loads(record.message) for record in caplog.records if record.name == "shapewright.access"]
    assert [(line["path"], line["status"]) for line in lines] == [("/v1/models/nope", 404), ("/v1/models", 200)]
    assert lines[0]["request_id"] == "seen"


def test_every_response_has_safe_headers(shared_service: LiveService) -> None:
    for path in ("/", "/v1/models", "/v1/nope", "/metrics"):
        headers = shared_service.client.get(path).headers
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["x-frame-options"] == "DENY"
        policy = headers["content-security-policy"]
        assert "frame-ancestors 'none'" in policy
        assert ("script-src 'self'" in policy) == (path == "/")
        assert "server" not in headers or headers["server"] == "uvicorn"


def test_other_origins_are_let_in_only_when_named(shared_service: LiveService, tmp_path: Path) -> None:
    ask = {"Origin": "https://here.example", "Access-Control-Request-Method": "POST"}
    assert "access-control-allow-origin" not in shared_service.client.get("/v1/models", headers=ask).headers
    with running(tmp_path / "data", cors_origins=("https://here.example",)) as live:
        response = live.client.get("/v1/models", headers=ask)
        assert response.headers["access-control-allow-origin"] == "https://here.example"
        assert "X-Shapewright-Values" in response.headers["access-control-expose-headers"]
        assert live.client.options("/v1/models", headers=ask).status_code == 200
        other = live.client.get("/v1/models", headers={"Origin": "https://there.example"})
        assert "access-control-allow-origin" not in other.headers


def test_settings_come_from_the_environment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("SHAPEWRIGHT_CORS_ORIGINS", "https://a.example, https://b.example")
    monkeypatch.setenv("SHAPEWRIGHT_DATA_DIR", str(tmp_path))
    settings = ServiceSettings()
    assert settings.cors_origins == ("https://a.example", "https://b.example")
    assert settings.database_url == f"sqlite:///{tmp_path / 'shapewright.db'}"


def test_alive_ready_and_away(tmp_path: Path) -> None:
    with running(tmp_path / "data") as live:
        health = live.client.get("/healthz")
        assert (health.status_code, health.json()["status"]) == (200, "ok")
        all_well = {"ready": True, "database": True, "artifacts": True, "broker": True}
        assert live.client.get("/readyz").json() == all_well
        (tmp_path / "data" / "artifacts").rmdir()
        response = live.client.get("/readyz")
        assert (response.status_code, response.json()) == (503, {**all_well, "ready": False, "artifacts": False})
        assert live.client.get("/healthz").status_code == 200


def test_a_database_that_is_away_is_said(tmp_path: Path) -> None:
    with running(tmp_path / "data") as live:
        live.services.database.close()
        for path in (tmp_path / "data").glob("shapewright.db*"):
            path.unlink()
        (tmp_path / "data" / "shapewright.db").mkdir()
        response = live.client.get("/v1/models")
        problem(response, 503)
        assert response.headers["retry-after"]
        assert live.client.get("/readyz").json()["database"] is False
        assert live.client.get("/metrics").status_code == 200


def test_a_full_database_is_said_and_leaves_nothing(service: LiveService) -> None:
    engine = service.services.database.engine

    @event.listens_for(engine, "connect")
    def _limit(connection, _record) -> None:
        pages = connection.execute("PRAGMA page_count").fetchone()[0]
        connection.execute(f"PRAGMA max_page_count={pages}")

    engine.dispose()
    document = box() | {"description": "long " * 900}
    refused = [service.client.post("/v1/models", json=document | {"name": f"n{i}"}).status_code for i in range(20)]
    assert 507 in refused
    full = service.client.post("/v1/models", json=document | {"name": "last"})
    problem(full, 507)
    stored = service.client.get("/v1/models").json()["items"]
    assert len(stored) == refused.count(201)
    assert "last" not in {model["name"] for model in stored}


def test_figures_are_counted_by_route(service: LiveService) -> None:
    model = service.add_model()
    service.client.get(f"/v1/models/{model['id']}")
    service.client.post(f"/v1/models/{model['id']}/instances", json={})
    service.client.get("/v1/models/nope")
    text = service.client.get("/metrics").text
    expected = 'shapewright_http_requests_total{method="GET",route="/v1/models/{id}",status="200"} 1.0'
    assert expected in text
    assert 'route="/v1/models/{id}",status="404"} 1.0' in text
    assert model["id"] not in text
    assert "shapewright_instance_seconds_count 1.0" in text
    assert 'shapewright_jobs{kind="render_thumbnail",state="queued"} 1.0' in text
    assert "process_resident_memory_bytes" in text


def test_the_page_at_the_root(tmp_path: Path) -> None:
    built = tmp_path / "dist"
    with running(tmp_path / "data", dashboard_dir=built) as live:
        page = live.client.get("/")
        assert page.status_code == 200
        assert "npm run build" in page.text
        (built / "assets").mkdir(parents=True)
        (built / "index.html").write_text("<!doctype html><title>built</title>")
        (built / "icon.svg").write_text("<svg/>")
        (built / "assets" / "main-1.js").write_text("1")
        (tmp_path / "secret.txt").write_text("secret")
        page = live.client.get("/")
        assert "built" in page.text
        assert page.headers["cache-control"] == "no-cache"
        script = live.client.get("/assets/main-1.js")
        assert script.headers["content-type"].startswith("text/javascript")
        assert "immutable" in script.headers["cache-control"]
        assert live.client.get("/icon.svg").headers["content-type"] == "image/svg+xml"
        for path in ("/assets/..%2f..%2fsecret.txt", "/..%2fsecret.txt", "/assets/", "/assets"):
            assert live.client.get(path).headers["content-type"] == PROBLEM
