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
        """Lay rows out beside each other.

        A ratio that one row offers has a column, ``NUMERATOR/DENOMINATOR``, in all rows that have both parameters; its
        90 % interval stands in those that offer it.

        Args:
            rows: the rows, in the order that they shall have.
            ratios: pairs of columns that get one in any case.
        """
        listed = list(rows)
        cells = [cells_of(row) for row in listed]
        columns = dict.fromkeys(FIXED) | {column: None for one in cells for column in one}
        offered = [_offered(row) for row in listed]
        pairs = dict.fromkeys(ratios) | {pair: None for one in offered for pair in one}
        for row, intervals in zip(cells, offered, strict=True):
            for pair in pairs:
                name = "/".join(pair)
                row[name] = quotient(row, *pair)
                row[f"{name}.low"], row[f"{name}.high"] = intervals.get(pair, (None, None))
        columns |= {f"{'/'.join(pair)}{end}": None for pair in pairs for end in ("", ".low", ".high")}
        types = {column: _type(column, [row.get(column) for row in cells]) for column in columns}
        return cls(types, [{column: row.get(column) for column in columns} for row in cells])

    def to_csv(self) -> str:
        """Write comma-separated values with a header; an empty field is a cell that a row has not."""
        text = io.StringIO()
        writer = csv.DictWriter(text, self.types, lineterminator="\n")
        writer.writeheader()
        writer.writerows({column: _csv(cell) for column, cell in row.items()} for row in self.rows)
        return text.getvalue()

    def to_jsonl(self) -> str:
        """Write one JSON object a line, each with the cells that its row has."""
        present = ({column: cell for column, cell in row.items() if cell is not None} for row in self.rows)
        return "".join(f"{json.dumps(row, ensure_ascii=False)}\n" for row in present)


def _offered(row: TableRow) -> dict[tuple[str, str], tuple[float | None, float | None]]:
    ratios = () if row.answer is None else row.answer["ratios"]
    return {
        (column_of(ratio["numerator"]), column_of(ratio["denominator"])): tuple(ratio["interval"] or (None, None))
        for ratio in ratios
    }


def _type(column: str, cells: Iterable[Cell]) -> ColumnType:
    """Tell what a column holds; one that is empty, or holds numbers and words, depends on its name."""
    if column in _TYPES:
        return _TYPES[column]
    words = column.endswith((".status", ".unit")) or any(isinstance(cell, str) for cell in cells)
    return "text" if words else "number"


def _csv(cell: Cell) -> Cell:
    """Write truth as JSON does."""
    return str(cell).lower() if isinstance(cell, bool) else cell
