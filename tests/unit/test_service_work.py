"""Training, classifying and estimating over HTTP; the work itself is done as workers do it, by claiming the job."""

from functools import partial
from typing import Any

import pytest
from service_support import (
    GLB,
    NOWHERE,
    LiveService,
    box,
    problem,
    running,
    service,
    shared_service,
    tetrahedron,
)
from waiting import PATIENCE_S, wait_until

from models_store import catalog
from models_store.broker import QUEUE
from shapewright.mesh.file import parse_mesh

__all__ = ["service", "shared_service"]


def two_models(service: LiveService) -> list[str]:
    return [service.add_model(name)["id"] for name in ("box", "crate")]


POINT = {"threshold": 0.5, "accepted_known": 0.9, "refused_other": 0.8}
METRICS: dict[str, Any] = {"accuracy": 0.5, "trade_off": [POINT], "trade_off_pictures": []}


def train(service: LiveService, *, exemplars_key: str | None = "classifiers/one.npz") -> dict[str, Any]:
    """Ask for a classifier and do the work."""
    accepted = service.client.post("/v1/classifiers", json={"name": "boxes", "model_ids": two_models(service)}).json()
    service.services.artifacts.put("classifiers/one.onnx", b"onnx")
    service.services.artifacts.put("classifiers/one.npz", b"exemplars")
    record = partial(
        catalog.record_classifier,
        identifier=accepted["id"],
        onnx_key="classifiers/one.onnx",
        exemplars_key=exemplars_key,
        class_names=["box", "crate"],
        metrics=METRICS,
        seconds=1.5,
    )
    service.work(accepted["job"]["id"], record)
    classifier: dict[str, Any] = service.client.get(accepted["url"]).json()
    return classifier


def test_a_training_is_accepted_and_its_classifier_comes(service: LiveService) -> None:
    models = two_models(service)
    body = {"model_ids": models, "settings": {"variations": 20, "epochs": 3, "scale_range": [0.9, 1.1]}}
    response = service.client.post("/v1/classifiers", json=body)
    assert response.status_code == 202
    accepted = response.json()
    assert response.headers["location"] == f"/v1/jobs/{accepted['job']['id']}" == accepted["job"]["url"]
    assert accepted["url"] == accepted["job"]["result_url"] == f"/v1/classifiers/{accepted['id']}"
    waiting = service.client.get(accepted["url"]).json()
    assert waiting["state"] == "queued"
    assert waiting["settings"] == body["settings"]
    assert (waiting["name"], waiting["metrics"], waiting["onnx_url"]) == (None, None, None)
    assert waiting["trade_off"] is None
    assert (waiting["negative_model_ids"], waiting["exemplars_url"]) == ([], None)
    problem(service.client.get(f"{accepted['url']}/onnx"), 404)
    problem(service.client.get(f"{accepted['url']}/exemplars"), 404)

    ready = train(service)
    assert (ready["state"], ready["name"], ready["seconds"]) == ("succeeded", "boxes", 1.5)
    assert (ready["class_names"], ready["metrics"]) == (["box", "crate"], METRICS)
    assert ready["trade_off"] == [POINT]
    onnx = service.client.get(ready["onnx_url"])
    assert onnx.content == b"onnx"
    assert "attachment" in onnx.headers["content-disposition"]
    assert service.client.get(ready["onnx_url"], headers={"If-None-Match": onnx.headers["etag"]}).status_code == 304
    listed = service.client.get("/v1/classifiers").json()["items"]
    assert [item["id"] for item in listed] == [ready["id"], accepted["id"]]


def test_the_exemplars_of_a_classifier_are_a_file_of_their_own(service: LiveService) -> None:
    ready = train(service)
    exemplars = service.client.get(ready["exemplars_url"])
    assert exemplars.content == b"exemplars"
    assert exemplars.headers["content-disposition"].endswith('.exemplars.npz"')
    again = service.client.get(ready["exemplars_url"], headers={"If-None-Match": exemplars.headers["etag"]})
    assert again.status_code == 304
    without = train(service, exemplars_key=None)
    assert without["exemplars_url"] is None
    assert without["trade_off"] == [], "that of the pictures alone"
    problem(service.client.get(f"/v1/classifiers/{without['id']}/exemplars"), 404)
    problem(service.client.get(f"/v1/classifiers/{'0' * 32}/exemplars"), 404)


def test_what_is_of_no_class_is_learned_from_models_of_other_things(service: LiveService) -> None:
    models, other = two_models(service), service.add_model("lamp")["id"]
    url = "/v1/classifiers"
    accepted = service.client.post(url, json={"model_ids": models, "negative_model_ids": [other, other]}).json()
    assert service.client.get(accepted["url"]).json()["negative_model_ids"] == [other]
    same_class = service.add_model("box", 2.0)["id"]
    for negatives, index in (([models[0]], 0), ([other, same_class], 1), ([other, "0" * 64], 1)):
        body = {"model_ids": models, "negative_model_ids": negatives}
        problem(service.client.post(url, json=body), 422, f"negative_model_ids[{index}]")


def test_a_trained_classifier_is_extended(service: LiveService) -> None:
    url = "/v1/classifiers"
    queued = service.client.post(url, json={"model_ids": two_models(service)}).json()
    lamp, pole = service.add_model("lamp")["id"], service.add_model("pole")["id"]
    body = {"model_ids": [lamp], "base_classifier_id": queued["id"], "settings": {"variations": 9, "rehearsed": 3}}
    problem(service.client.post(url, json=body), 409, "base_classifier_id")
    base = train(service)
    body["base_classifier_id"] = base["id"]
    response = service.client.post(url, json={**body, "negative_model_ids": [pole]})
    assert response.status_code == 202
    extended = service.client.get(response.json()["url"]).json()
    assert extended["base_classifier_id"] == base["id"]
    assert base["base_classifier_id"] is None
    assert extended["class_names"] == ["box", "crate", "lamp"]
    assert extended["model_ids"] == [*base["model_ids"], lamp]
    assert extended["negative_model_ids"] == [pole]
    assert extended["settings"] == body["settings"]
    for wrong, where in (
        ({"model_ids": [lamp, base["model_ids"][0]]}, "model_ids[1]"),
        ({"base_classifier_id": "0" * 32}, "base_classifier_id"),
        ({"negative_model_ids": [base["model_ids"][1]]}, "negative_model_ids[0]"),
        ({"settings": {"seed": 3}}, "settings.seed"),
        ({"settings": {"image_size": 224}}, "settings.image_size"),
        ({"base_classifier_id": None}, "settings.rehearsed"),
        ({"base_classifier_id": None, "settings": {}}, "model_ids"),
    ):
        problem(service.client.post(url, json={**body, **wrong}), 422, where)


@pytest.mark.parametrize(
    ("body", "where"),
    [
        ({}, "model_ids"),
        ({"model_ids": []}, "model_ids"),
        ({"model_ids": ["BOX"], "settings": {"variations": 0}}, "settings.variations"),
        ({"model_ids": ["BOX"], "settings": {"image_size": 100}}, "settings.image_size"),
        ({"model_ids": ["BOX"], "settings": {"image_size": 224, "backbone": "inception_v3"}}, "settings.image_size"),
        ({"model_ids": ["BOX"], "settings": {"scale_range": [2.0, 1.0]}}, "settings.scale_range"),
        ({"model_ids": ["BOX"], "settings": {"backbone": "hand-made"}}, "settings.backbone"),
        ({"model_ids": ["BOX"], "settings": {"magic": 1}}, "settings.magic"),
        ({"model_ids": ["BOX"], "settings": {"negatives": -1}}, "settings.negatives"),
        ({"model_ids": ["BOX"], "settings": {"framing": "golden"}}, "settings.framing"),
        ({"model_ids": ["BOX", "0" * 64]}, "model_ids[1]"),
        ({"model_ids": ["BOX", "no id"]}, "model_ids[1]"),
        ({"model_ids": ["BOX"]}, "model_ids"),  # one class alone cannot be told apart
    ],
)
def test_a_training_that_makes_no_sense_is_refused(shared_service: LiveService, body: Any, where: str) -> None:
    box = shared_service.add_model("box")["id"]
    body = {**body, **({"model_ids": [box if m == "BOX" else m for m in body["model_ids"]]} if body else {})}
    problem(shared_service.client.post("/v1/classifiers", json=body), 422, where)
    assert shared_service.client.get("/v1/classifiers").json()["items"] == []


RESULT: dict[str, Any] = {
    "class_name": "crate",
    "answer": "unknown",
    "known": 0.25,
    "probabilities": [{"class_name": "crate", "probability": 0.75}, {"class_name": "box", "probability": 0.25}],
    "picture_probabilities": [
        {"class_name": "box", "probability": 0.5},
        {"class_name": "crate", "probability": 0.5},
    ],
    "distances": [{"class_name": "crate", "distance": 0.2}, {"class_name": "box", "distance": 0.3}],
    "fits": [
        {"class_name": "crate", "model_id": "a" * 64, "values": [0.9], "distance": 0.2, "exemplar_distance": 0.25}
    ],
    "neighbor": {
        "class_name": "crate",
        "model_id": "a" * 64,
        "exemplar": 3,
        "values": [0.7],
        "distance": 0.2,
        "usual_distance": 0.15,
    },
    "per_view": [[0.2, 0.8], [0.3, 0.7]],
    "seconds": 0.1,
}


def test_a_mesh_is_classified_by_the_newest_classifier(service: LiveService) -> None:
    mesh = service.upload(tetrahedron()).json()["id"]
    url = "/v1/classifications"
    problem(service.client.post(url, json={"mesh_id": mesh}), 409, "classifier_id")
    classifier = train(service)
    response = service.client.post(url, json={"mesh_id": mesh, "views": 2, "seed": 7, "fit": True})
    assert response.status_code == 202
    accepted = response.json()
    waiting = service.client.get(accepted["url"]).json()
    assert (waiting["classifier_id"], waiting["result"]) == (classifier["id"], None)
    assert (waiting["views"], waiting["seed"], waiting["fit"]) == (2, 7, True)
    problem(service.client.get(f"{accepted['url']}/pictures"), 404)
    service.services.artifacts.put("classifications/one.png", b"png")
    service.work(
        accepted["job"]["id"],
        partial(
            catalog.record_classification,
            identifier=accepted["id"],
            result=RESULT,
            pictures_key="classifications/one.png",
        ),
    )
    done = service.client.get(accepted["url"]).json()
    assert (done["state"], done["result"]) == ("succeeded", RESULT)
    assert service.client.get(url).json()["items"] == [done]
    pictures = service.client.get(done["pictures_url"])
    assert (pictures.content, pictures.headers["content-type"]) == (b"png", "image/png")
    again = service.client.get(done["pictures_url"], headers={"If-None-Match": pictures.headers["etag"]})
    assert again.status_code == 304


def test_an_answer_of_an_older_version_can_be_read(service: LiveService) -> None:
    mesh = service.upload(tetrahedron()).json()["id"]
    train(service)
    accepted = service.client.post("/v1/classifications", json={"mesh_id": mesh}).json()
    result = {name: RESULT[name] for name in ("class_name", "probabilities", "per_view", "seconds")}
    service.work(
        accepted["job"]["id"], partial(catalog.record_classification, identifier=accepted["id"], result=result)
    )
    done = service.client.get(accepted["url"]).json()
    absent = dict.fromkeys(("answer", "known", "picture_probabilities", "distances", "fits", "neighbor"))
    assert done["result"] == result | absent
    assert done["pictures_url"] is None
    problem(service.client.get(f"{accepted['url']}/pictures"), 404)


def test_a_classifier_in_training_cannot_be_asked(service: LiveService) -> None:
    mesh = service.upload(tetrahedron()).json()["id"]
    accepted = service.client.post("/v1/classifiers", json={"model_ids": two_models(service)}).json()
    body = {"mesh_id": mesh, "classifier_id": accepted["id"]}
    problem(service.client.post("/v1/classifications", json=body), 409, "classifier_id")


def estimation_result(model_id: str, name: str = "box") -> dict[str, Any]:
    pose = {"rotation": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "translation": [1.0, 2.0, 3.0]}
    pose["scale"] = 2.0  # type: ignore[assignment]
    distances = {"panorama": 3.0, "surface": 0.02, "zbuffer": 0.3, "zbuffer_raw": 900.0}
    stage = {"layer": 1, "values": [1.5, 1.0], "pose": pose, "distances": distances, "complete": True}
    return {
        "estimator": "reference",
        "model": {"id": model_id, "name": name},
        "layer": 3,
        "complete": True,
        "values": [1.5, 1.0],
        "parameters": [
            {
                "name": "neck_length",
                "label": "neck length",
                "unit": "mm",
                "value": 1.5,
                "base_value": 40.0,
                "minimum": 0.5,
                "maximum": 2.0,
                "active": True,
                "option": None,
                "status": "determined",
                "interval": [1.4, 1.6],
            }
        ],
        "pose": pose,
        "distances": distances,
        "stages": [{"name": "panorama", **stage}, {"name": "zbuffer", **stage, "layer": 3}],
        "seconds": 12.5,
        "verdict": {"layer": 3, "failed": [], "residuals": None},
        "ratios": [],
        "combinations": [],
        "alternatives": [],
        "tried": [],
    }


def test_an_estimation_is_accepted_and_its_answer_comes(service: LiveService) -> None:
    mesh, model = service.upload(tetrahedron()).json(), service.add_model()
    settings = {"samples": 50, "subdivision_steps": 1, "step_sizes": [1.0, 0.1], "estimator": "reference"}
    body = {"mesh_id": mesh["id"], "model_id": model["id"], "units": "mm", "up": "+y"}
    body |= {"time_limit_s": 2.5, "settings": settings}
    accepted = service.client.post("/v1/estimations", json=body).json()
    waiting = service.client.get(accepted["url"]).json()
    assert (waiting["state"], waiting["result"], waiting["mesh_url"]) == ("queued", None, None)
    assert (waiting["mesh_id"], waiting["model_id"]) == (mesh["id"], model["id"])
    assert waiting["settings"] == settings
    assert (waiting["units"], waiting["up"], waiting["time_limit_s"]) == ("mm", "+y", 2.5)
    assert waiting["residuals_url"] is None
    problem(service.client.get(f"{accepted['url']}/residuals"), 404)
    problem(service.client.get(f"{accepted['url']}/mesh"), 404)

    fitted = parse_mesh(tetrahedron(), "off").to_bytes("glb")
    service.services.artifacts.put("estimations/one.glb", fitted)
    service.services.artifacts.put("estimations/one-residuals.glb", b"colored")
    record = partial(
        catalog.record_estimation,
        identifier=accepted["id"],
        result=estimation_result(model["id"]),
        mesh_key="estimations/one.glb",
        residuals_key="estimations/one-residuals.glb",
    )
    service.work(accepted["job"]["id"], record)
    done = service.client.get(accepted["url"]).json()
    assert (done["state"], done["result"]) == ("succeeded", estimation_result(model["id"]))
    content = service.client.get(done["mesh_url"])
    assert (content.content, content.headers["content-type"]) == (fitted, GLB)
    colored = service.client.get(done["residuals_url"])
    assert (colored.content, colored.headers["content-type"]) == (b"colored", GLB)
    assert service.client.get("/v1/estimations").json()["items"] == [done]


def test_an_estimation_for_a_class_says_which_model_it_found(service: LiveService) -> None:
    mesh = service.upload(tetrahedron()).json()
    models = [service.add_document({**box("box"), "name": name}) for name in ("flat_box", "tall_box")]
    body = {"mesh_id": mesh["id"], "class_name": "box"}
    accepted = service.client.post("/v1/estimations", json=body).json()
    waiting = service.client.get(accepted["url"]).json()
    assert (waiting["model_id"], waiting["class_name"]) == (None, "box")
    assert waiting["model_ids"] == [model["id"] for model in models]
    tried = [
        {"model": {"id": models[number]["id"], "name": name}, "panorama": panorama, "distances": None}
        for number, name, panorama in ((1, "tall_box", 0.25), (0, "flat_box", None))
    ]
    result = estimation_result(models[1]["id"], "tall_box") | {"tried": tried}
    record = partial(
        catalog.record_estimation,
        identifier=accepted["id"],
        result=result,
        mesh_key=None,
    )
    service.work(accepted["job"]["id"], record)
    done = service.client.get(accepted["url"]).json()
    assert (done["model_id"], done["result"]) == (models[1]["id"], result)


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"mesh_id": "0" * 64}, "mesh_id"),
        ({"model_id": None}, "model_id"),
        ({"class_name": "box"}, "model_id"),  # both a model and a class
        ({"model_id": None, "class_name": "no such class"}, "class_name"),
        ({"model_id": "0" * 64}, "model_id"),
        ({"model_id": "../x"}, "model_id"),
        ({"mesh_id": None}, "mesh_id"),
        ({"settings": {"samples": 0}}, "settings.samples"),
        ({"settings": {"image_size": 101}}, "settings.image_size"),
        ({"settings": {"step_sizes": [0.1, 1.0]}}, "settings.step_sizes"),
        ({"settings": {"estimator": "magic"}}, "settings.estimator"),
        ({"settings": {"model_points": "edges"}}, "settings.model_points"),
        ({"units": "furlong"}, "units"),
        ({"up": "z"}, "up"),
        ({"time_limit_s": 0}, "time_limit_s"),
    ],
)
def test_an_estimation_that_makes_no_sense_is_refused(shared_service: LiveService, change: Any, where: str) -> None:
    body = {
        "mesh_id": shared_service.upload(tetrahedron()).json()["id"],
        "model_id": shared_service.add_model()["id"],
        **change,
    }
    problem(shared_service.client.post("/v1/estimations", json=body), 422, where)
    assert shared_service.client.get("/v1/estimations").json()["items"] == []


def test_a_failed_job_tells_why(service: LiveService) -> None:
    accepted = service.client.post("/v1/classifiers", json={"model_ids": two_models(service)}).json()
    service.fail(accepted["job"]["id"], "Cannot learn", "too few pictures", "settings.variations")
    job = service.client.get(accepted["job"]["url"]).json()
    assert job["error"] == {"title": "Cannot learn", "detail": "too few pictures", "where": "settings.variations"}
    assert service.client.get(accepted["url"]).json()["state"] == "failed"


def test_without_a_broker_the_job_is_accepted_and_stays_queued(tmp_path) -> None:
    with running(tmp_path / "data", broker_url=NOWHERE) as live:
        response = live.client.post("/v1/classifiers", json={"model_ids": two_models(live)})
        assert response.status_code == 202
        job = live.client.get(response.headers["location"]).json()
        assert (job["state"], job["attempt"]) == ("queued", 0)
        assert live.client.get("/readyz").json() == {
            "ready": True,
            "database": True,
            "artifacts": True,
            "broker": False,
        }
        wait_until(lambda: "shapewright_wakeups_lost_total 3.0" in live.client.get("/metrics").text)


def test_a_wakeup_is_in_the_queue_when_the_job_is_accepted(service: LiveService) -> None:
    service.client.post("/v1/classifiers", json={"model_ids": two_models(service)}).raise_for_status()
    with service.services.celery.connection_for_read() as connection:
        queue = connection.SimpleQueue(QUEUE)
        kinds = [queue.get(timeout=PATIENCE_S).headers["task"] for _ in range(3)]
        queue.close()
    assert sorted(kinds) == [
        "shapewright.render_thumbnail",
        "shapewright.render_thumbnail",
        "shapewright.train_classifier",
    ]
