"""Collections and retrievals over HTTP; the work itself is done as workers do it, by claiming the job."""

from functools import partial
from typing import Any

import pytest
from service_support import LiveService, problem, service, tetrahedron

from models_store import catalog

__all__ = ["service"]

PNG = b"\x89PNG"


def train(service: LiveService) -> dict[str, Any]:
    models = [service.add_model(name)["id"] for name in ("box", "crate")]
    accepted: dict[str, Any] = service.client.post("/v1/classifiers", json={"model_ids": models}).json()
    record = partial(
        catalog.record_classifier,
        identifier=accepted["id"],
        onnx_key="classifiers/one.onnx",
        class_names=["box", "crate"],
        metrics={},
        seconds=1.0,
    )
    service.work(accepted["job"]["id"], record)
    return accepted


def upload(service: LiveService, count: int) -> list[str]:
    return [service.upload(tetrahedron(1.0 + number)).json()["id"] for number in range(count)]


def index(service: LiveService, meshes: list[str], **body: Any) -> dict[str, Any]:
    """Ask for a collection and do the work."""
    accepted: dict[str, Any] = service.client.post("/v1/collections", json={"mesh_ids": meshes, **body}).json()
    record = partial(
        catalog.record_collection,
        identifier=accepted["id"],
        index_key="collections/one.npz",
        skipped=[{"mesh_id": meshes[-1], "reason": "it has no area"}],
        seconds=2.5,
    )
    service.work(accepted["job"]["id"], record)
    return accepted


def test_a_collection_is_accepted_and_its_index_comes(service: LiveService) -> None:
    meshes, classifier = upload(service, 3), train(service)
    body = {"name": "mine", "mesh_ids": [*meshes, meshes[0]]}
    response = service.client.post("/v1/collections", json=body)
    assert response.status_code == 202
    accepted = response.json()
    assert response.headers["location"] == accepted["job"]["url"]
    assert accepted["url"] == accepted["job"]["result_url"] == f"/v1/collections/{accepted['id']}"
    waiting = service.client.get(accepted["url"]).json()
    assert (waiting["state"], waiting["name"], waiting["mesh_count"]) == ("queued", "mine", 3)
    assert (waiting["mesh_ids"], waiting["classifier_id"]) == (meshes, classifier["id"])
    assert (waiting["skipped"], waiting["skipped_count"], waiting["seconds"]) == (None, None, None)

    done = service.client.get(index(service, meshes)["url"]).json()
    assert (done["state"], done["skipped_count"], done["seconds"]) == ("succeeded", 1, 2.5)
    assert done["skipped"] == [{"mesh_id": meshes[-1], "reason": "it has no area"}]
    listed = service.client.get("/v1/collections").json()["items"]
    assert [item["id"] for item in listed] == [done["id"], accepted["id"]]
    assert "mesh_ids" not in listed[0]


@pytest.mark.parametrize(
    ("query", "expected"),
    [
        ({"class_name": "crate", "evidence": "probabilities", "limit": 2}, ("probabilities", 2, 500)),
        ({"model_id": "MODEL", "instances": 0, "seed": 3}, ("combined", 50, 0)),
        ({"mesh_id": "MESH"}, ("combined", 50, 500)),
        ({"class_name": "crate"}, ("probabilities", 50, 500)),
    ],
)
def test_a_retrieval_is_accepted_and_its_ranking_comes(
    service: LiveService, query: dict[str, Any], expected: tuple[str, int, int]
) -> None:
    meshes = upload(service, 2)
    train(service)
    collection = index(service, meshes)
    ids = {"MESH": meshes[0], "MODEL": service.add_model("box")["id"]}
    query = {name: ids.get(value, value) for name, value in query.items()}
    response = service.client.post("/v1/retrievals", json={"collection_id": collection["id"], **query})
    assert response.status_code == 202, response.text
    accepted = response.json()
    assert response.headers["location"] == accepted["job"]["url"]
    waiting = service.client.get(accepted["url"]).json()
    assert (waiting["evidence"], waiting["limit"], waiting["instances"]) == expected
    assert {name: waiting[name] for name in query} == query
    assert sum(waiting[name] is not None for name in ("class_name", "model_id", "mesh_id")) == 1
    assert (waiting["result"], waiting["contact_sheet_url"]) == (None, None)
    problem(service.client.get(f"{accepted['url']}/contact-sheet"), 404)

    result = {
        "mesh_count": 2,
        "items": [
            {"mesh_id": mesh, "file_name": "mesh.off", "score": 0.75, "probability": 0.75, "distance": None}
            for mesh in meshes
        ],
        "seconds": 0.5,
    }
    service.services.artifacts.put("retrievals/one.png", PNG)
    record = partial(catalog.record_retrieval, identifier=accepted["id"], result=result, sheet_key="retrievals/one.png")
    service.work(accepted["job"]["id"], record)
    done = service.client.get(accepted["url"]).json()
    assert (done["state"], done["result"]) == ("succeeded", result)
    sheet = service.client.get(done["contact_sheet_url"])
    assert (sheet.content, sheet.headers["content-type"]) == (PNG, "image/png")
    again = service.client.get(done["contact_sheet_url"], headers={"If-None-Match": sheet.headers["etag"]})
    assert again.status_code == 304
    assert service.client.get("/v1/retrievals").json()["items"] == [done]


def test_a_collection_that_makes_no_sense_is_refused(service: LiveService) -> None:
    meshes = upload(service, 1)
    url = "/v1/collections"
    problem(service.client.post(url, json={"mesh_ids": meshes}), 409, "classifier_id")
    waiting = service.client.post(
        "/v1/classifiers", json={"model_ids": [service.add_model(name)["id"] for name in ("box", "crate")]}
    ).json()
    problem(service.client.post(url, json={"mesh_ids": meshes, "classifier_id": waiting["id"]}), 409, "classifier_id")
    train(service)
    for body, where in (
        ({}, "mesh_ids"),
        ({"mesh_ids": []}, "mesh_ids"),
        ({"mesh_ids": [*meshes, "0" * 64]}, "mesh_ids[1]"),
        ({"mesh_ids": ["../x"]}, "mesh_ids[0]"),
        ({"mesh_ids": ["no-id"]}, "mesh_ids[0]"),
        ({"mesh_ids": meshes, "classifier_id": "0" * 32}, "classifier_id"),
        ({"mesh_ids": meshes, "name": ""}, "name"),
        ({"mesh_ids": meshes, "names": "x"}, "names"),
    ):
        problem(service.client.post(url, json=body), 422, where)
    problem(service.client.get(f"{url}/{'0' * 32}"), 404)
    assert service.client.get(url).json()["items"] == []


def test_a_retrieval_that_makes_no_sense_is_refused(service: LiveService) -> None:
    meshes = upload(service, 1)
    train(service)
    url = "/v1/retrievals"
    waiting = service.client.post("/v1/collections", json={"mesh_ids": meshes}).json()
    body = {"collection_id": waiting["id"], "class_name": "box"}
    document = problem(service.client.post(url, json=body), 409, "collection_id")
    assert "queued" in document["detail"]
    service.fail(waiting["job"]["id"], "Mesh error", "no mesh can be used")
    assert "failed" in problem(service.client.post(url, json=body), 409, "collection_id")["detail"]

    ready = index(service, meshes)["id"]
    stranger = service.add_model("teapot")["id"]
    for change, where in (
        ({"collection_id": "0" * 32}, "collection_id"),
        ({"collection_id": None}, "collection_id"),
        ({"class_name": None}, "class_name"),  # no query
        ({"mesh_id": meshes[0]}, "class_name"),  # two
        ({"class_name": "teapot"}, "class_name"),
        ({"class_name": ""}, "class_name"),
        ({"class_name": None, "model_id": "0" * 64}, "model_id"),
        ({"class_name": None, "model_id": stranger}, "model_id"),  # of a class that the classifier does not know
        ({"class_name": None, "mesh_id": "0" * 64}, "mesh_id"),
        ({"class_name": None, "mesh_id": "../x"}, "mesh_id"),
        ({"evidence": "magic"}, "evidence"),
        ({"limit": 0}, "limit"),
        ({"instances": -1}, "instances"),
    ):
        problem(service.client.post(url, json={"collection_id": ready, "class_name": "box", **change}), 422, where)
    assert service.client.get(url).json()["items"] == []
    problem(service.client.get(f"{url}/{'0' * 32}"), 404)
    problem(service.client.get(f"{url}/{'0' * 32}/contact-sheet"), 404)
    by_distance = {"collection_id": ready, "model_id": stranger, "evidence": "panorama"}
    assert service.client.post(url, json=by_distance).status_code == 202
