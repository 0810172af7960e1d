"""`shapewright evaluate robustness` on a small dataset of two shipped classes and an other."""

import json
from pathlib import Path

import pytest
from command_line import shapewright
from small_dataset import write_dataset

from models_store.library.shipped import load_shipped
from shapewright.evaluation.corruptions import CORRUPTIONS
from shapewright.modeling import compile_model

SETTINGS = {"variations": 16, "images_per_variation": 2, "image_size": 128, "negatives": 8, "epochs": 15}
FIGURES = {
    "n",
    "n_other",
    "accuracy",
    "accuracy_pictures",
    "auroc_known",
    "accepted_known",
    "refused_other",
    "skipped",
}


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two swords, two stools that no class stands for, two glasses, and files that cannot be read."""
    folder = tmp_path_factory.mktemp("data")
    write_dataset(
        folder, [(compile_model(load_shipped(name)), 2) for name in ("sword_katana", "stool", "glass_with_stem")]
    )
    (folder / "settings.json").write_text(json.dumps(SETTINGS))
    return folder


@pytest.fixture(scope="module")
def classifier(dataset: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A classifier that `train` wrote; its cache lies beside it."""
    file = tmp_path_factory.mktemp("trained") / "c.onnx"
    settings = ("--settings", dataset / "settings.json", "--cache", file.parent / "cache")
    trained = shapewright("train", "sword_katana", "glass_with_stem", "-o", file, *settings)
    assert trained.status == 0, trained.stderr
    return file


@pytest.fixture(scope="module")
def common(dataset: Path, classifier: Path) -> tuple[str | Path, ...]:
    return ("evaluate", "robustness", "--dataset", dataset, "-c", classifier)


def test_one_document_with_all_figures(common: tuple[str | Path, ...], classifier: Path, tmp_path: Path) -> None:
    report = tmp_path / "new" / "robustness.html"
    options = ("--corruptions", "flipped,half", "--seed", "3", "--jobs", "1", "--views", "4")
    outcome = shapewright(*common, *options, "--json", "--report", report)
    assert outcome.status == 0, outcome.stderr
    document = outcome.document
    assert document["class_names"] == ["sword", "glass_with_stem"]
    assert document["classifier"]["file"] == str(classifier)
    assert len(document["classifier"]["digest"]) == 64
    assert (document["seed"], document["views"], document["strengths"]) == (3, 4, "all")
    assert (document["clean"]["n"], document["clean"]["n_other"]) == (4, 3)
    assert {name: list(row) for name, row in document["per_corruption"].items()} == {
        "flipped": ["0.25", "0.5", "1"],
        "half": ["256", "128", "64"],
    }
    rows = [row for by_strength in document["per_corruption"].values() for row in by_strength.values()]
    assert all(set(row) == FIGURES for row in (document["clean"], *rows))
    assert document["mean_accuracy"] == pytest.approx(sum(row["accuracy"] for row in rows) / 6)
    assert document["mean_error"] == pytest.approx(1.0 - document["mean_accuracy"])
    assert document["mean"]["accuracy"] == document["mean_accuracy"]
    assert [(one["file"], one["corruption"]) for one in document["skipped"]] == [
        ("broken.off", None),
        ("missing.off", None),
    ]
    assert document["skipped_count"] == 2
    assert len(document["meshes"]) == 7
    page = report.read_text()
    assert page.count("data:image/png;base64,") >= 1 + 6
    assert "missing.off: cannot be read" in page

    judged = shapewright(
        "evaluate", "classification", *common[2:], "--no-baselines", "--seed", "3", "--views", "4", "--json"
    )
    assert judged.document["accuracy"] == document["clean"]["accuracy"]
    assert judged.document["auroc_known"] == document["clean"]["auroc_known"]
    assert judged.document["unknown"]["refused_other"] == document["clean"]["refused_other"]


def test_a_table_of_eighty_columns_and_what_was_skipped(common: tuple[str | Path, ...]) -> None:
    outcome = shapewright(*common, "--corruptions", "flipped", "--strengths", "middle", "--views", "1", "--jobs", "2")
    assert outcome.status == 0, outcome.stderr
    lines = outcome.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert lines[0].split() == ["corruption", "right", "pictures", "AUROC", "accepted", "refused"]
    assert lines[1].startswith("(clean)")
    assert "strengths: accuracy " in outcome.stdout
    assert "skipped missing.off: cannot be read" in outcome.stderr


def test_a_classifier_is_trained_if_none_is_named(dataset: Path, classifier: Path) -> None:
    options = ("--settings", dataset / "settings.json", "--cache", classifier.parent / "cache", "--views", "1")
    narrowed = ("--limit", "3", "--corruptions", "flipped", "--strengths", "middle", "--jobs", "1")
    outcome = shapewright("evaluate", "robustness", "--dataset", dataset, *options, *narrowed, "--json")
    assert outcome.status == 0, outcome.stderr
    document = outcome.document
    assert document["class_names"] == ["glass_with_stem", "sword"]
    assert len(document["meshes"]) + document["skipped_count"] == 3
    assert list(document["per_corruption"]) == ["flipped"]
    assert list(document["per_corruption"]["flipped"]) == ["0.5"]


def test_refusals(common: tuple[str | Path, ...], dataset: Path, tmp_path: Path) -> None:
    assert "--corruptions: unknown corruption 'rust'" in shapewright(*common, "--corruptions", "rust").refused()
    assert "--corruptions: expected the name of a corruption" in shapewright(*common, "--corruptions", ",").refused()
    assert "--classes" in shapewright(*common, "--classes", "airship").refused()
    assert "a file is needed" in shapewright(*common, "--report", tmp_path).refused()
    assert "labels.csv" in shapewright("evaluate", "robustness", "--dataset", tmp_path).refused()
    missing = ("evaluate", "robustness", "--dataset", dataset, "-c", tmp_path / "missing.onnx")
    assert "missing.onnx" in shapewright(*missing).refused()
    assert shapewright(*common, "--strengths", "some").status == 2


def test_the_help_names_every_corruption() -> None:
    text = shapewright("evaluate", "robustness", "--help").stdout
    assert all(name in text for name in CORRUPTIONS)


def test_the_documentation_lists_every_corruption(repository: Path) -> None:
    text = (repository / "docs" / "robustness.md").read_text()
    for corruption in CORRUPTIONS.values():
        strengths = ", ".join(f"{strength:g}" for strength in corruption.strengths)
        assert f"| `{corruption.name}` | {corruption.meaning} | {strengths} |" in text
