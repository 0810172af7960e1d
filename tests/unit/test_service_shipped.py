"""A service begins with what ships: models to look at, and a classifier that answers where none is named."""

from functools import partial
from pathlib import Path

import pytest
from ready_classifier import write_ready_classifier
from service_support import problem, running, tetrahedron

from models_store import catalog
from models_store.library.shipped import list_shipped
from service import app
from service.settings import ServiceSettings


def test_it_is_on_until_a_setting_turns_it_off(monkeypatch: pytest.MonkeyPatch) -> None:
    assert ServiceSettings().add_shipped_on_start
    monkeypatch.setenv("SHAPEWRIGHT_ADD_SHIPPED_ON_START", "false")
    assert not ServiceSettings().add_shipped_on_start


def test_the_first_request_finds_models_pictures_and_a_classifier(tmp_path: Path) -> None:
    ready = write_ready_classifier(tmp_path / "ready")
    with running(tmp_path / "data", add_shipped_on_start=True, ready_classifier_dir=ready) as live:
        models = live.client.get("/v1/models", params={"limit": 100}).json()["items"]
        assert {model["name"] for model in models} == set(list_shipped())
        assert live.client.get(models[0]["thumbnail_url"]).content[:4] == b"\x89PNG"
        assert live.client.get("/v1/jobs").json()["items"] == []
        (classifier,) = live.client.get("/v1/classifiers").json()["items"]
        assert (classifier["state"], classifier["job_id"], classifier["name"]) == ("succeeded", None, "ready")
        assert live.client.get(classifier["exemplars_url"]).content == b"exemplars"

        # it answers where none is named, also when another was trained since
        mesh = live.upload(tetrahedron()).json()["id"]
        body = {"model_ids": [models[0]["id"], models[-1]["id"]], "settings": {}}
        trained = live.client.post("/v1/classifiers", json=body).json()
        record = partial(catalog.record_classifier, onnx_key="k", class_names=["a", "b"], metrics={}, seconds=1.0)
        live.work(trained["job"]["id"], partial(record, identifier=trained["id"]))
        for url, asked in (("classifications", {"mesh_id": mesh}), ("collections", {"mesh_ids": [mesh]})):
            accepted = live.client.post(f"/v1/{url}", json=asked).json()
            assert live.client.get(accepted["url"]).json()["classifier_id"] == classifier["id"]

    # the same data without what ships: it is there from before, and stays
    with running(tmp_path / "data") as live:
        assert len(live.client.get("/v1/classifiers").json()["items"]) == 2


def test_without_any_classifier_the_answer_says_what_to_do(tmp_path: Path) -> None:
    with running(tmp_path / "data") as live:
        mesh = live.upload(tetrahedron()).json()["id"]
        refused = problem(live.client.post("/v1/classifications", json={"mesh_id": mesh}), 409, "classifier_id")
        assert "POST /v1/classifiers" in refused["detail"]


def test_a_service_starts_also_where_its_classifier_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    monkeypatch.setattr(app.log, "error", lambda event, **details: said.append(f"{event}: {details['error']}"))
    with running(tmp_path / "data", add_shipped_on_start=True, ready_classifier_dir=tmp_path) as live:
        assert live.client.get("/readyz").json()["ready"]
        assert live.client.get("/v1/models").json()["items"]
    assert said == [f"what ships was not added: {tmp_path}/classifier.onnx: the file does not exist"]
