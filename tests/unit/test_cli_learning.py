"""`shapewright train`, `classify` and `estimate` on two small models: a lamp and a slab."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from command_line import shapewright, write_lamp_model
from PIL import Image

from cli.sources import load_class, load_classes, load_negatives
from models_store.library.shipped import list_classes, list_further_classes
from shapewright.classification.evidence import KNOWN_THRESHOLD
from shapewright.mesh.file import load_mesh
from shapewright.modeling import Recorder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two models, a variation of each, and a classifier that was trained by the command."""
    folder = tmp_path_factory.mktemp("learning")
    lamp = write_lamp_model(folder)
    recorder = Recorder("slab", "slab")
    slab = recorder.box(2.0, 1.0, 0.1)
    recorder.extrude(slab.top, 0.1, length="thickness")
    recorder.parameter("thickness", "thickness", 0.5, 2.0)
    recorder.build().save(folder / "slab.json")
    shapewright("instance", lamp, "-o", folder / "query-lamp.off", "--set", "post_length=1.4")
    shapewright("instance", folder / "slab.json", "-o", folder / "query-slab.obj", "--set", "thickness=1.7")
    small = folder / "small.json"
    small.write_text(json.dumps({"image_size": 96, "epochs": 30, "negatives": 12}))
    trained = shapewright(
        "train", lamp, folder / "slab.json", "-o", folder / "out" / "classifier.onnx", "--variations", 12,
        "--images", 4, "--settings", small, "--json",
    )  # fmt: skip
    (folder / "trained.json").write_text(trained.stdout)
    return folder


def test_training_tells_what_it_learned(folder: Path) -> None:
    document = json.loads((folder / "trained.json").read_text())
    assert sorted(document["class_names"]) == ["lamp", "slab"]
    assert Path(document["file"]).stat().st_size > 1_000_000
    assert document["metrics"]
    assert document["seconds"] > 0


def test_meshes_are_told_apart(folder: Path) -> None:
    arguments = ("classify", folder / "query-lamp.off", folder / "query-slab.obj", "-c", folder / "out/classifier.onnx")
    results = shapewright(*arguments, "--views", 6, "--json").document["results"]
    assert [result["class_name"] for result in results] == ["lamp", "slab"]
    for result in results:
        shares = [row["probability"] for row in result["probabilities"]]
        assert sum(shares) == pytest.approx(1.0, abs=1e-3)
        assert shares == sorted(shares, reverse=True)
        assert np.shape(result["per_view"]) == (6, 2)
        assert np.sum(result["per_view"], axis=1) == pytest.approx(1.0, abs=1e-3)
        assert (result["fits"], result["picture"]) == (None, None)
    table = shapewright(*arguments, "--views", 2).stdout
    assert "lamp" in table
    assert "slab" in table


def test_the_threshold_of_what_is_known_moves(folder: Path) -> None:
    arguments = ("classify", folder / "query-lamp.off", "-c", folder / "out/classifier.onnx", "--views", 2, "--json")
    document = shapewright(*arguments).document
    assert document["threshold"] == KNOWN_THRESHOLD
    (result,) = document["results"]
    for threshold, answer in ((0.0, "lamp"), (result["known"] + 1e-6, "unknown")):
        (moved,) = shapewright(*arguments, "--threshold", threshold).document["results"]
        assert (moved["answer"], moved["known"]) == (answer, result["known"])


def test_a_classification_shows_what_was_looked_at(folder: Path, tmp_path: Path) -> None:
    arguments = ("classify", folder / "query-lamp.off", "-c", folder / "out/classifier.onnx", "--views", 7)
    (result,) = shapewright(*arguments, "--pictures", tmp_path / "seen", "--fit", "--json").document["results"]
    assert result["fits"] == [], "no models of these classes ship"
    assert Path(result["picture"]) == tmp_path / "seen" / "1-query-lamp.png"
    with Image.open(result["picture"]) as picture:
        size = picture.size[0] // 5
        assert picture.size == (5 * size, 2 * size)
        pixels = np.asarray(picture)
    assert (pixels[size:, 2 * size :] == 255).all()
    assert all((pixels[:size, n * size : (n + 1) * size] < 250).any() for n in range(5))


def test_a_folder_is_classified_without_what_cannot_be_used(folder: Path, tmp_path: Path) -> None:
    for name in ("query-slab.obj", "query-lamp.off"):
        (tmp_path / "meshes" / name).parent.mkdir(exist_ok=True)
        (tmp_path / "meshes" / name).write_bytes((folder / name).read_bytes())
    (tmp_path / "meshes" / "broken.ply").write_bytes(b"ply\nnot at all")
    arguments = ("classify", tmp_path / "meshes", "-c", folder / "out/classifier.onnx", "--views", 4)
    document = shapewright(*arguments, "--json").document
    assert [Path(result["file"]).name for result in document["results"]] == ["query-lamp.off", "query-slab.obj"]
    assert [result["class_name"] for result in document["results"]] == ["lamp", "slab"]
    assert document["skipped_count"] == 1
    assert document["skipped"][0]["file"].endswith("broken.ply")
    assert f"broken.ply: {document['skipped'][0]['reason']}" in shapewright(*arguments).stderr


def test_a_query_is_rebuilt_where_it_lies(folder: Path, tmp_path: Path) -> None:
    query = load_mesh(folder / "query-lamp.off")
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    placed = query.transformed(turn, np.array([5.0, -3.0, 1.0]), 12.0)
    placed.save(tmp_path / "placed.ply")
    colors, scene = tmp_path / "results" / "apart.png", tmp_path / "results" / "apart.glb"
    fitted, picture = tmp_path / "results" / "fitted.glb", tmp_path / "results" / "fit.png"
    document = shapewright(
        "estimate", tmp_path / "placed.ply", "--model", folder / "lamp.json", "-o", fitted, "--picture", picture,
        "--residuals", colors, "--residuals", scene, "--json",
    ).document  # fmt: skip
    length = next(p for p in document["parameters"] if p["name"] == "post_length")
    assert length["value"] == pytest.approx(1.4, rel=0.15)
    assert document["distances"]["surface"] < 0.1
    assert document["distances"]["zbuffer"] < 0.1
    assert np.abs(load_mesh(fitted).bounds - placed.bounds).max() < 0.15 * np.ptp(placed.bounds, axis=0).max()
    with Image.open(picture) as image:
        assert image.width == 3 * image.height
    with Image.open(colors) as image:
        assert image.width > 1.5 * image.height
    assert set(trimesh.load(scene).geometry) == {"fit", "query"}
    assert document["residual_files"] == [str(colors), str(scene)]


def test_settings_of_the_reference_are_refused_without_it(folder: Path) -> None:
    arguments = ("estimate", folder / "query-lamp.off", "-m", folder / "lamp.json")
    for option in (("--quick",), ("--samples", 5)):
        assert "--estimator reference" in shapewright(*arguments, *option).refused()


def test_of_several_models_the_best_one_is_found(folder: Path, tmp_path: Path) -> None:
    small = tmp_path / "small.json"
    steps = {"translation_step": 0.05, "rotation_step_rad": 0.15, "scale_step": 0.05}
    settings = {"surface_points": 50, "image_size": 16, "subdivision_steps": 0, "step_sizes": [0.5]}
    small.write_text(json.dumps({**settings, "model_points": "vertices", "alignment": steps}))
    arguments = (
        "estimate", folder / "query-lamp.off", "-m", folder / "slab.json", "-m", folder / "lamp.json",
        "--estimator", "reference", "--samples", 30, "--settings", small,
    )  # fmt: skip
    document = shapewright(*arguments, "--json").document
    assert document["model"]["name"] == "lamp"
    assert [one["model"]["name"] for one in document["tried"]] == ["lamp", "slab"]
    assert document["parameters"][0]["active"]
    printed = shapewright(*arguments).stdout
    assert "lamp rebuilds the mesh" in printed
    assert "length of the post" in printed
    assert "Layer" in printed


def test_a_class_is_all_of_its_models() -> None:
    shipped = list_classes()
    assert [*load_classes(None), *list_further_classes()] == sorted(
        shipped, key=lambda name: (name in list_further_classes(), name)
    )
    assert {one.model.class_name for one in load_negatives(["table", "chair"])} == set(list_further_classes()) - {
        "chair"
    }
    assert [one.model.name for one in load_class("table")] == shipped["table"]
    both = load_classes(["table", "sword_katana"])
    assert [one.model.name for one in both["table"]] == shipped["table"]
    assert [one.model.name for one in both["sword"]] == ["sword_katana"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("train", "-o", "classifier.pt"), ".onnx"),
        (("train", "nothing.json", "-o", "c.onnx"), "neither a file nor a shipped model"),
        (("train", "lamp.json", "-o", "c.onnx", "--settings", "unknown.json"), "colour"),
        (("train", "lamp.json", "-o", "c.onnx", "--variations", "4"), "class"),
        (("classify", "query-lamp.off", "-c", "missing.onnx"), "missing.onnx"),
        (("classify", "query-lamp.off", "-c", "query-lamp.off"), "query-lamp.off"),
        (("classify", "missing.off", "-c", "out/classifier.onnx"), "missing.off"),
        (("classify", "unknown.json", "-c", "out/classifier.onnx"), "unknown.json"),
        (("estimate", "query-lamp.off", "-m", "nothing"), "neither a file nor a shipped model"),
        (("estimate", "query-lamp.off", "--class", "teapot"), "no such class ships"),
        (("estimate", "query-lamp.off"), "name models or a class"),
        (("estimate", "query-lamp.off", "-m", "lamp.json", "--class", "table"), "name models or a class"),
        (("estimate", "missing.off", "-m", "lamp.json"), "missing.off"),
        (("estimate", "query-lamp.off", "-m", "lamp.json", "-o", "fit.step"), "write one of"),
        (("estimate", "query-lamp.off", "-m", "lamp.json", "--picture", "fit.jpg"), ".png"),
        (("estimate", "query-lamp.off", "-m", "lamp.json", "--settings", "unknown.json"), "colour"),
    ],
)
def test_refusals_leave_nothing_behind(
    folder: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], told: str
) -> None:
    (folder / "unknown.json").write_text('{"colour": "red"}')
    monkeypatch.chdir(folder)
    before = sorted(folder.rglob("*"))
    assert told in shapewright(*arguments).refused()
    assert sorted(folder.rglob("*")) == before
