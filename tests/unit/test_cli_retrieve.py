"""`shapewright retrieve` on a few slabs and rods, with a classifier that needs no training."""

from pathlib import Path

import numpy as np
import pytest
from command_line import Outcome, shapewright
from fake_classifier import ExtentClassifier
from PIL import Image
from small_dataset import rod, slab

from shapewright.distances.surface import uniform_points
from shapewright.modeling import compile_model
from shapewright.retrieval import CollectionIndex

ASKED = ExtentClassifier()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Meshes in a folder of their own, models and something like a classifier beside it."""
    folder = tmp_path_factory.mktemp("retrieval")
    below = folder / "meshes" / "below"
    below.mkdir(parents=True)
    for model in (slab(), rod()):
        model.save(folder / f"{model.name}.json")
        compiled = compile_model(model)
        for number, x in enumerate((0.8, 1.3)):
            compiled.instance(np.array([x])).save(below.parent / f"{model.name}{number}.off")
    compile_model(slab()).instance(np.array([1.1])).save(below / "deep.PLY")
    (below / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n")
    (below / "notes.txt").write_text("no mesh")
    (folder / "classifier.onnx").write_bytes(b"stands for a classifier")
    (folder / "empty").mkdir()
    return folder


@pytest.fixture(autouse=True)
def _surroundings(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shapewright.classification.load_classifier", lambda path: ASKED)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.chdir(folder)


def retrieve(*arguments: str | Path) -> Outcome:
    return shapewright("retrieve", "meshes", "-c", "classifier.onnx", "--jobs", "1", *arguments)


def files(outcome: Outcome) -> list[str]:
    assert outcome.status == 0, outcome.stderr
    return [Path(row["file"]).name for row in outcome.document["results"]]


def test_the_most_probable_come_first_and_nothing_is_left_out_in_silence() -> None:
    outcome = retrieve("--class", "slab", "--json")
    assert outcome.document["evidence"] == "probabilities"
    assert set(files(outcome)[:3]) == {"slab0.off", "slab1.off", "deep.PLY"}
    document = outcome.document
    assert document["n"] == 5
    assert [row["rank"] for row in document["results"]] == [1, 2, 3, 4, 5]
    scores = [row["score"] for row in document["results"]]
    assert scores == sorted(scores, reverse=True)
    assert [row["probability"] for row in document["results"]] == scores
    assert all(row["distance"] is None for row in document["results"])
    assert [Path(skipped["file"]).name for skipped in document["skipped"]] == ["broken.off"]
    assert document["skipped_count"] == 1
    assert document["skipped"][0]["reason"]


@pytest.mark.parametrize("evidence", ["panorama", "combined"])
def test_a_model_finds_what_is_like_it(evidence: str) -> None:
    found = files(retrieve("--model", "rod.json", "--evidence", evidence, "--instances", "10", "--json"))
    assert set(found[:2]) == {"rod0.off", "rod1.off"}
    found = files(retrieve("--model", "slab.json", "--evidence", evidence, "--instances", "0", "--json"))
    assert set(found[:3]) == {"slab0.off", "slab1.off", "deep.PLY"}


def test_a_mesh_finds_its_like_without_being_in_the_collection(folder: Path, tmp_path: Path) -> None:
    query = tmp_path / "query.obj"
    compile_model(rod()).instance(np.array([1.3])).save(query)
    outcome = retrieve("--mesh", query, "--json", "--limit", "2")
    assert files(outcome) == ["rod1.off", "rod0.off"]
    assert outcome.document["n"] == 5
    assert outcome.document["results"][0]["distance"] == pytest.approx(0, abs=1e-3)
    assert files(retrieve("--mesh", "meshes/rod0.off", "--json"))[0] == "rod0.off"


def test_point_clouds_are_found_and_find(folder: Path, tmp_path: Path) -> None:
    scan = tmp_path / "scans" / "scan.xyz"
    scan.parent.mkdir()
    rng = np.random.default_rng(0)
    np.savetxt(scan, uniform_points(compile_model(rod()).instance(np.array([1.0])), 400, rng=rng))
    (scan.parent / "notes.txt").write_text("no scan")
    sheet = tmp_path / "sheet.png"
    like_it = retrieve("--mesh", scan, "--limit", "2", "--json", "--contact-sheet", sheet)
    assert set(files(like_it)) == {"rod0.off", "rod1.off"}
    assert sheet.is_file()
    among = retrieve(scan.parent, "--class", "rod", "--json", "--contact-sheet", sheet)
    assert set(files(among)[:3]) == {"rod0.off", "rod1.off", "scan.xyz"}
    assert [Path(skipped["file"]).name for skipped in among.document["skipped"]] == ["broken.off"]


def test_a_second_query_looks_at_new_meshes_only(folder: Path, tmp_path: Path) -> None:
    kept = tmp_path / "new" / "index.npz"
    ASKED.asked = 0
    first = retrieve("--class", "rod", "--evidence", "probabilities", "--index", kept, "--json")
    assert ASKED.asked == 5
    assert first.document["index"] == str(kept)
    assert len(CollectionIndex.load(kept)) == 5
    again = retrieve("--class", "rod", "--evidence", "probabilities", "--index", kept, "--json")
    assert ASKED.asked == 5
    assert again.document["results"] == first.document["results"]
    copy = tmp_path / "copy.off"  # the same content under another name
    copy.write_bytes((folder / "meshes" / "rod0.off").read_bytes())
    found = retrieve(copy, "--class", "rod", "--evidence", "probabilities", "--index", kept, "--json")
    assert ASKED.asked == 5
    assert sorted(files(found)[:3]) == ["copy.off", "rod0.off", "rod1.off"]
    retrieve("--class", "rod", "--evidence", "probabilities", "--json")  # in the user's cache
    assert ASKED.asked == 10
    retrieve("--class", "slab", "--evidence", "probabilities", "--json")
    assert ASKED.asked == 10


def test_an_index_of_another_descriptor_is_refused_where_it_is_named_and_made_anew_in_the_cache(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    query, kept = ("--class", "rod", "--evidence", "probabilities", "--json"), tmp_path / "index.npz"
    retrieve(*query, "--index", kept)
    retrieve(*query)
    monkeypatch.setattr("shapewright.distances.descriptor_files.VERSION", 99)
    assert (
        f"--index {kept}: the file was made by another version of the descriptor"
        in retrieve(*query, "--index", kept).refused()
    )
    ASKED.asked = 0
    assert len(files(retrieve(*query))) == 5
    assert ASKED.asked == 5


def test_a_table_and_a_sheet_for_people(tmp_path: Path) -> None:
    sheet = tmp_path / "pictures" / "sheet.png"
    outcome = retrieve("--model", "rod.json", "--instances", "3", "--limit", "3", "--contact-sheet", sheet)
    assert outcome.status == 0, outcome.stderr
    lines = outcome.stdout.splitlines()
    assert lines[0].split() == ["rank", "file", "score", "probability", "distance"]
    assert [line.split()[0] for line in lines[1:4]] == ["1", "2", "3"]
    assert "the first 3 of 5 meshes" in lines[4]
    assert lines[-1] == str(sheet)
    assert "skipped" in outcome.stderr
    assert "1 mesh was skipped" in outcome.stderr
    with Image.open(sheet) as image:
        one = image.size
    shapewright(
        "retrieve", "meshes", "-c", "classifier.onnx", "--mesh", "meshes/rod0.off", "--limit", "3",
        "--contact-sheet", sheet,
    )  # fmt: skip
    with Image.open(sheet) as image:
        assert image.width == one[0]
        assert image.height > 1.8 * one[1]  # the query stands above


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((), "name one of a class, a model, a mesh"),
        (("--class", "rod", "--mesh", "meshes/rod0.off"), "name one of a class, a model, a mesh"),
        (("--class", "teapot"), "--class: the classifier does not know the class 'teapot' (but: rod, slab)"),
        (("--class", "rod", "--evidence", "combined"), "--evidence probabilities"),  # no model of this class ships
        (("--model", "nothing"), "neither a file nor a shipped model"),
        (("--model", "table"), "does not know the class 'table'"),
        (("--mesh", "missing.off"), "no such file"),
        (("--mesh", "meshes"), "is a directory"),
        (("--mesh", "meshes/below/broken.off"), "--mesh"),
        (("nowhere", "--class", "rod"), "no such file or folder"),
        (("empty", "--class", "rod"), "no mesh below this folder"),
        (("--class", "rod", "--evidence", "magic"), "magic"),
        (("--class", "rod", "--contact-sheet", "sheet.jpg"), ".png"),
        (("--class", "rod", "--contact-sheet", "sheet.png", "--limit", "100000"), "16384"),
        (("--mesh", "meshes/rod0.off", "--index", "rod.json"), "--index rod.json: the file is no index"),
    ],
)
def test_refusals_are_one_line(arguments: tuple[str, ...], told: str) -> None:
    assert told in retrieve(*arguments).refused()


def test_an_index_of_another_classifier_is_refused(tmp_path: Path) -> None:
    CollectionIndex.empty(("rod", "slab"), "0" * 64).save(tmp_path / "other.npz")
    message = retrieve("--mesh", "meshes/rod0.off", "--index", tmp_path / "other.npz").refused()
    assert "another classifier" in message


def test_a_collection_without_a_usable_mesh_is_refused() -> None:
    message = shapewright(
        "retrieve", "meshes/below/broken.off", "-c", "classifier.onnx", "--class", "rod", "--evidence", "probabilities"
    ).refused()
    assert "no mesh to look through" in message
    assert "broken.off" in message


def test_a_classifier_that_cannot_be_read_is_refused(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    monkeypatch.undo()
    for name in ("missing.onnx", "classifier.onnx"):
        message = shapewright("retrieve", folder / "meshes", "-c", folder / name, "--class", "rod").refused()
        assert name in message
