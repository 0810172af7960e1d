"""`shapewright evaluate classification` and `retrieval` on a small dataset of two shipped classes and an other."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_line import shapewright, write_lamp_model
from small_dataset import write_dataset

from cli.evaluate_classifier import Options, _settings
from models_store.library.shipped import load_shipped
from shapewright.evaluation.retrieval_metrics import average_precision
from shapewright.modeling import compile_model

SETTINGS = {"variations": 16, "images_per_variation": 2, "image_size": 128, "negatives": 8, "epochs": 15}


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three swords, three stools that no class stands for, three glasses, and files that cannot be read."""
    folder = tmp_path_factory.mktemp("data")
    write_dataset(
        folder, [(compile_model(load_shipped(name)), 3) for name in ("sword_katana", "stool", "glass_with_stem")]
    )
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
    assert set(document["evidence"]) == {"pictures", "panorama_to_default", "no_variation", "random_weights"}
    assert 0 < document["seconds_per_mesh_median"] < 30
    assert document["skipped_count"] == len(document["skipped"]) == 2
    assert document["unknown"]["right_of_known"] <= document["unknown"]["accepted_known"]
    page = report.read_text()
    assert "known against other" in page
    shown = [row for row in document["meshes"] if row["class"] != row["answer"] != "unknown"]
    assert page.count("<figure>") >= len(shown)


@pytest.mark.parametrize(("threshold", "accepted", "refused"), [(0.0, 1.0, 0.0), (1.0, 0.0, 1.0)])
def test_the_threshold_moves_what_is_accepted(
    common: tuple[str | Path, ...], threshold: float, accepted: float, refused: float
) -> None:
    arguments = ("evaluate", "classification", *common, "--no-baselines", "--threshold", threshold, "--json")
    document = shapewright(*arguments).document
    assert document["threshold"] == threshold
    unknown = document["unknown"]
    assert (unknown["accepted_known"], unknown["refused_other"]) == (accepted, refused)


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
    for other in ("combined", "pictures", "panorama", "no_variation", "random_weights"):
        assert 0.0 < document[f"mean_average_precision_{other}"] <= 1.0
    page = report.read_text()
    assert page.count("<polyline") == 6
    assert "What is taken for what" in page


def test_a_ranking_is_the_one_that_retrieve_gives(
    common: tuple[str | Path, ...], dataset: Path, tmp_path: Path
) -> None:
    arguments = ("--settings", dataset / "settings.json", "--cache", common[-1])
    trained = shapewright("train", "sword_katana", "glass_with_stem", "-o", tmp_path / "c.onnx", *arguments)
    assert trained.status == 0, trained.stderr
    options = ("-c", tmp_path / "c.onnx", "--dataset", dataset, "--no-baselines", "--json")
    figures = shapewright("evaluate", "retrieval", *options).document
    assert figures["mean_average_precision_no_variation"] is None
    folder = dataset / "meshes"
    for name, one in figures["per_class"].items():
        found = shapewright("retrieve", folder, "-c", tmp_path / "c.onnx", "--class", name, "--limit", 99, "--json")
        ranking = [Path(row["file"]).name.startswith(name) for row in found.document["results"]]
        assert average_precision(np.array(ranking)) == pytest.approx(one["average_precision"])


def test_a_classifier_of_classes_that_do_not_ship_has_no_baselines(dataset: Path, tmp_path: Path) -> None:
    lamp = write_lamp_model(tmp_path)
    arguments = ("--settings", dataset / "settings.json", "--cache", tmp_path / "cache")
    trained = shapewright("train", "sword_katana", lamp, "-o", tmp_path / "mine.onnx", *arguments)
    assert trained.status == 0, trained.stderr
    outcome = shapewright("evaluate", "classification", "--dataset", dataset, "-c", tmp_path / "mine.onnx", "--json")
    assert outcome.status == 0, outcome.stderr
    assert "no models of the class 'lamp' ship" in outcome.stderr
    assert set(outcome.document["evidence"]) == {"pictures"}
    assert outcome.document["n"] == 3


def test_the_seed_that_is_asked_for_counts(dataset: Path, tmp_path: Path) -> None:
    with_seed = tmp_path / "settings.json"
    with_seed.write_text(json.dumps(SETTINGS | {"seed": 7}))
    chosen = _settings(Options(dataset, None, None, None, 10, with_seed, 3, None, None, baselines=False))
    assert chosen is not None
    assert chosen.seed == 3


def test_one_is_trained_only_if_none_is_named_and_training_is_asked_for() -> None:
    none = Options(Path(), None, None, None, 10, None, 0, None, None, baselines=False)
    settings, named = replace(none, settings_file=Path("settings.json")), replace(none, classifier=Path("mine.onnx"))
    assert [one.trains for one in (none, replace(none, train=True), settings)] == [False, True, True]
    assert not named.trains
    assert not replace(named, train=True, settings_file=Path("settings.json")).trains


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
