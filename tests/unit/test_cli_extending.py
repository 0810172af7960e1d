"""`shapewright train --extend`: a class more for a classifier that is trained."""

import json
from pathlib import Path

import pytest
from command_line import shapewright, write_lamp_model

from shapewright.classification.evidence import UNKNOWN
from shapewright.modeling import Recorder


def write_model(folder: Path, name: str, size: tuple[float, float, float]) -> Path:
    recorder = Recorder(name, name)
    body = recorder.box(*size)
    recorder.extrude(body.top, 0.1, length="thickness")
    recorder.parameter("thickness", "thickness", 0.5, 2.0)
    recorder.build().save(folder / f"{name}.json")
    return folder / f"{name}.json"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Models of a lamp, a slab and a brick, and a classifier that knows the first two."""
    folder = tmp_path_factory.mktemp("extending")
    lamp, slab = write_lamp_model(folder), write_model(folder, "slab", (2.0, 1.0, 0.1))
    write_model(folder, "brick", (1.0, 1.0, 1.0))
    (folder / "base.json").write_text(json.dumps({"image_size": 64, "negatives": 8}))
    (folder / "few.json").write_text(json.dumps({"rehearsed": 4, "negatives": 8}))
    shapewright(
        "train", lamp, slab, "-o", folder / "base.onnx", "--variations", 8, "--images", 2,
        "--settings", folder / "base.json", "--cache", folder / "cache",
    )  # fmt: skip
    return folder


def test_a_class_is_added_and_the_known_models_are_named_again(folder: Path) -> None:
    document = shapewright(
        "train", folder / "brick.json", folder / "lamp.json", folder / "slab.json", "--extend", folder / "base.onnx",
        "-o", folder / "more.onnx", "--variations", 10, "--images", 2, "--settings", folder / "few.json",
        "--cache", folder / "cache", "--json",
    ).document  # fmt: skip
    assert document["class_names"] == ["lamp", "slab", "brick"]
    assert document["models"] == {"lamp": ["lamp"], "slab": ["slab"], "brick": ["brick"]}
    assert document["extended"] == str(folder / "base.onnx")
    assert {"known_accuracy", "known_accuracy_before", "new_accuracy"} <= document["metrics"].keys()
    assert Path(document["exemplars_file"]).is_file()
    shapewright("instance", folder / "brick.json", "-o", folder / "query.off")
    (result,) = shapewright("classify", folder / "query.off", "-c", folder / "more.onnx", "--json").document["results"]
    assert {one["class_name"] for one in result["probabilities"]} == {"lamp", "slab", "brick"}
    assert result["answer"] in (result["class_name"], UNKNOWN)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--extend", "base.onnx"), "name the classes to add"),
        (
            ("brick.json", "--extend", "base.onnx"),
            "models that do not ship in that version (lamp, slab); name their files",
        ),
        (("lamp.json", "slab.json", "--extend", "base.onnx"), "knows the class 'lamp' already"),
        (("table", "--extend", "ready"), "ready: knows the class 'table' already"),
        (("brick.json", "--extend", "missing.onnx"), "missing.onnx: cannot be read"),
        (("brick.json", "--extend", "brick.json"), "brick.json: not an ONNX file"),
        (("brick.json", "--extend", "ready", "--seed", "3"), "seed: cannot be chosen"),
        (("brick.json", "--extend", "ready", "--settings", "unknown.json"), "colour: no such setting"),
        (("chair", "--extend", "ready", "--variations", "1"), "variations: is 1"),
    ],
)
def test_refusals_are_one_line_and_leave_nothing_behind(
    folder: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], told: str
) -> None:
    (folder / "unknown.json").write_text('{"colour": "red"}')
    monkeypatch.chdir(folder)
    before = sorted(folder.rglob("*"))
    assert told in shapewright("train", *arguments, "-o", "none.onnx").refused()
    assert sorted(folder.rglob("*")) == before
