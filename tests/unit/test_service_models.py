"""Procedural models over HTTP: upload, documents, instances, refusals."""

import copy
import json
from collections.abc import Iterator
from datetime import UTC, datetime
from functools import partial
from typing import Any

import httpx
import numpy as np
import pytest
from chair_model import armchair
from service_support import GLB, LiveService, box, problem, running, service, shared_service

from models_store import catalog
from service.compiled_models import CompiledModels, InstanceWriter
from shapewright.mesh import TriangleMesh
from shapewright.mesh.file import parse_mesh
from shapewright.modeling import ProceduralModel, compile_model

__all__ = ["service", "shared_service"]


def instance(service: LiveService, model_id: str, **body: Any) -> httpx.Response:
    return service.client.post(f"/v1/models/{model_id}/instances", json=body)


def test_a_model_is_stored_once(service: LiveService) -> None:
    document = box()
    first = service.client.post("/v1/models", json=document)
    assert first.status_code == 201
    model = first.json()
    assert model["id"] == ProceduralModel.from_document(document).digest
    assert first.headers["location"] == f"/v1/models/{model['id']}"
    assert model["parameters"][0] == {
        "name": "neck_length",
        "label": "neck length",
        "unit": "mm",
        "base_value": 40.0,
        "kind": "length",
        "minimum": 0.5,
        "maximum": 2.0,
        "default": 1.0,
        "options": [],
        "active_when": [],
        "limits": [],
    }
    assert (model["parts"], model["symmetry"]) == ([], {"mirrors": [], "axis": None, "order": 1})
    assert model["operation_count"] == len(document["operations"])
    assert model["thumbnail_url"] is None
    # the same content in another spelling is the same model, and one thumbnail is enough
    again = service.client.post("/v1/models", content=json.dumps(document, indent=4, sort_keys=True), headers=JSON)
    assert (again.status_code, again.json()) == (200, model)
    jobs = service.client.get("/v1/jobs").json()["items"]
    assert [(job["kind"], job["state"]) for job in jobs] == [("render_thumbnail", "queued")]
    assert jobs[0]["result_url"] == f"/v1/models/{model['id']}"

    detail = service.client.get(f"/v1/models/{model['id']}").json()
    assert detail["document"] == document
    assert {key: value for key, value in detail.items() if key != "document"} == model
    assert service.client.get("/v1/models").json() == {"items": [model], "next_cursor": None}


def test_the_thumbnail_comes_with_its_job_and_is_cached(service: LiveService) -> None:
    model = service.add_model()
    url = f"/v1/models/{model['id']}/thumbnail"
    problem(service.client.get(url), 404)
    job = service.client.get("/v1/jobs").json()["items"][0]
    service.services.artifacts.put("thumbnails/one.png", b"\x89PNG...")
    service.work(job["id"], partial(catalog.record_thumbnail, model_id=model["id"], thumbnail_key="thumbnails/one.png"))
    assert service.client.get(f"/v1/models/{model['id']}").json()["thumbnail_url"] == url
    picture = service.client.get(url)
    assert (picture.content, picture.headers["content-type"]) == (b"\x89PNG...", "image/png")
    assert "immutable" in picture.headers["cache-control"]
    for tag in (picture.headers["etag"], f'"other", W/{picture.headers["etag"]}', "*"):
        known = service.client.get(url, headers={"If-None-Match": tag})
        assert (known.status_code, known.content) == (304, b"")
        assert known.headers["etag"] == picture.headers["etag"]
    assert service.client.get(url, headers={"If-None-Match": '"other"'}).status_code == 200


def test_an_instance_is_what_the_library_makes(shared_service: LiveService) -> None:
    model = shared_service.add_model()
    compiled = compile_model(ProceduralModel.from_document(box()))
    for body, values in (
        ({}, [1.0, 1.0]),
        ({"values": {"neck_size": 1.5}}, [1.0, 1.5]),
        ({"values": {"neck_length": 0.5}, "subdivision_steps": 0}, [0.5, 1.0]),
        ({"values": {"neck_length": 2, "neck_size": 0.5}, "subdivision_steps": 3}, [2.0, 0.5]),
    ):
        response = instance(shared_service, model["id"], **body)
        assert response.status_code == 200
        assert response.headers["content-type"] == GLB
        assert json.loads(response.headers["x-shapewright-values"]) == dict(
            zip(("neck_length", "neck_size"), values, strict=True)
        )
        expected = compiled.instance(np.array(values), body.get("subdivision_steps", 2))
        mesh = parse_mesh(response.content, "glb")
        assert mesh.is_watertight
        # reading may drop or merge nothing here, so that faces correspond one to one
        np.testing.assert_allclose(mesh.triangles, expected.triangles, atol=1e-6)


def test_a_seed_makes_a_variation_that_can_be_repeated(shared_service: LiveService) -> None:
    model = shared_service.add_model()
    seen = set()
    for seed in range(5):
        one, two = (instance(shared_service, model["id"], seed=seed) for _ in range(2))
        assert one.content == two.content
        values = json.loads(one.headers["x-shapewright-values"])
        assert 0.5 <= values["neck_length"] <= 2.0
        assert 0.5 <= values["neck_size"] <= 1.5
        seen.add(tuple(values.values()))
        fixed = instance(shared_service, model["id"], seed=seed, values={"neck_size": 1.25})
        assert json.loads(fixed.headers["x-shapewright-values"]) == {**values, "neck_size": 1.25}
    assert len(seen) == 5


def test_a_model_tells_what_depends_on_what(service: LiveService) -> None:
    model = service.add_document(json.loads(armchair().to_json()))
    back, armrests, leg, arm, ring = model["parameters"]
    assert [option["name"] for option in back["options"]] == ["low back", "high back", "no back"]
    assert [option["value"] for option in back["options"]] == [1.0, 2.0, 3.0]
    assert (armrests["minimum"], armrests["maximum"], armrests["options"][1]["value"]) == (0.0, 1.0, 1.0)
    with_armrests = [{"parameter": "armrests", "minimum": 1.0, "maximum": 1.0}]
    assert (leg["active_when"], arm["active_when"]) == ([], with_armrests)
    assert ring["limits"] == [{"bound": "maximum", "parameter": "leg_length", "offset": 0.25, "factor": 0.75}]
    assert model["parts"][2] == {"name": "armrests", "present_when": with_armrests}
    assert model["symmetry"] == {"mirrors": ["y"], "axis": None, "order": 1}


def test_values_are_settled_before_an_instance_is_made(shared_service: LiveService) -> None:
    model = shared_service.add_document(json.loads(armchair().to_json()))
    compiled = compile_model(armchair())

    def made(**body: Any) -> tuple[dict[str, float], TriangleMesh]:
        response = instance(shared_service, model["id"], **body)
        assert response.status_code == 200, response.text
        return json.loads(response.headers["x-shapewright-values"]), parse_mesh(response.content, "glb")

    values, mesh = made(values={"armrests": 0, "arm_height": 1.7, "back": 3})
    assert (values["arm_height"], values["armrests"], values["back"]) == (1.0, 0.0, 3.0)
    alone = compiled.instance(np.array(list(values.values())))
    np.testing.assert_allclose(mesh.triangles, alone.triangles, atol=1e-6)
    assert len(mesh.faces) < len(compiled.surface_triangles())
    assert made(values={"leg_length": 0.5})[0]["ring_height"] == 0.625  # what is not named follows
    for seed in range(8):
        values, _ = made(seed=seed, values={"armrests": 1, "ring_height": 1.4})
        np.testing.assert_array_equal(compiled.settle(np.array([list(values.values())]))[0], list(values.values()))
        assert values["armrests"] == 1.0
        assert values["ring_height"] == pytest.approx(min(1.4, 0.25 + 0.75 * values["leg_length"]))


@pytest.mark.parametrize(
    ("values", "where", "says"),
    [
        ({"back": 1.5}, "values.back", "2 (high back)"),
        ({"back": 4}, "values.back", "[1, 3]"),
        ({"leg_length": 0.6, "ring_height": 1.0}, "values.ring_height", "[0.2, 0.7], given leg_length"),
    ],
)
def test_a_value_that_others_shut_out_is_refused(
    shared_service: LiveService, values: dict[str, float], where: str, says: str
) -> None:
    model = shared_service.add_document(json.loads(armchair().to_json()))
    refusal = problem(instance(shared_service, model["id"], values=values), 422, where)
    assert says in refusal["detail"]
    assert refusal["type"].endswith(":values-invalid")


def test_classes_are_sets_of_models(service: LiveService) -> None:
    def classes(**query: Any) -> Any:
        return service.client.get("/v1/classes", params=query).json()

    assert classes() == {"items": [], "next_cursor": None}
    old, stool, crate = service.add_model("stool"), service.add_model("stool", height=2.0), service.add_model("crate")
    chair = service.add_document(json.loads(armchair().to_json()))
    found = classes()["items"]
    assert [(item["name"], [model["id"] for model in item["models"]]) for item in found] == [
        ("chair", [chair["id"]]),
        ("crate", [crate["id"]]),
        ("stool", [stool["id"]]),  # of two versions of one name the newer
    ]
    first = classes(limit=2)
    assert [item["name"] for item in first["items"]] == ["chair", "crate"]
    assert classes(limit=2, cursor=first["next_cursor"]) == {"items": found[2:], "next_cursor": None}
    of_class = service.client.get("/v1/models", params={"class_name": "stool"}).json()["items"]
    assert {model["id"] for model in of_class} == {old["id"], stool["id"]}
    problem(service.client.get("/v1/classes", params={"cursor": "?"}), 422, "cursor")


JSON = {"Content-Type": "application/json"}


@pytest.mark.parametrize(
    ("body", "where"),
    [
        ({"values": {"stem": 1.0}}, "values.stem"),
        ({"values": {"neck_size": 1.51}}, "values.neck_size"),
        ({"values": {"neck_size": "wide"}}, "values.neck_size"),
        ({"subdivision_steps": 4}, "subdivision_steps"),
        ({"seed": -1}, "seed"),
        ({"colour": "red"}, "colour"),
    ],
)
def test_values_that_do_not_fit_are_refused(shared_service: LiveService, body: Any, where: str) -> None:
    model = shared_service.add_model()
    problem(instance(shared_service, model["id"], **body), 422, where)


def test_numbers_that_are_none_are_refused(shared_service: LiveService) -> None:
    url = f"/v1/models/{shared_service.add_model()['id']}/instances"
    for text in ('{"values": {"neck_size": NaN}}', '{"values": {"neck_size": 1e999}}'):
        problem(shared_service.client.post(url, content=text, headers=JSON), 422, "values.neck_size")
    broken = shared_service.client.post(url, content='{"values": {', headers=JSON)
    assert "broken JSON" in problem(broken, 422)["detail"]
    for content in (b'{"seed": "\xff"}', b"[" * 100_000):
        assert "not JSON" in problem(shared_service.client.post(url, content=content, headers=JSON), 422)["detail"]
    problem(shared_service.client.post(url, content="{}", headers={"Content-Type": "text/plain"}), 415)


def test_unknown_models_are_not_found(shared_service: LiveService) -> None:
    for identifier in ("nope", "0" * 64):
        problem(shared_service.client.get(f"/v1/models/{identifier}"), 404)
        problem(shared_service.client.get(f"/v1/models/{identifier}/thumbnail"), 404)
        problem(instance(shared_service, identifier), 404)
    problem(shared_service.client.get("/v1/models/%00"), 422, "path.id")


def changed(path: tuple[Any, ...], value: Any) -> str:
    document = copy.deepcopy(box())
    holder: Any = document
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    return json.dumps(document)


@pytest.mark.parametrize(
    ("content", "where"),
    [
        ("", "line 1 column 1"),
        ('{"format": ', "line 1 column 12"),
        ("[]", "document"),
        (b"\xff\xfe{}", None),
        ("[" * 100_000, None),
        (changed(("operations", 1, "op"), "explode"), "operations[1].op"),
        (changed(("operations", 1, "targets", 0, "elements", 0), "f99"), "operations[1]"),
        (changed(("parameters", 1, "range"), [1.1, 2.0]), "parameters[1]"),
        (changed(("parameters", 0, "targets", 0, "operation"), 17), "parameters[0].targets[0].operation"),
        (changed(("parameters", 0, "label"), "half \ud800 a pair"), None),
        (changed(("description",), "half \ud800 a pair"), None),
        (changed(("version",), 99), "version"),
    ],
)
def test_a_document_that_is_wrong_leaves_nothing(service_without_models: LiveService, content: Any, where: str) -> None:
    response = service_without_models.client.post("/v1/models", content=content, headers=JSON)
    problem(response, 422, where)
    service_without_models.assert_nothing_left()


@pytest.fixture(scope="module")
def service_without_models(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveService]:
    with running(tmp_path_factory.mktemp("empty") / "data", max_model_bytes=200_000) as live:
        yield live


def test_a_document_over_the_limit_is_refused_before_it_is_read(service_without_models: LiveService) -> None:
    client = service_without_models.client
    problem(client.post("/v1/models", content=b" " * 200_001, headers=JSON), 413, "byte 200000")
    chunks = iter([b" " * 1000] * 201)  # its length is not stated
    problem(client.post("/v1/models", content=chunks, headers=JSON), 413, "byte 200000")
    service_without_models.assert_nothing_left()


def test_a_surface_that_would_be_too_fine_is_refused(tmp_path) -> None:
    with running(tmp_path / "data", max_instance_corners=200) as live:
        model = live.add_model()
        assert instance(live, model["id"]).status_code == 200
        problem(instance(live, model["id"], subdivision_steps=3), 422, "subdivision_steps")


def test_the_generators_used_last_are_kept() -> None:
    kept, made = CompiledModels(2), []

    def get(name: str) -> InstanceWriter:
        def make() -> InstanceWriter:
            made.append(name)
            return InstanceWriter(ProceduralModel.from_document(box()), 10_000)

        return kept.get(name, make)

    first = get("a")
    get("b")
    assert get("a") is first
    get("c")
    get("a")
    get("b")
    assert made == ["a", "b", "c", "b"]


def test_a_model_from_before_a_restart_still_makes_instances(tmp_path) -> None:
    with running(tmp_path / "data") as live:
        model = live.add_model()
        before = instance(live, model["id"], seed=1).content
    with running(tmp_path / "data") as live:
        assert instance(live, model["id"], seed=1).content == before
        assert datetime.fromisoformat(model["created_at"]) < datetime.now(UTC)
