"""The classifier that ships: of the models that ship, small, found by name, and asked where none is named."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from command_line import shapewright as command

import shapewright
from cli import ready_classifier
from models_store.library.shipped import load_shipped
from shapewright.classification import (
    exemplars_file,
    load_classifier,
    load_ready_classifier,
    ready_classifier_file,
    ready_files,
)
from shapewright.distances.surface import uniform_points
from shapewright.errors import ClassifierError
from shapewright.mesh import PointCloud
from shapewright.mesh.file import load_mesh
from shapewright.training import TrainingSettings

TEN = {
    "bicycle",
    "bird",
    "fish",
    "glass_with_stem",
    "gun",
    "helicopter",
    "office_chair",
    "spider",
    "sword",
    "table",
}


@pytest.fixture(scope="module")
def trained_with() -> TrainingSettings:
    return TrainingSettings.from_dict(load_ready_classifier().metadata["settings"])


@pytest.fixture
def goblet(repository: Path) -> Path:
    return repository / "examples" / "goblet.ply"


def test_it_has_learned_the_models_that_ship_and_is_small(trained_with: TrainingSettings) -> None:
    file = ready_classifier_file()
    assert ready_classifier.faults(file, trained_with) == []
    assert set(load_ready_classifier().class_names) == TEN
    assert file.stat().st_size + exemplars_file(file).stat().st_size <= 12_000_000


def test_a_model_that_changed_is_noticed(trained_with: TrainingSettings, monkeypatch: pytest.MonkeyPatch) -> None:
    def changed(name: str) -> SimpleNamespace:
        return SimpleNamespace(digest="0" * 64 if name == "sword_katana" else load_shipped(name).digest)

    monkeypatch.setattr(ready_classifier, "load_shipped", changed)
    assert ready_classifier.faults(ready_classifier_file(), trained_with) == [
        "it has learned another version of sword_katana"
    ]


def test_models_that_came_or_went_and_other_settings_are_noticed(
    trained_with: TrainingSettings, monkeypatch: pytest.MonkeyPatch
) -> None:
    classes = {name: models for name, models in ready_classifier.list_classes().items() if name != "table"}
    monkeypatch.setattr(ready_classifier, "list_classes", lambda: classes | {"extra": ["stool"]})
    other = TrainingSettings.from_dict(trained_with.to_dict() | {"epochs": 3})
    missing, gone, settings = ready_classifier.faults(ready_classifier_file(), other)
    assert missing == "it has not learned stool"
    assert "table_wire" in gone
    assert settings == "it was trained with other settings: epochs"


def test_the_check_says_what_to_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(ready_classifier, "ready_classifier_place", lambda: tmp_path / "classifier.onnx")
    monkeypatch.setattr("sys.argv", ["ready_classifier", "--check"])
    assert ready_classifier.main() == 1
    told = capsys.readouterr().err
    assert "classifier.onnx" in told
    assert "bash scripts/ready_classifier" in told


def test_one_call_classifies_a_file_or_a_mesh(goblet: Path) -> None:
    of_file = shapewright.classify(goblet, views=4)
    assert of_file.class_name == "glass_with_stem"
    assert len(of_file.images) == 4
    mesh = shapewright.load_mesh(goblet)
    named = shapewright.classify(mesh, classifier=load_classifier(ready_classifier_file()), views=4)
    assert named.probabilities == pytest.approx(of_file.probabilities)
    assert load_ready_classifier() is load_ready_classifier()


def test_another_classifier_is_named_by_its_file(goblet: Path) -> None:
    with pytest.raises(ClassifierError, match=r"nowhere\.onnx"):
        shapewright.classify(goblet, classifier="nowhere.onnx")


def test_an_installation_without_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ready_files, "_FOLDER", "nowhere")
    with pytest.raises(ClassifierError, match="bash scripts/ready_classifier"):
        ready_classifier_file()
    monkeypatch.setattr(ready_files, "_PACKAGE", "no_such_package.library")
    with pytest.raises(ClassifierError, match="not installed"):
        ready_classifier_file()


def test_the_command_takes_it_and_says_so(goblet: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    document = command("classify", goblet, "--views", 3, "--json").document
    assert document["classifier"] == "ready"
    assert document["results"][0]["class_name"] == "glass_with_stem"
    assert command("classify", goblet, "--views", 3).stdout.endswith("classifier: the one that ships\n")
    ranked = command("retrieve", goblet.parent, "--class", "glass_with_stem", "--json").document
    assert ranked["classifier"] == "ready"
    assert ranked["n"] == 1


def test_a_point_cloud_is_a_query_too(goblet: Path) -> None:
    cloud = PointCloud(uniform_points(load_mesh(goblet), 4000, rng=np.random.default_rng(0)))
    assert shapewright.classify(cloud).class_name == "glass_with_stem"
