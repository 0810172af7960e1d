"""`shapewright instance` writes meshes of any type, with the values asked for, and leaves nothing after a refusal."""

import json
from pathlib import Path

import numpy as np
import pytest
from chair_model import armchair
from command_line import shapewright, write_lamp_model

from shapewright.mesh.file import load_mesh
from shapewright.modeling import compile_model


@pytest.fixture
def lamp(tmp_path: Path) -> Path:
    return write_lamp_model(tmp_path)


@pytest.mark.parametrize("ending", ["glb", "obj", "off", "ply", "stl"])
def test_each_file_type_holds_the_same_object(lamp: Path, tmp_path: Path, ending: str) -> None:
    path = tmp_path / "out" / f"lamp.{ending}"
    document = shapewright("instance", lamp, "-o", path, "--json").document
    written, base = load_mesh(path), document["instances"][0]
    assert base["values"] == {"post_length": 1.0, "post_width": 1.0}
    assert len(written.faces) == base["face_count"]
    height = float(np.ptp(written.bounds, axis=0).max())
    assert height == pytest.approx(1.3, abs=0.15)


def test_set_changes_the_named_parameter_only(lamp: Path, tmp_path: Path) -> None:
    path = tmp_path / "long.off"
    document = shapewright("instance", lamp, "-o", path, "--set", "post_length=2", "--json").document
    assert document["instances"][0]["values"] == {"post_length": 2.0, "post_width": 1.0}
    assert np.ptp(load_mesh(path).bounds, axis=0).max() == pytest.approx(2.3, abs=0.15)


def test_an_option_may_be_named_and_random_values_keep_it(tmp_path: Path) -> None:
    chair = tmp_path / "chair.json"
    armchair().save(chair)
    named = ("--set", "back=no back", "--set", "armrests=without")
    base = shapewright("instance", chair, "-o", tmp_path / "a.off", *named, "--json").document["instances"][0]
    assert (base["values"]["back"], base["values"]["armrests"]) == (3.0, 0.0)
    full = shapewright("instance", chair, "-o", tmp_path / "b.off", "--json").document["instances"][0]
    assert base["face_count"] < full["face_count"]
    arguments = ("instance", chair, "-o", tmp_path / "c.off", "--random", "--count", 4, *named, "--json")
    compiled = compile_model(armchair())
    for item in shapewright(*arguments).document["instances"]:
        assert (item["values"]["back"], item["values"]["armrests"]) == (3.0, 0.0)
        row = np.array([list(item["values"].values())])
        np.testing.assert_array_equal(compiled.settle(row), row)
    refused = shapewright("instance", chair, "-o", tmp_path / "d.off", "--set", "back=middle").refused()
    assert "low back, high back, no back" in refused
    beyond = shapewright(
        "instance", chair, "-o", tmp_path / "d.off", "--set", "leg_length=0.6", "--set", "ring_height=1"
    )
    assert "given leg_length" in beyond.refused()


def test_values_come_from_a_file_too(lamp: Path, tmp_path: Path) -> None:
    values = tmp_path / "values.json"
    values.write_text(json.dumps({"post_width": 1.25}))
    document = shapewright("instance", lamp, "-o", tmp_path / "a.stl", "--values", values, "--json").document
    assert document["instances"][0]["values"]["post_width"] == 1.25


def test_variations_are_different_in_range_and_the_same_for_a_seed(lamp: Path, tmp_path: Path) -> None:
    arguments = ("instance", lamp, "--random", "--count", "4", "--set", "post_width=0.75", "--json")
    first = shapewright(*arguments, "--seed", "3", "-o", tmp_path / "a.ply").document["instances"]
    again = shapewright(*arguments, "--seed", "3", "-o", tmp_path / "b.ply").document["instances"]
    lengths = [item["values"]["post_length"] for item in first]
    assert len(set(lengths)) == 4
    assert all(0.5 <= length <= 2.0 for length in lengths)
    assert {item["values"]["post_width"] for item in first} == {0.75}
    assert [item["values"] for item in first] == [item["values"] for item in again]
    assert (tmp_path / "a-003.ply").read_bytes() == (tmp_path / "b-003.ply").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["-o", "lamp.step"], "write one of"),
        (["-o", "lamp.glb", "--set", "height=2"], "height"),
        (["-o", "lamp.glb", "--set", "post_length=9"], "post_length"),
        (["-o", "lamp.glb", "--set", "post_length=nan"], "post_length"),
        (["-o", "lamp.glb", "--set", "post_length"], "name=number"),
        (["-o", "lamp.glb", "--values", "missing.json"], "missing.json"),
        (["-o", "lamp.glb", "--count", "3"], "--random"),
    ],
)
def test_refusals_leave_nothing_behind(
    lamp: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], told: str
) -> None:
    folder = tmp_path / "empty"
    folder.mkdir()
    monkeypatch.chdir(folder)
    assert told in shapewright("instance", lamp, *arguments).refused()
    assert list(folder.iterdir()) == []
