"""`shapewright estimate DIR`: a table with a row for each mesh, taken up where it was left."""

import csv
import json
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import shapewright, write_lamp_model
from PIL import Image

from cli.finished_rows import FinishedRows
from shapewright.modeling import ProceduralModel, compile_model

COARSE = {
    "samples": 20,
    "surface_points": 50,
    "image_size": 16,
    "subdivision_steps": 0,
    "step_sizes": [0.5],
    "alignment": {"translation_step": 0.1, "rotation_step_rad": 0.2, "scale_step": 0.1},
    "estimator": "reference",
}
LENGTHS = {"a.off": 1.6, "sub/b.obj": 0.6, "c.ply": 1.1}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three lamps and a broken file, a model and coarse settings beside them."""
    lamp = compile_model(ProceduralModel.load(write_lamp_model(tmp_path)))
    for name, length in LENGTHS.items():
        (tmp_path / "meshes" / name).parent.mkdir(parents=True, exist_ok=True)
        lamp.instance(np.array([length, 1.0])).save(tmp_path / "meshes" / name)
    (tmp_path / "meshes" / "broken.stl").write_bytes(b"solid nothing")
    (tmp_path / "coarse.json").write_text(json.dumps(COARSE))
    return tmp_path


def estimate(folder: Path, *arguments: object) -> Any:
    given = [str(argument) for argument in arguments]
    options = ("-m", folder / "lamp.json", "--settings", folder / "coarse.json", "--jobs", "1", *given)
    return shapewright("estimate", folder / "meshes", *options)


def read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_folder_is_a_table_that_is_taken_up_again(folder: Path) -> None:
    table = folder / "out" / "lamps.csv"
    document = estimate(folder, "-o", table, "--json").document
    assert (document["meshes"], document["estimated"], document["reused"]) == (4, 3, 0)
    assert [one["file"] for one in document["errors"]] == ["broken.stl"]
    assert sum(document["layers"].values()) == 3
    rows = read(table)
    assert [row["file"] for row in rows] == ["a.off", "broken.stl", "c.ply", "sub/b.obj"]
    assert rows[1]["error"]
    assert rows[0]["model"] == "lamp"
    assert float(rows[0]["post_length"]) > float(rows[3]["post_length"])
    assert rows[0]["post_length.unit"] == "mm"

    (folder / "meshes" / "a.off").rename(folder / "meshes" / "z.off")
    (folder / "meshes" / "new.ply").write_bytes((folder / "meshes" / "c.ply").read_bytes() + b"\n")
    again = estimate(folder, "-o", table, "--json").document
    assert (again["meshes"], again["reused"]) == (5, 4)
    assert {row["file"]: row["post_length"] for row in read(table)}["z.off"] == rows[0]["post_length"]
    assert estimate(folder, "-o", table, "--seed", 3, "--json").document["reused"] == 0


def test_rows_are_sorted_and_drawn(folder: Path) -> None:
    table, strip = folder / "lamps.jsonl", folder / "strip.png"
    ratio = "post_length/post_width"
    said = estimate(folder, "-o", table, "--sort", ratio, "--descending", "--strip", strip)
    assert "3 of 4 meshes estimated" in said.stdout
    assert "broken.stl: " in said.stderr
    rows = [json.loads(line) for line in table.read_text().splitlines()]
    values = [row[ratio] for row in rows[:3]]
    assert values == sorted(values, reverse=True)
    assert rows[3]["file"] == "broken.stl"
    with Image.open(strip) as picture:
        assert picture.width > 3 * 128
        assert 2 * 128 < picture.height < 3 * 128
        pixels = np.asarray(picture).reshape(-1, 3).astype(int)
    assert (pixels[:, 2] > pixels[:, 0] + 80).any(), "queries are blue"
    assert (pixels[:, 0] > pixels[:, 2] + 80).any(), "fits are orange"


def test_parquet_holds_the_types(folder: Path) -> None:
    from pyarrow import parquet

    table = folder / "lamps.parquet"
    estimate(folder, "-o", table)
    read_back = parquet.read_table(table)
    types = {name: str(read_back.schema.field(name).type) for name in read_back.column_names}
    assert (types["file"], types["layer"], types["complete"], types["post_length"], types["error"]) == (
        "string", "int64", "bool", "double", "string",
    )  # fmt: skip
    assert read_back.column("post_length").null_count == 1


def test_an_interruption_keeps_what_is_done(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table, add = folder / "lamps.csv", FinishedRows.add

    def add_and_press(self: FinishedRows, key: str | None, outcome: Any) -> None:
        add(self, key, outcome)
        os.kill(os.getpid(), signal.SIGINT)

    with monkeypatch.context() as patch:
        patch.setattr(FinishedRows, "add", add_and_press)
        stopped = estimate(folder, "-o", table)
    assert stopped.status == 130
    assert "1 of 4 meshes are in" in stopped.stderr
    assert [row["file"] for row in read(table)] == ["a.off"]
    kept = folder / "lamps.csv.rows.jsonl"
    kept.write_bytes(kept.read_bytes() + b'{"key": "cut sho')
    assert estimate(folder, "-o", table, "--json").document["reused"] == 1
    assert estimate(folder, "-o", table, "--json").document["reused"] == 4


def test_what_makes_no_sense_is_refused_before_any_work(folder: Path) -> None:
    table = folder / "lamps.csv"
    assert "a folder needs a table" in estimate(folder).refused()
    assert ".parquet, .csv, .jsonl" in estimate(folder, "-o", folder / "lamps.glb").refused()
    assert "post_length" in estimate(folder, "-o", table, "--sort", "height").refused()
    assert "expected a parameter" in estimate(folder, "-o", table, "--sort", "a/b/c").refused()
    mesh = folder / "meshes" / "a.off"
    assert "folder" in shapewright("estimate", mesh, "-m", folder / "lamp.json", "--sort", "height").refused()
    (folder / "empty").mkdir()
    assert (
        "no mesh below" in shapewright("estimate", folder / "empty", "-m", folder / "lamp.json", "-o", table).refused()
    )
    assert not table.exists()
