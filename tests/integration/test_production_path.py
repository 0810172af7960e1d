"""The whole path in production mode: PostgreSQL, Redis, the service and a worker as processes of their own.

The two are started by the very commands of docker-compose.yml, with the environment that it gives them.
"""

import io
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import yaml
from services import free_port, logged_process
from waiting import PATIENCE_S

from cli.client import Client, connected
from shapewright.mesh import TriangleMesh
from shapewright.mesh.file import parse_mesh
from shapewright.modeling import compile_model

if TYPE_CHECKING:
    from shapewright.modeling import ProceduralModel

TRAINING = {"variations": 12, "images_per_variation": 4, "negatives": 12, "seed": 1}
ESTIMATING = {
    "samples": 40,
    "surface_points": 300,
    "image_size": 64,
    "subdivision_steps": 1,
    "seed": 1,
    "step_sizes": [0.5, 0.1],
}


def _command(repository: Path, service: str) -> list[str]:
    """The command of a compose service, run by the Python of these tests."""
    compose: Any = yaml.safe_load((repository / "docker-compose.yml").read_text())
    program, *arguments = compose["services"][service]["command"]
    return [str(Path(sys.executable).with_name(program)), *arguments]


def _glass(model: "ProceduralModel") -> tuple[TriangleMesh, dict[str, float]]:
    """A variation that the service has never seen, turned, shifted and scaled."""
    compiled = compile_model(model)
    values = 1.0 + 0.4 * (compiled.random_values(np.random.default_rng(5), 1)[0] - 1.0)
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    mesh = compiled.instance(values).transformed(turn, np.array([3.0, -2.0, 5.0]), 7.0)
    names = [parameter.name for parameter in model.parameters]
    return mesh, dict(zip(names, values.tolist(), strict=True))


@pytest.mark.services
def test_the_whole_path_on_postgresql_and_redis(
    repository: Path,
    tmp_path: Path,
    postgres_url: str,
    redis_url: str,
    library_models: "dict[str, ProceduralModel]",
) -> None:
    port = free_port()
    environment = {
        **{name: value for name, value in os.environ.items() if not name.startswith("SHAPEWRIGHT_")},
        "SHAPEWRIGHT_DATABASE_URL": postgres_url.replace("+psycopg", ""),
        "SHAPEWRIGHT_BROKER_URL": redis_url,
        "SHAPEWRIGHT_ARTIFACTS_URL": (tmp_path / "artifacts").as_uri(),
        "SHAPEWRIGHT_ADD_SHIPPED_ON_START": "false",  # models are uploaded and drawn here
    }
    api = _command(repository, "api")
    api[api.index("--host") + 1], api[api.index("--port") + 1] = "127.0.0.1", str(port)
    folder = tmp_path / "empty"
    folder.mkdir()
    with (
        logged_process(api, log=tmp_path / "api.log", cwd=folder, env=environment),
        connected(f"http://127.0.0.1:{port}", ready_within_s=PATIENCE_S) as client,
        logged_process(_command(repository, "worker"), log=tmp_path / "worker.log", cwd=folder, env=environment),
    ):
        try:
            _walk(client, tmp_path, library_models)
        except Exception as error:
            logs = "\n".join(
                (tmp_path / name).read_text(errors="replace")[-3000:] for name in ("api.log", "worker.log")
            )
            raise AssertionError(f"{error}\n{logs}") from error
    assert list(folder.iterdir()) == [], "nothing of the embedded default was used"


def _walk(client: Client, folder: Path, library_models: "dict[str, ProceduralModel]") -> None:
    uploaded = {}
    for model in (library_models[name] for name in ("glass_with_stem", "sword", "table")):
        answer, new = client.post_document("/v1/models", model.to_json())
        assert new
        uploaded[answer["name"]] = answer
        again, new = client.post_document("/v1/models", model.to_json())
        assert (again["id"], new) == (answer["id"], False)

    accepted = client.post("/v1/classifiers", {"model_ids": [m["id"] for m in uploaded.values()], "settings": TRAINING})
    client.follow(accepted["job"])
    classifier = client.get(accepted["url"])
    assert classifier["state"] == "succeeded"
    assert sorted(classifier["class_names"]) == sorted(uploaded)
    assert client.get_bytes(classifier["onnx_url"])[:1] == b"\x08"  # an ONNX file begins with its version

    mesh, truth = _glass(library_models["glass_with_stem"])
    file = folder / "query.ply"
    mesh.save(file)
    query = client.upload("/v1/meshes", file)
    assert client.upload("/v1/meshes", file)["id"] == query["id"]

    accepted = client.post("/v1/classifications", {"mesh_id": query["id"], "classifier_id": classifier["id"]})
    client.follow(accepted["job"])
    found = client.get(accepted["url"])["result"]
    assert found["class_name"] == "glass_with_stem"
    assert sum(row["probability"] for row in found["probabilities"]) == pytest.approx(1.0, abs=1e-3)

    model = uploaded["glass_with_stem"]
    accepted = client.post("/v1/estimations", {"mesh_id": query["id"], "model_id": model["id"], "settings": ESTIMATING})
    reports: list[float] = []
    client.follow(accepted["job"], _Recorded(reports))
    assert reports == sorted(reports)
    estimation = client.get(accepted["url"])
    result = estimation["result"]
    assert result["complete"]
    assert result["layer"] in (1, 2, 3)
    assert {p["name"] for p in result["parameters"]} == set(truth)
    assert all(p["minimum"] <= p["value"] <= p["maximum"] for p in result["parameters"])
    assert result["distances"]["surface"] < 0.15
    fitted = parse_mesh(client.get_bytes(estimation["mesh_url"]), "glb")
    # the fitted mesh lies on the query, in its coordinates and units
    assert np.abs(fitted.bounds - mesh.bounds).max() < 0.35 * np.ptp(mesh.bounds, axis=0).max()

    jobs = list(client.list_items("/v1/jobs"))
    assert {job["state"] for job in jobs if job["kind"] != "render_thumbnail"} == {"succeeded"}
    assert io.BytesIO(client.get_bytes(f"/v1/models/{model['id']}/thumbnail")).read(8) == b"\x89PNG\r\n\x1a\n"


class _Recorded:
    """Keeps the fractions that were reported."""

    def __init__(self, fractions: list[float]) -> None:
        self._fractions = fractions

    def report(self, fraction: float, message: str) -> None:
        self._fractions.append(fraction)
