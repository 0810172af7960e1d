"""The published description: it is fresh, it is true, and it offers what the library offers."""

import json
from collections.abc import Iterator
from dataclasses import fields
from functools import partial
from typing import get_args

import jsonschema
import numpy as np
import pytest
import schemathesis
from hypothesis import HealthCheck, given, settings
from pydantic import BaseModel
from schemathesis import GenerationMode
from schemathesis.checks import load_all_checks
from service_support import LiveService, box, running, tetrahedron
from waiting import PATIENCE_S

from models_store import catalog
from models_store.job_kinds import JobKind
from models_store.jobs import TASK_NAMES
from service.openapi import FOLDER, stale
from service.schemas.classifiers import TrainingSettingsIn
from service.schemas.estimations import EstimationIn, EstimationResultOut, EstimationSettingsIn, ParameterEstimateOut
from service.schemas.jobs import RESULT_PATHS
from service.schemas.models import ParameterOut
from service.schemas.retrievals import Evidence
from shapewright.distances.alignment import Pose
from shapewright.estimation import (
    Alternative,
    Combination,
    Distances,
    Estimation,
    EstimationSettings,
    FailedThreshold,
    ModelTried,
    ParameterEstimate,
    Ratio,
    Stage,
    Verdict,
)
from shapewright.estimation.query import AXES, UNITS
from shapewright.estimation.residuals import PartResidual, Residuals
from shapewright.estimation.result import ParameterStatus
from shapewright.estimation.settings import EstimatorName, ModelPoints
from shapewright.mesh import TriangleMesh
from shapewright.modeling import ProceduralModel
from shapewright.modeling.units import KINDS
from shapewright.rendering.styles import FRAMINGS, PICTURE_STYLES
from shapewright.retrieval.ranking import EVIDENCE
from shapewright.training import ExtensionSettings, TrainingSettings
from shapewright.training.broken import BREAK_NAMES, MOST_BROKEN


def test_the_published_descriptions_are_fresh() -> None:
    names = [path.name for path in stale()]
    assert names == [], f"run: python -m service.openapi ({', '.join(names)} is stale)"
    assert sorted(path.name for path in FOLDER.glob("*.json")) == ["openapi.json", "procedural-model.schema.json"]


def test_settings_are_those_of_the_library() -> None:
    library = {field.name for kind in (TrainingSettings, ExtensionSettings) for field in fields(kind)}
    assert set(TrainingSettingsIn.model_fields) == library
    left_out = {"alignment"}  # steps of the realignment: for those who work in Python
    assert set(EstimationSettingsIn.model_fields) == {field.name for field in fields(EstimationSettings)} - left_out


def test_choices_are_those_of_the_library() -> None:
    def choices(schema: type[BaseModel], name: str) -> set[str]:
        return set(schema.model_json_schema()["properties"][name]["anyOf"][0].get("enum", [])) or {
            schema.model_json_schema()["properties"][name]["anyOf"][0]["const"]
        }

    assert choices(TrainingSettingsIn, "style") == set(PICTURE_STYLES)
    breaks = TrainingSettingsIn.model_json_schema()["properties"]["breaks"]["anyOf"][0]
    assert set(breaks["items"]["enum"]) == set(BREAK_NAMES)
    assert breaks["maxItems"] == len(BREAK_NAMES)
    assert TrainingSettingsIn.model_json_schema()["properties"]["broken"]["anyOf"][0]["maximum"] == MOST_BROKEN
    assert choices(TrainingSettingsIn, "framing") == set(FRAMINGS)
    assert choices(EstimationSettingsIn, "estimator") == set(get_args(EstimatorName))
    assert choices(EstimationSettingsIn, "model_points") == set(get_args(ModelPoints))
    assert choices(EstimationIn, "units") == set(UNITS)
    assert choices(EstimationIn, "up") == set(AXES)
    assert choices(ParameterEstimateOut, "status") == set(get_args(ParameterStatus))
    assert choices(ParameterOut, "kind") == set(KINDS)


def test_the_library_defaults_are_within_the_limits_of_the_service() -> None:
    training, estimation = TrainingSettings().to_dict(), EstimationSettings().to_dict()
    estimation.pop("alignment")
    assert TrainingSettingsIn(**training).checked()["variations"] == training["variations"]
    paper = TrainingSettings.paper().to_dict()
    assert TrainingSettingsIn(**paper).checked() | {"scale_range": paper["scale_range"]} == paper
    assert EstimationSettingsIn(**estimation).checked()["samples"] == 10_000


def test_an_estimation_of_the_library_fits_the_answer() -> None:
    """Field by field: a new one in the library must not be lost on the way."""
    values, pose = np.array([1.5]), Pose(np.eye(3), np.zeros(3), 2.0)
    distances = Distances(3.0, 0.02, 0.3, 900.0)
    mesh = TriangleMesh(np.eye(4, 3), np.array([[0, 1, 2]]))
    model = ProceduralModel.from_document(box())
    parameter = ParameterEstimate(
        "height", "height", "cm", 1.5, 45.0, 0.5, 2.0, status="determined", interval=(1.4, 1.6)
    )
    residuals = Residuals(np.zeros(4), np.ones(2), 0.1, 0.9, 0.2, (PartResidual("top", 1.0, 0.1, 0.2, 0.3),))
    estimation = Estimation(
        estimator="reference",
        model=model,
        layer=1,
        values=values,
        parameters=(parameter,),
        pose=pose,
        distances=distances,
        stages=(Stage("panorama", values, pose, distances),),
        mesh=mesh,
        tried=(ModelTried(model, distances, 3.0), ModelTried(model)),
        ratios=(Ratio("height", "width", "Height : Width", 2.0, (1.9, 2.1), "determined"),),
        combinations=(Combination("Height and Width", {"height": 0.5, "width": 0.5}, 0.1),),
        alternatives=(Alternative("pose", model, values, (parameter,), pose, distances, "turned by 180 degrees"),),
        verdict=Verdict(1, (FailedThreshold("zbuffer", 0.8, 0.7),), residuals),
    )
    document = {**json.loads(json.dumps(estimation.to_dict())), "seconds": 1.0}
    assert EstimationResultOut.model_validate(document).model_dump() == document


def test_kinds_of_evidence_are_those_of_the_library() -> None:
    assert get_args(Evidence) == EVIDENCE


def test_every_kind_of_job_has_a_task_and_a_place_for_its_result() -> None:
    assert set(TASK_NAMES) == set(RESULT_PATHS) == set(JobKind)


@pytest.fixture(scope="module")
def filled_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveService]:
    with running(tmp_path_factory.mktemp("fuzzed") / "data", max_mesh_bytes=100_000) as live:
        yield live


@pytest.fixture(scope="module")
def known_ids(filled_service: LiveService) -> dict[str, str]:
    """Ids of things that are there, by the first part of their path."""
    live = filled_service
    model, crate = live.add_model("box"), live.add_model("crate")
    mesh = live.upload(tetrahedron()).json()
    classifier = live.client.post("/v1/classifiers", json={"model_ids": [model["id"], crate["id"]]}).json()
    live.services.artifacts.put("classifiers/one.onnx", b"onnx")
    live.work(
        classifier["job"]["id"],
        partial(
            catalog.record_classifier,
            identifier=classifier["id"],
            onnx_key="classifiers/one.onnx",
            class_names=["box", "crate"],
            metrics={},
            seconds=1.0,
        ),
    )
    collection = live.client.post("/v1/collections", json={"mesh_ids": [mesh["id"]]}).json()
    live.work(
        collection["job"]["id"],
        partial(
            catalog.record_collection,
            identifier=collection["id"],
            index_key="collections/one.npz",
            skipped=[],
            seconds=1.0,
        ),
    )
    retrieval = live.client.post("/v1/retrievals", json={"collection_id": collection["id"], "class_name": "box"}).json()
    estimation = live.client.post("/v1/estimations", json={"mesh_id": mesh["id"], "model_id": model["id"]}).json()
    live.client.post(f"{estimation['job']['url']}/cancel").raise_for_status()  # so that its stream ends
    several = {"mesh_ids": [mesh["id"]], "model_id": model["id"]}
    collection_estimation = live.client.post("/v1/collection-estimations", json=several).json()
    return {
        "collection-estimations": collection_estimation["id"],
        "models": model["id"],
        "meshes": mesh["id"],
        "classifiers": classifier["id"],
        "estimations": estimation["id"],
        "collections": collection["id"],
        "retrievals": retrieval["id"],
        "jobs": estimation["job"]["id"],
    }


load_all_checks()
CHECKS = [
    check
    for check in schemathesis.checks.CHECKS.get_all()
    # A body that fits the schema may still name what is not there, or be a model that is impossible.
    if check.__name__ != "positive_data_acceptance"
]
OPERATIONS = {
    operation.label: operation
    for operation in (
        result.ok() for result in schemathesis.openapi.from_path(FOLDER / "openapi.json").get_all_operations()
    )
}


CASES = [
    pytest.param(label, mode, id=f"{label} {mode.value}")
    for label, operation in sorted(OPERATIONS.items())
    for mode in GenerationMode
    # what takes no input cannot be given a wrong one
    if mode is GenerationMode.POSITIVE or operation.body or list(operation.iter_parameters())
]


@pytest.mark.parametrize(("label", "mode"), CASES)
def test_whatever_is_sent_the_answer_is_as_described(
    filled_service: LiveService, known_ids: dict[str, str], label: str, mode: GenerationMode
) -> None:
    operation = OPERATIONS[label]
    base_url = str(filled_service.client.base_url)
    resource = label.split("/")[2] if "/v1/" in label else ""

    @settings(max_examples=5, derandomize=True, deadline=None, database=None, suppress_health_check=list(HealthCheck))
    @given(case=operation.as_strategy(generation_mode=mode))
    def check(case: schemathesis.Case) -> None:
        case.call_and_validate(base_url=base_url, checks=CHECKS, timeout=PATIENCE_S)
        if "id" in case.path_parameters and resource in known_ids:
            case.path_parameters["id"] = known_ids[resource]
            response = case.call(base_url=base_url, timeout=PATIENCE_S)
            assert response.status_code < 500
            operation.validate_response(response)

    check()


def test_a_document_of_ours_fits_the_published_schema() -> None:
    schema = json.loads((FOLDER / "procedural-model.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(schema).validate(box())
