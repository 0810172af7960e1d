"""`shapewright models` tells what there is and what is wrong."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from chair_model import armchair
from command_line import Outcome, shapewright, write_lamp_model

if TYPE_CHECKING:
    from shapewright.modeling import ProceduralModel


@pytest.fixture
def lamp(tmp_path: Path) -> Path:
    return write_lamp_model(tmp_path)


@pytest.fixture(scope="module")
def document() -> Outcome:
    """The list as a document."""
    return shapewright("models", "list", "--json")


@pytest.fixture(scope="module")
def table() -> Outcome:
    """The list for people."""
    return shapewright("models", "list")


def test_list_names_the_shipped_models(
    library_models: "dict[str, ProceduralModel]", document: Outcome, table: Outcome
) -> None:
    listed = document.document["models"]
    assert {item["name"]: item["digest"] for item in listed} == {m.name: m.digest for m in library_models.values()}
    assert all(name in table.stdout for name in library_models)


def test_without_more_words_the_models_are_listed(document: Outcome, table: Outcome) -> None:
    assert shapewright("models").stdout == table.stdout
    assert shapewright("models", "--json").stdout == document.stdout


def test_show_tells_ranges_and_units(lamp: Path) -> None:
    document = shapewright("models", "show", lamp, "--json").document
    assert document["name"] == "lamp"
    assert document["parameters"][0] == {
        "name": "post_length", "label": "length of the post", "unit": "mm", "base_value": 100.0,
        "minimum": 0.5, "maximum": 2.0, "options": [], "active_when": [], "limits": [],
    }  # fmt: skip
    text = shapewright("models", "show", lamp).stdout
    assert "0.5 … 2" in text
    assert "100 mm" in text


def test_show_tells_options_dependences_parts_and_symmetry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "160")
    path = tmp_path / "armchair.json"
    armchair().save(path)
    document = shapewright("models", "show", path, "--json").document
    back, _, _, arm_height, ring_height = document["parameters"]
    assert back["options"][1] == {"value": 2.0, "name": "high back"}
    assert arm_height["active_when"] == [{"parameter": "armrests", "minimum": 1.0, "maximum": 1.0}]
    assert ring_height["limits"][0]["parameter"] == "leg_length"
    assert [part["name"] for part in document["parts"]] == ["low back", "high back", "armrests"]
    assert document["symmetry"] == {"mirrors": ["y"], "axis": None, "order": 1}
    text = shapewright("models", "show", path).stdout
    for expected in (
        "1 low back, 2 high back, 3 no back",
        "only if armrests is with",
        "maximum 0.25 + 0.75 leg_length",
        "part high back: only if back is high back",
        "symmetry mirror y",
    ):
        assert expected in text


def test_the_list_names_each_class_once(
    library_models: "dict[str, ProceduralModel]", document: Outcome, table: Outcome
) -> None:
    listed = document.document["models"]
    assert [item["class_name"] for item in listed] == sorted(item["class_name"] for item in listed)
    lines = table.stdout.splitlines()
    for class_name in {model.class_name for model in library_models.values()}:
        assert len([line for line in lines if line.startswith(f"{class_name} ")]) == 1


def test_validate_accepts_a_good_model(lamp: Path) -> None:
    assert "valid (2 parameters, 1000 variations; replay topology" in shapewright("models", "validate", lamp).stdout


def test_validate_says_what_is_wrong_and_where(lamp: Path, tmp_path: Path) -> None:
    document = json.loads(lamp.read_text())
    document["parameters"][0]["range"] = [1.5, 2.0]
    excludes_one = tmp_path / "excludes-one.json"
    excludes_one.write_text(json.dumps(document))
    broken = tmp_path / "broken.json"
    broken.write_text('{"format": ')
    outcome = shapewright("models", "validate", lamp, excludes_one, broken, "--json")
    assert outcome.status == 2
    good, bad, no_json = outcome.document["files"]
    assert good["valid"]
    assert not bad["valid"]
    assert "parameters[0]" in bad["where"]
    assert not no_json["valid"]
    told = shapewright("models", "validate", excludes_one)
    assert told.status == 2
    assert len(told.stderr.strip().splitlines()) == 1
    assert f"shapewright: {excludes_one}: parameters[0]: " in told.stderr


def test_texts_of_strangers_are_no_markup(tmp_path: Path) -> None:
    document = armchair().to_document()
    document["description"] = document["parameters"][0]["label"] = document["parts"][0]["name"] = "a [/bold] [red]text"
    document["parameters"][0]["options"][0] = "[/]"
    path = tmp_path / "strange.json"
    path.write_text(json.dumps(document))
    outcome = shapewright("models", "show", path)
    assert outcome.status == 0
    assert "part a [/bold] [red]text: only if back is [/]" in outcome.stdout


def test_what_refers_to_nothing_is_refused_when_shown(tmp_path: Path) -> None:
    document = armchair().to_document()
    document["parts"][0]["present_when"][0]["parameter"] = "nobody"
    path = tmp_path / "dangling.json"
    path.write_text(json.dumps(document))
    assert "parts[0].present_when[0].parameter: there is no" in shapewright("models", "show", path).refused()


def test_an_unknown_model_lists_those_that_ship() -> None:
    assert "neither a file nor a shipped model" in shapewright("models", "show", "teapot").refused()


def test_validate_names_findings_with_the_values_that_show_them(lamp: Path, tmp_path: Path) -> None:
    document = json.loads(lamp.read_text())
    document["symmetry"]["mirrors"] = ["x"]
    lying = tmp_path / "lying.json"
    document["operations"].append(
        {"op": "drag", "targets": [{"elements": ["f1"], "frame": "world", "image": []}], "rho": 0.5}
    )
    lying.write_text(json.dumps(document))
    outcome = shapewright("models", "validate", lying, lamp, "--variations", 5, "--jobs", 2, "--json")
    assert outcome.status == 2
    bad, good = outcome.document["files"]
    assert good["valid"]
    assert not bad["valid"]
    assert all(good["checks"].values())
    assert [check for check, holds in bad["checks"].items() if not holds] == ["symmetry"]
    assert bad["findings"][0]["where"] == "mirror x"
    told = shapewright("models", "validate", lying, "--variations", 5)
    assert told.status == 2
    assert "1 finding (2 parameters, 5 variations; replay topology SYMMETRY! finite" in told.stdout
    assert "symmetry: mirror x: component c0 is off by" in told.stderr


def test_validate_takes_names_or_all() -> None:
    assert "--all" in shapewright("models", "validate").refused()
    assert "--all" in shapewright("models", "validate", "table", "--all").refused()
