"""`shapewright evaluate estimation` with an estimator that is made up, and once with the reference at its coarsest."""

import json
from pathlib import Path

import pytest
from command_line import shapewright
from made_up_estimator import base_answer
from small_dataset import write_dataset

from cli.evaluate_estimation import CorruptionName, estimation
from models_store.library.shipped import load_shipped
from shapewright.evaluation.corruptions import CORRUPTIONS
from shapewright.modeling import compile_model

SETTINGS = {
    "estimator": "reference",
    "samples": 4,
    "surface_points": 40,
    "image_size": 16,
    "subdivision_steps": 0,
    "step_sizes": [1.0],
    "alignment": {"translation_step": 0.5, "rotation_step_rad": 0.7, "scale_step": 0.4},
}
FIELDS = {"n", "layer_share", "zbuffer_median", "surface_median", "seconds_median", "seconds_p95", "per_class"}
SYNTHETIC_FIELDS = {
    "within_5_percent", "within_5_percent_determined", "within_5_percent_ratios", "determined_share", "options_right",
    "model_right", "pose_right", "interval_coverage", "interval_coverage_hardest_quarter", "interval_width_median",
    "zbuffer_median", "seconds_median", "per_parameter", "under_0_1",
}  # fmt: skip


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three stools, and what `write_dataset` adds that cannot be read, as stools; a cube of no class."""
    folder = tmp_path_factory.mktemp("data")
    write_dataset(folder, [(compile_model(load_shipped("stool")), 3)])
    labels = folder / "labels.csv"
    labels.write_text(labels.read_text().replace(",slab,", ",stool,"))
    (folder / "settings.json").write_text(json.dumps(SETTINGS))
    return folder


@pytest.fixture(scope="module")
def common(dataset: Path) -> tuple[str | Path, ...]:
    return ("evaluate", "estimation", "--settings", dataset / "settings.json", "--jobs", "1")


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shapewright.evaluation.estimated.estimate", base_answer)


def test_the_reference_estimates_a_dataset(common: tuple[str | Path, ...], dataset: Path) -> None:
    document = shapewright(*common, "--dataset", dataset, "--limit", "1", "--json").document
    assert document["n"] == 1
    assert document["estimator"] == "reference"
    assert list(document["distances_by_stage"]) == ["panorama", "surface", "surface+zbuffer", "zbuffer"]
    assert document["seconds_median"] == document["seconds_p95"] > 0


@pytest.mark.usefixtures("made_up")
def test_a_dataset_gives_layers_distances_and_a_page(
    common: tuple[str | Path, ...], dataset: Path, tmp_path: Path
) -> None:
    report = tmp_path / "new" / "estimated.html"
    outcome = shapewright(*common, "--dataset", dataset, "--json", "--report", report)
    assert outcome.status == 0
    document = outcome.document
    assert set(document) >= FIELDS
    assert document["n"] == 3
    assert document["estimator"] == "reference"
    assert sum(document["layer_share"].values()) == pytest.approx(1.0)
    assert document["per_class"]["stool"]["n"] == 3
    assert list(document["distances_by_stage"]) == ["panorama", "zbuffer"]
    assert {row["file"] for row in document["meshes"]} == {"stool0.off", "stool1.off", "stool2.off"}
    assert {row["model"] for row in document["meshes"]} == {"stool"}
    assert [skipped["file"] for skipped in document["skipped"]] == ["broken.off", "missing.off"]
    assert document["skipped_count"] == 2
    assert "within_5_percent" not in document
    page = report.read_text()
    assert page.count("data:image/png;base64,") == 3
    assert page.count("<polyline") == 4  # two distances, two stages
    assert "broken.off" in page
    assert "layer" in page


@pytest.mark.usefixtures("made_up")
def test_synthetic_queries_say_how_much_is_recovered(common: tuple[str | Path, ...], tmp_path: Path) -> None:
    report = tmp_path / "synthetic.html"
    command = (*common, "--synthetic", "2", "--classes", "stool", "--scale", "known", "--corruption", "half", "--json")
    outcome = shapewright(*command, "--strength", "64", "--report", report)
    assert outcome.status == 0
    document = outcome.document
    assert set(document) >= FIELDS | SYNTHETIC_FIELDS
    assert document["n"] == 2
    assert document["model_right"] == 1.0  # the class has one model
    assert document["corruption"] == {"name": "half", "strength": 64.0}
    assert document["scale"] == "known"
    assert set(document["per_parameter"]) == {"stool"}
    assert document["parameters"] <= document["parameters_active"]
    page = report.read_text()
    assert "How much of the truth was found" in page
    assert page.count("data:image/png;base64,") == 2


@pytest.mark.usefixtures("made_up")
def test_a_seed_draws_the_same_queries_again(common: tuple[str | Path, ...]) -> None:
    command = (*common, "--synthetic", "3", "--limit", "1", "--classes", "stool", "--model-known", "--json")
    first, second = (shapewright(*command, "--seed", "5").document for _ in range(2))
    assert first["n"] == 1
    assert first["model_right"] is None
    assert first["zbuffer_median"] == second["zbuffer_median"]
    assert first["per_parameter"] == second["per_parameter"]
    assert shapewright(*command, "--seed", "6").document["zbuffer_median"] != first["zbuffer_median"]


@pytest.mark.usefixtures("made_up")
def test_the_table_says_what_was_skipped(common: tuple[str | Path, ...], dataset: Path) -> None:
    outcome = shapewright(*common, "--dataset", dataset, "--corruption", "decimated")
    assert outcome.status == 0
    assert "layer 3" in outcome.stdout
    assert "reference: 3 queries" in outcome.stdout
    assert "skipped missing.off: cannot be read" in outcome.stderr


def test_refusals(common: tuple[str | Path, ...], dataset: Path, tmp_path: Path) -> None:
    assert "a dataset or a number" in shapewright(*common).refused()
    assert "a dataset or a number" in shapewright(*common, "--dataset", dataset, "--synthetic", "1").refused()
    assert "synthetic queries only" in shapewright(*common, "--dataset", dataset, "--model-known").refused()
    assert "name a corruption" in shapewright(*common, "--synthetic", "1", "--strength", "0.1").refused()
    strength = (*common, "--synthetic", "1", "--corruption", "holes", "--strength", "2")
    assert "expected a strength of 'holes' from 0 to 0.9, got 2" in shapewright(*strength).refused()
    assert "'teapot'" in shapewright(*common, "--synthetic", "1", "--classes", "teapot").refused()
    assert "--classes: no mesh" in shapewright(*common, "--dataset", dataset, "--classes", "fish").refused()
    assert "a file is needed" in shapewright(*common, "--synthetic", "1", "--report", tmp_path).refused()


def test_the_help_lists_every_corruption_of_meshes_and_its_strengths() -> None:
    leaving_faces = [corruption for corruption in CORRUPTIONS.values() if corruption.has_faces]
    assert [name.value for name in CorruptionName] == [corruption.name for corruption in leaving_faces]
    assert estimation.__doc__ is not None
    lines = [line.strip() for line in estimation.__doc__.splitlines()]
    assert [line for line in lines if line.split(":")[0] in CORRUPTIONS] == [one.summary for one in leaving_faces]
