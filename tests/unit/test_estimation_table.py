"""Estimations of many meshes as a table: what the cells hold, what rows are sorted by, and both file types of text."""

import csv
import io
import json
from typing import Any

import pytest

from shapewright.errors import EstimationError
from shapewright.estimation.table.rows import FIXED, TableRow, cells_of
from shapewright.estimation.table.sorting import SortKey, sort_by
from shapewright.estimation.table.table import Layout, Table


def parameter(name: str, value: float, **given: Any) -> dict[str, Any]:
    plain = {"name": name, "unit": "cm", "value": value, "base_value": 10.0, "active": True, "option": None}
    return {**plain, "status": None, "interval": None, **given}


def row(file: str, *parameters: dict[str, Any], ratios: list[dict[str, Any]] | None = None) -> TableRow:
    answer = {
        "model": {"id": "0", "name": "cup"},
        "layer": 3,
        "complete": True,
        "distances": {"panorama": 1.0, "surface": float("inf"), "zbuffer": 0.2, "zbuffer_raw": 9.0},
        "parameters": list(parameters),
        "ratios": ratios or [],
    }
    return TableRow(file, answer, seconds=2.0)


def ratio(numerator: str, denominator: str, interval: list[float]) -> dict[str, Any]:
    return {"numerator": numerator, "denominator": denominator, "interval": interval}


def test_a_cell_is_what_people_read() -> None:
    cells = cells_of(
        row(
            "a.off",
            parameter("stem", 1.5, status="determined", interval=[1.4, 1.6]),
            parameter("slope", 0.5, base_value=None, unit=None),
            parameter("depth", 2.0, base_value=-1.0, interval=[1.0, 3.0]),
            parameter("knop", 1.0, option="with a knop", base_value=None),
            parameter("width", 1.0, active=False),
            parameter("layer", 1.0),
        )
    )
    assert (cells["file"], cells["model"], cells["layer"], cells["surface"]) == ("a.off", "cup", 3, None)
    assert [cells[f"stem{end}"] for end in ("", ".low", ".high", ".status", ".unit")] == [
        15.0, 14.0, 16.0, "determined", "cm",
    ]  # fmt: skip
    assert (cells["slope"], cells["slope.unit"]) == (0.5, None)
    assert (cells["depth.low"], cells["depth.high"]) == (-3.0, -1.0)
    assert cells["knop"] == "with a knop"
    assert "knop.low" not in cells
    assert (cells["width"], cells["width.status"]) == (None, "inactive")
    assert cells["parameter.layer"] == 10.0


def test_columns_hold_for_all_rows_and_broken_meshes_have_theirs() -> None:
    with_ratio = row("a", parameter("stem", 2.0), parameter("bowl", 1.0), ratios=[ratio("stem", "bowl", [1.9, 2.1])])
    table = Table.of(
        [with_ratio, row("b", parameter("stem", 1.0), parameter("foot", 1.0)), TableRow("c", error="dust")]
    )
    assert list(table.types)[: len(FIXED)] == list(FIXED)
    assert [one["stem/bowl"] for one in table.rows] == [2.0, None, None]
    assert [one["stem/bowl.low"] for one in table.rows] == [1.9, None, None]
    assert [one["foot"] for one in table.rows] == [None, 10.0, None]
    assert table.rows[2]["error"] == "dust"
    assert table.types["stem"] == "number"
    assert table.types["stem.unit"] == "text"
    read = list(csv.DictReader(io.StringIO(table.to_csv())))
    assert [(one["file"], one["complete"], one["stem"]) for one in read] == [
        ("a", "true", "20.0"), ("b", "true", "10.0"), ("c", "", ""),
    ]  # fmt: skip
    lines = [json.loads(line) for line in table.to_jsonl().splitlines()]
    assert lines[2] == {"file": "c", "error": "dust"}
    assert lines[0]["stem/bowl"] == 2.0


def test_a_ratio_that_is_asked_for_has_a_column_though_no_row_offers_it() -> None:
    rows = [row("a", parameter("stem", 2.0), parameter("bowl", 0.0)), row("b", parameter("stem", 2.0))]
    table = Table.of(rows, [("stem", "bowl")])
    assert [one["stem/bowl"] for one in table.rows] == [None, None]


def test_a_column_of_numbers_and_words_is_text_and_a_late_row_adds_no_column() -> None:
    layout = Layout()
    layout.include(row("a", parameter("knop", 1.0)))
    layout.include(row("b", parameter("knop", 1.0, option="none")))
    assert layout.types["knop"] == "text"
    assert "stem" not in layout.cells(row("c", parameter("stem", 1.0)))


def test_rows_are_sorted_by_value_and_those_without_come_last() -> None:
    cells = [{"stem": 3.0, "bowl": 1.0}, {"stem": None, "bowl": 1.0}, {"stem": 1.0, "bowl": 2.0}, {"stem": 2.0}]
    places = list(range(4))
    assert sort_by(SortKey.parse("stem"), places, cells) == [2, 3, 0, 1]
    assert sort_by(SortKey.parse("stem"), places, cells, descending=True) == [0, 3, 2, 1]
    assert sort_by(SortKey.parse("stem / bowl"), places, cells) == [2, 0, 1, 3]
    assert sort_by(SortKey.parse("stem"), [], []) == []


def test_what_is_no_column_of_numbers_is_refused() -> None:
    for text in ("", "Stem", "a/b/c", "a;drop", "stem.unit", "a/", "\0"):
        with pytest.raises(EstimationError, match="expected a parameter or a ratio"):
            SortKey.parse(text)
    key = SortKey.parse("stem.high/zbuffer")
    key.check(["stem"])
    with pytest.raises(EstimationError, match=r"these are: layer, .*stem") as error:
        SortKey.parse("stem/bowl").check(["stem"])
    assert error.value.where == "bowl"
    SortKey.parse("parameter.layer").check(["layer"])
