"""`shapewright evaluate classification` and `retrieval` on a small dataset of two shipped classes and an other."""

import json
from pathlib import Path

import pytest
from command_line import shapewright
from small_dataset import write_dataset

from models_store.library.shipped import load_shipped

SETTINGS = {"variations": 16, "images_per_variation": 2, "image_size": 128, "negatives": 8, "epochs": 15}


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three swords, three stools that no class stands for, three glasses, and files that cannot be read."""
    folder = tmp_path_factory.mktemp("data")
    write_dataset(folder, [(load_shipped(name).compile(), 3) for name in ("sword_katana", "stool", "glass_with_stem")])
    (folder / "settings.json").write_text(json.dumps(SETTINGS))
    return folder


@pytest.fixture(scope="module")
def common(dataset: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[str | Path, ...]:
    """Options whose runs share a cache."""
    cache = tmp_path_factory.mktemp("cache")
    return ("--dataset", dataset, "--settings", dataset / "settings.json", "--cache", cache)


def test_classification_gives_all_figures(common: tuple[str | Path, ...], tmp_path: Path) -> None:
    report = tmp_path / "new" / "classified.html"
    outcome = shapewright("evaluate", "classification", *common, "--json", "--report", report)
    assert outcome.status == 0
    document = outcome.document
    assert document["class_names"] == ["glass_with_stem", "sword"]
    assert (document["n"], document["n_other"]) == (6, 4)
    assert document["accuracy"] == 1.0
    assert {name: row["n"] for name, row in document["per_class"].items()} == {"glass_with_stem": 3, "sword": 3}
    assert document["confusion"]["sword"] == {"glass_with_stem": 0, "sword": 3}
    assert sum(document["confusion"]["other"].values()) == 4
    assert 0.5 < document["auroc_known"] <= 1.0
    assert set(document["evidence"]) == {"pictures", "panorama_to_default"}
    assert 0 < document["seconds_per_mesh_median"] < 30
    assert document["skipped_count"] == len(document["skipped"]) == 2
    assert document["unknown"]["right_of_known"] <= document["unknown"]["accepted_known"]
    page = report.read_text()
    assert "known against other" in page
    shown = [row for row in document["meshes"] if row["class"] != row["answer"] != "unknown"]
    assert page.count("<figure>") >= len(shown)


def test_retrieval_is_compared_with_both_baselines(common: tuple[str | Path, ...], tmp_path: Path) -> None:
    report = tmp_path / "retrieved.html"
    outcome = shapewright("evaluate", "retrieval", *common, "--json", "--report", report)
    assert outcome.status == 0
    document = outcome.document
    assert document["n"] == 10
    assert document["mean_average_precision"] == pytest.approx(
        sum(row["average_precision"] for row in document["per_class"].values()) / 2
    )
    assert document["mean_average_precision"] > 0.8
    for baseline in ("panorama", "no_variation"):
        assert 0.0 < document[f"mean_average_precision_{baseline}"] <= 1.0
    assert report.read_text().count("<polyline") == 4


@pytest.mark.parametrize("verb", ["classification", "retrieval"])
def test_limits_and_refusals(verb: str, common: tuple[str | Path, ...], dataset: Path) -> None:
    refused = shapewright("evaluate", verb, *common, "--classes", "airship")
    assert refused.status == 2
    assert "--classes" in refused.stderr
    assert shapewright("evaluate", verb, "--dataset", dataset / "nowhere").status == 2
    assert shapewright("evaluate", verb, *common, "-c", "missing.onnx").status == 2


def test_a_table_for_people(common: tuple[str | Path, ...]) -> None:
    outcome = shapewright("evaluate", "classification", *common, "--limit", "4")
    assert outcome.status == 0
    assert "all evidence:" in outcome.stdout
    assert "ms (median)" in outcome.stdout
