"""`shapewright evaluate coverage` on a small dataset of two shipped classes."""

from pathlib import Path

import pytest
from command_line import shapewright
from small_dataset import write_dataset

from cli.evaluation_options import cache_folder, names_in
from models_store.library.shipped import load_shipped
from shapewright.modeling import compile_model


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two swords, two stools; a cube, and what `write_dataset` adds that cannot be read, as swords."""
    folder = tmp_path_factory.mktemp("data")
    write_dataset(folder, [(compile_model(load_shipped(name)), 2) for name in ("sword", "stool")])
    labels = folder / "labels.csv"
    labels.write_text(labels.read_text().replace(",slab,", ",sword,"))
    return folder


@pytest.fixture(scope="module")
def common(dataset: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[str | Path, ...]:
    """A command line whose runs share a cache."""
    cache = tmp_path_factory.mktemp("cache")
    return ("evaluate", "coverage", "--dataset", dataset, "--samples", "30", "--cache", cache)


def test_one_document_with_all_figures(common: tuple[str | Path, ...], dataset: Path, tmp_path: Path) -> None:
    report = tmp_path / "new" / "cover.html"
    outcome = shapewright(*common, "--json", "--report", report, "--worst", "1")
    assert outcome.status == 0
    document = outcome.document
    assert set(document["per_class"]) == {"sword", "stool"}
    for name, other in (("sword", "stool"), ("stool", "sword")):
        figures = document["per_class"][name]
        assert figures["n"] == 2
        assert figures["own_median"] < figures["nearest_other_median"]
        assert figures["nearest_other_class"] == other
        assert figures["own_median"] <= figures["own_mean"] + 1e-12
        assert figures["share_nearest"] == 1.0
        assert document["matrix"][name] == {name: figures["own_median"], other: figures["nearest_other_median"]}
    assert [skipped["file"] for skipped in document["skipped"]] == ["broken.off", "missing.off"]
    assert document["skipped_count"] == 2
    assert document["other_classes_count"] == 1
    assert document["dataset"] == str(dataset)
    assert {row["file"] for row in document["meshes"]} == {"sword0.off", "sword1.off", "stool0.off", "stool1.off"}
    assert report.read_text().count("data:image/png;base64,") >= 4


def test_the_table_says_which_mesh_was_skipped(common: tuple[str | Path, ...]) -> None:
    outcome = shapewright(*common)
    assert outcome.status == 0
    assert "sword" in outcome.stdout
    assert "own first" in outcome.stdout
    assert "skipped missing.off: cannot be read" in outcome.stderr
    assert "2 meshes were skipped" in outcome.stderr


def test_classes_rivals_and_a_limit_narrow_it(common: tuple[str | Path, ...]) -> None:
    document = shapewright(*common, "--classes", "stool", "--limit", "1", "--json").document
    assert document["n"] == 1
    assert set(document["matrix"]) == {"stool"}
    assert set(document["matrix"]["stool"]) == {"stool", "sword"}
    alone = shapewright(*common, "--classes", "stool", "--against", "stool", "--jobs", "1", "--json").document
    assert alone["per_class"]["stool"]["nearest_other_class"] is None
    assert alone["per_class"]["stool"]["nearest_other_median"] is None
    with_tower = shapewright(*common, "--classes", "stool", "--against", "tower", "--json").document
    assert set(with_tower["matrix"]["stool"]) == {"stool", "tower"}


def test_refusals(common: tuple[str | Path, ...], tmp_path: Path) -> None:
    assert "labels.csv" in shapewright("evaluate", "coverage", "--dataset", tmp_path).refused()
    assert "'teapot'" in shapewright(*common, "--classes", "teapot").refused()
    assert "--classes: no mesh of the dataset" in shapewright(*common, "--classes", "fish").refused()
    assert "--classes: no mesh of the dataset" in shapewright(*common, "--classes", ",").refused()
    assert "a file is needed" in shapewright(*common, "--report", tmp_path).refused()
    assert "--jobs" in shapewright(*common, "--jobs", "100000").refused()


def test_the_group_teaches() -> None:
    text = shapewright("evaluate", "--help").stdout
    assert "labels.csv" in text
    assert "coverage" in text
    assert "Examples:" in text
    verb = shapewright("evaluate", "coverage", "--help").stdout
    for option in ("--dataset", "--json", "--report", "--limit", "--classes", "--seed", "--jobs"):
        assert option in verb


def test_names_and_the_place_of_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert names_in(None) is None
    assert names_in("a, b,") == ["a", "b"]
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache_folder(None, "coverage") == tmp_path / "shapewright" / "coverage"
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert cache_folder(None, "coverage") == tmp_path / ".cache" / "shapewright" / "coverage"
    assert cache_folder(Path("mine"), "coverage") == Path("mine")
