"""The whole table, with columns that hold for all of its rows."""

import csv
import io
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

from shapewright.estimation.table.rows import FIXED, Cell, TableRow, cells_of, column_of, quotient

ColumnType = Literal["text", "number", "whole", "yes_no"]

_TYPES: Final[Mapping[str, ColumnType]] = {
    "file": "text",
    "model": "text",
    "layer": "whole",
    "complete": "yes_no",
    "error": "text",
}


class Layout:
    """The columns of a table, found row by row, so that the rows need not be in memory together.

    A ratio that one row offers has a column, ``NUMERATOR/DENOMINATOR``, in all rows that have both parameters; its
    90 % interval stands in those that offer it.

    Args:
        ratios: pairs of columns that get one in any case.
    """

    def __init__(self, ratios: Iterable[tuple[str, str]] = ()) -> None:
        self._columns: dict[str, ColumnType] = {column: _TYPES.get(column, "number") for column in FIXED}
        self._pairs = dict.fromkeys(ratios)

    def include(self, row: TableRow) -> None:
        """Make room for the cells of a row."""
        for column, cell in cells_of(row).items():
            words = column.endswith((".status", ".unit")) or isinstance(cell, str)
            kind: ColumnType = "text" if words else "number"
            if self._columns.setdefault(column, kind) == "number" and words:
                self._columns[column] = "text"
        self._pairs |= dict.fromkeys(_offered(row))

    @property
    def types(self) -> Mapping[str, ColumnType]:
        """What each column holds, in the order of the columns: fixed ones, parameters, ratios."""
        ratios: dict[str, ColumnType] = {column: "number" for pair in self._pairs for column in _ratio_columns(pair)}
        return self._columns | ratios

    def cells(self, row: TableRow) -> dict[str, Cell]:
        """Return the cells of a row, ``None`` in columns that it has not; what has no column is left out."""
        cells, offered = cells_of(row), _offered(row)
        for pair in self._pairs:
            values = (quotient(cells, *pair), *offered.get(pair, (None, None)))
            cells.update(zip(_ratio_columns(pair), values, strict=True))
        return {column: cells.get(column) for column in self.types}


@dataclass(frozen=True)
class Table:
    """Cells by row and column; ``None`` where a row has none.

    Attributes:
        types: of each column, in the order of the columns.
        rows: the cells of each row; each has all columns.
    """

    types: Mapping[str, ColumnType]
    rows: Sequence[Mapping[str, Cell]]

    @classmethod
    def of(cls, rows: Iterable[TableRow], ratios: Iterable[tuple[str, str]] = ()) -> "Table":
        """Lay rows out beside each other, in their order.

        Args:
            rows: the rows.
            ratios: pairs of columns whose quotient gets a column in any case.
        """
        listed, layout = list(rows), Layout(ratios)
        for row in listed:
            layout.include(row)
        return cls(layout.types, [layout.cells(row) for row in listed])

    def to_csv(self) -> str:
        """Write comma-separated values with a header; an empty field is a cell that a row has not."""
        return "".join([csv_line(self.types), *(csv_line(row.values()) for row in self.rows)])

    def to_jsonl(self) -> str:
        """Write one JSON object a line, each with the cells that its row has."""
        present = ({column: cell for column, cell in row.items() if cell is not None} for row in self.rows)
        return "".join(f"{json.dumps(row, ensure_ascii=False)}\n" for row in present)


def csv_line(cells: Iterable[Cell]) -> str:
    """Write one line of comma-separated values; truth is written as JSON does."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(
        str(cell).lower() if isinstance(cell, bool) else cell for cell in cells
    )
    return text.getvalue()


def _ratio_columns(pair: tuple[str, str]) -> tuple[str, str, str]:
    name = "/".join(pair)
    return name, f"{name}.low", f"{name}.high"


def _offered(row: TableRow) -> dict[tuple[str, str], tuple[float | None, float | None]]:
    ratios = () if row.answer is None else row.answer["ratios"]
    return {
        (column_of(ratio["numerator"]), column_of(ratio["denominator"])): tuple(ratio["interval"] or (None, None))
        for ratio in ratios
    }
