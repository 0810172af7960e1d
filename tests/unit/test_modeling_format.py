"""The document: its schema, its upgrades, and what is refused, with the place."""

import copy
import json
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from random_models import Recipe, recipes

from shapewright.errors import ModelError, ParameterError
from shapewright.modeling import ProceduralModel, Recorder, compile_model, json_schema
from shapewright.modeling.upgrade import FORMAT, upgrade_document


def stool() -> dict[str, Any]:
    recorder = Recorder("stool", "stool", description="a seat")
    recorder.parameter("height", "seat height", 0.5, 2.0, unit="cm", base_value=45.0)
    seat = recorder.prism(6, 1.0, 0.1)
    recorder.extrude(seat.bottom, 0.5, length="height")
    recorder.scale(seat.bottom, 0.3)
    document: dict[str, Any] = recorder.build().to_document()
    return document


def test_the_schema_accepts_what_we_write() -> None:
    jsonschema.Draft202012Validator.check_schema(dict(json_schema()))
    jsonschema.validate(stool(), dict(json_schema()))


@settings(max_examples=15, deadline=None)
@given(recipes())
def test_the_schema_accepts_any_model(recipe: Recipe) -> None:
    jsonschema.validate(json.loads(recipe.build().to_json()), dict(json_schema()))


@pytest.mark.parametrize(
    ("path", "value", "where", "message"),
    [
        (("operations", 1, "op"), "explode", "operations[1].op", "unknown operation"),
        (("operations", 1, "targets", 0, "elements", 0), "f77", "operations[1]", "f77 does not exist"),
        (
            ("operations", 1, "targets", 0, "elements", 0),
            "q1",
            "operations[1].targets[0].elements[0]",
            "not an element",
        ),
        (("operations", 1, "z"), "high", "operations[1].z", "not a finite number"),
        (("operations", 1, "z"), 1e300, "operations[1].z", "beyond"),
        (("operations", 1, "speed"), 1, "operations[1]", "no field 'speed'"),
        (("operations", 1, "targets"), [], "operations[1]", "nothing is selected"),
        (("operations", 0, "size", 0), -1.0, "operations[0]", "above 0"),
        (("operations", 0, "sides"), 2, "operations[0].sides", "whole number"),
        (("parameters", 0, "range"), [2.0, 3.0], "parameters[0]", "excludes 1"),
        (("parameters", 0, "range"), [1.0], "parameters[0].range", "two numbers"),
        (("parameters", 0, "name"), "Seat Height", "parameters[0]", "no parameter name"),
        (("parameters", 0, "targets", 0, "operation"), 9, "parameters[0].targets[0].operation", "no operation 9"),
        (("parameters", 0, "targets", 0, "mode"), "colour", "parameters[0].targets[0].mode", "no mode"),
        (("format",), "gltf", "format", "no procedural model"),
        (("version",), 99, "version", "newer"),
        (("version",), "one", "version", "no version"),
        (("name",), "../etc", "name", "no name"),
        (("surprise",), 1, "document", "unknown field"),
        (("operations",), [], "operations", "must be a base"),
        (("operations",), {"a": 1}, "operations", "a list"),
        (("closed",), "yes", "closed", "true or false"),
        (("unit_m",), 0.0, "unit_m", "positive number of meters"),
        (("unit_m",), "m", "unit_m", "not a finite number"),
        (("parameters", 0, "kind"), "weight", "parameters[0].kind", "none of length"),
    ],
)
def test_a_wrong_document_is_refused_with_the_place(
    path: tuple[Any, ...], value: Any, where: str, message: str
) -> None:
    document = copy.deepcopy(stool())
    holder: Any = document
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    with pytest.raises(ModelError, match=message) as caught:
        compile_model(ProceduralModel.from_document(document))
    assert caught.value.where == where


@pytest.mark.parametrize(
    ("text", "where"),
    [
        ("{", "line 1 column 2"),
        ('{"a": NaN}', None),
        ("[" * 100_000, None),
        (b"\xff\xfe\x00", None),
        ('{"format": "\\ud800"}', None),
        ("[]", "document"),
    ],
)
def test_broken_json_is_refused(text: str | bytes, where: str | None) -> None:
    with pytest.raises(ModelError) as caught:
        ProceduralModel.from_json(text)
    assert caught.value.where == where


def test_a_second_parameter_of_one_name_is_refused() -> None:
    document = stool()
    document["parameters"].append(document["parameters"][0])
    with pytest.raises(ModelError, match="second parameter") as caught:
        ProceduralModel.from_document(document)
    assert caught.value.where == "parameters[1].name"


def test_old_documents_climb_one_version_at_a_time() -> None:
    old = {"format": FORMAT, "version": 1, "size": 2}
    steps = {1: lambda d: {**d, "size": [d["size"]] * 3}, 2: lambda d: {**d, "name": "box"}}
    upgraded = upgrade_document(old, upgrades=steps, version=3)
    assert upgraded == {"format": FORMAT, "version": 3, "size": [2, 2, 2], "name": "box"}
    assert old["version"] == 1


def test_older_documents_get_the_kinds_that_their_units_tell() -> None:
    document = stool()
    old = {**{key: value for key, value in document.items() if key != "unit_m"}, "version": 2}
    height = {**document["parameters"][0], "name": "height", "unit": "cm"}
    tilt = {**height, "name": "tilt", "unit": "deg"}
    plain = {**height, "name": "plain", "unit": None}
    for parameter in (height, tilt, plain):
        parameter.pop("kind", None)
    model = ProceduralModel.from_document({**old, "parameters": [height, tilt, plain]})
    assert [parameter.kind for parameter in model.parameters] == ["length", "angle", None]
    assert model.unit_m is None
    assert json.loads(model.to_json())["version"] == 3


def test_a_kind_that_the_unit_contradicts_is_refused() -> None:
    document = stool()
    document["parameters"][0] |= {"unit": "deg", "kind": "length"}
    with pytest.raises(ModelError, match="therefore not of kind 'length'"):
        ProceduralModel.from_document(document)


def test_a_file_that_is_not_there(tmp_path: Any) -> None:
    with pytest.raises(ModelError, match="cannot be read"):
        ProceduralModel.load(tmp_path / "nothing.json")


def test_values_by_name() -> None:
    compiled = compile_model(ProceduralModel.from_document(stool()))
    np.testing.assert_array_equal(compiled.values_from_mapping({}), [1.0])
    np.testing.assert_array_equal(compiled.values_from_mapping({"height": 1.5}), [1.5])
    for wrong in ({"width": 1.0}, {"height": 9.0}, {"height": float("nan")}, {"height": 10**400}):
        with pytest.raises(ParameterError) as caught:
            compiled.values_from_mapping(wrong)
        assert caught.value.where == f"values.{next(iter(wrong))}"
    with pytest.raises(ParameterError, match="no batch"):
        compiled.control_points(np.ones((1, 2)))


def test_recorder_wants_parameters_that_act() -> None:
    recorder = Recorder("a", "a")
    box = recorder.box(1, 1, 1)
    recorder.parameter("idle", "idle", 0.5, 2)
    with pytest.raises(ModelError, match="changes nothing"):
        recorder.build()
    recorder.extrude(box.top, 1.0, length="unknown", height="idle")
    with pytest.raises(ModelError, match="not declared"):
        recorder.build()


def test_a_document_cannot_fill_the_memory() -> None:
    document = stool()
    copies = [{"elements": [], "frame": "world"}] * 4000
    document["operations"] = [
        {"op": "base", "shape": "ring", "size": [4, 4, 1], "sides": 256, "tube_sides": 256, "anchors": copies}
    ]
    document["parameters"] = []
    with pytest.raises(ModelError, match="200000 vertices") as caught:
        compile_model(ProceduralModel.from_document(document))
    assert caught.value.where == "operations[0]"
