"""Estimations of many meshes over HTTP; the work itself is done as workers do it, by claiming the job."""

import csv
import io
from datetime import UTC, datetime
from typing import Any

import pytest
from service_support import LiveService, problem, service, tetrahedron

from models_store import catalog
from shapewright.estimation.table.rows import TableRow, cells_of, number

__all__ = ["service"]

URL = "/v1/collection-estimations"


def answer(length: float) -> dict[str, Any]:
    parameter = {
        "name": "neck_length", "label": "neck", "unit": "mm", "value": length, "base_value": 10.0, "minimum": 0.5,
        "maximum": 2.0, "active": True, "option": None, "status": "determined", "interval": [length, length + 0.1],
    }  # fmt: skip
    upright = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    return {
        "estimator": "fast",
        "model": {"id": "0" * 64, "name": "box"},
        "layer": 3,
        "complete": True,
        "values": [length],
        "parameters": [parameter, {**parameter, "name": "neck_size", "value": 1.0}],
        "pose": {"rotation": upright, "translation": [0.0] * 3, "scale": 1.0},
        "distances": {"panorama": 1.0, "surface": 0.01, "zbuffer": 0.1, "zbuffer_raw": None},
        "ratios": [],
    }  # fmt: skip


def upload(service: LiveService, count: int) -> list[str]:
    return [service.upload(tetrahedron(1.0 + n), f"m{n}.off").json()["id"] for n in range(count)]


def estimate_all(service: LiveService, accepted: dict[str, Any], lengths: list[float | None]) -> None:
    """Write the rows as a worker does, and end the job."""
    held = service.claim(accepted["job"]["id"])
    with service.services.database.writing() as session:
        row = catalog.get_collection_estimation(session, accepted["id"])
        for position, length in enumerate(lengths):
            found = None if length is None else answer(length)
            error = "it has no area" if length is None else None
            cells = cells_of(TableRow("", found, error, 1.0))
            measures = {column: number(cell) for column, cell in cells.items() if number(cell) is not None}
            catalog.record_estimated_mesh(
                session, held, row.id, position, mesh_id=row.mesh_ids[position], answer=found, measures=measures,
                error=error, seconds=1.0, now=datetime.now(UTC),
            )  # fmt: skip


def test_many_meshes_are_one_job_and_one_table(service: LiveService) -> None:
    meshes, model = upload(service, 3), service.add_model("box")
    body = {"mesh_ids": meshes, "class_name": "box", "units": "mm", "settings": {"seed": 3}}
    response = service.client.post(URL, json=body)
    assert response.status_code == 202
    accepted = response.json()
    assert (accepted["job"]["kind"], accepted["url"]) == ("estimate_collection", f"{URL}/{accepted['id']}")
    waiting = service.client.get(accepted["url"]).json()
    assert (waiting["state"], waiting["mesh_count"], waiting["done_count"]) == ("queued", 3, 0)
    assert (waiting["model_ids"], waiting["class_name"], waiting["units"]) == ([model["id"]], "box", "mm")

    estimate_all(service, accepted, [1.5, None, 0.5])
    done = service.client.get(accepted["url"]).json()
    assert (done["state"], done["done_count"], done["failed_count"]) == ("running", 3, 1)
    assert service.client.get(URL).json()["items"] == [done]

    first = service.client.get(done["rows_url"], params={"sort": "neck_length/neck_size", "limit": 2}).json()
    assert [(one["file_name"], one["sorted_by"]) for one in first["items"]] == [("m2.off", 0.5), ("m0.off", 1.5)]
    assert first["items"][0]["answer"] == answer(0.5)
    params = {"sort": "neck_length/neck_size", "limit": 2, "cursor": first["next_cursor"]}
    last = service.client.get(done["rows_url"], params=params).json()
    assert [(one["file_name"], one["answer"], one["error"]) for one in last["items"]] == [
        ("m1.off", None, "it has no area")
    ]
    assert last["next_cursor"] is None

    table = service.client.get(done["table_url"], params={"sort": "neck_length", "descending": "true"})
    assert table.headers["content-type"].startswith("text/csv")
    rows = list(csv.DictReader(io.StringIO(table.text)))
    assert [row["file"] for row in rows] == ["m0.off", "m2.off", "m1.off"]
    assert [row["neck_length"] for row in rows] == ["15.0", "5.0", ""]
    assert (rows[0]["neck_length.high"], rows[2]["error"]) == ("16.0", "it has no area")


def test_a_collection_is_estimated_and_the_table_of_nothing_has_a_header(service: LiveService) -> None:
    meshes, model = upload(service, 2), service.add_model("box")
    accepted = service.client.post(URL, json={"mesh_ids": meshes[:1], "model_id": model["id"]}).json()
    shown = service.client.get(accepted["url"]).json()
    assert service.client.get(shown["rows_url"]).json() == {"items": [], "next_cursor": None}
    assert service.client.get(shown["table_url"]).text.startswith("file,model,layer")


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"mesh_ids": None}, "collection_id"),
        ({"collection_id": "0" * 32}, "collection_id"),
        ({"class_name": "box"}, "model_id"),
        ({"model_id": "0" * 64}, "model_id"),
        ({"model_id": None, "class_name": "teapot"}, "class_name"),
        ({"mesh_ids": None, "collection_id": "0" * 32}, "collection_id"),
        ({"settings": {"image_size": 3}}, "settings.image_size"),
    ],
)
def test_a_request_that_makes_no_sense_names_its_field(
    service: LiveService, change: dict[str, Any], where: str
) -> None:
    body = {"mesh_ids": upload(service, 1), "model_id": service.add_model("box")["id"], **change}
    assert problem(service.client.post(URL, json=body), 422)["where"].endswith(where)
    assert service.client.get(URL).json()["items"] == []


def test_rows_are_not_sorted_by_what_the_models_lack(service: LiveService) -> None:
    body = {"mesh_ids": upload(service, 1), "model_id": service.add_model("box")["id"]}
    accepted = service.client.post(URL, json=body).json()
    for path in ("rows", "table"):
        for sort in ("stem_length", "neck_length/stem_length", "neck_length;drop", "file"):
            answered = service.client.get(f"{URL}/{accepted['id']}/{path}", params={"sort": sort})
            assert problem(answered, 422)["where"] == "sort"
        assert service.client.get(f"{URL}/{'0' * 32}/{path}").status_code == 404
