"""Tables as files: Parquet, comma-separated values, or one JSON object a line."""

import io
from pathlib import Path
from typing import TYPE_CHECKING, Final

from shapewright.errors import EstimationError
from shapewright.whole_file import write_whole

if TYPE_CHECKING:
    from shapewright.estimation.table.table import Table

ENDINGS: Final = (".parquet", ".csv", ".jsonl")


def check_ending(path: Path) -> None:
    """Refuse a file that is none of a table.

    Raises:
        EstimationError: another ending.
    """
    if path.suffix.lower() not in ENDINGS:
        raise EstimationError(f"tables are written as {', '.join(ENDINGS)}", where=str(path))


def save_table(table: "Table", path: Path) -> None:
    """Write a table, completely or not at all.

    Raises:
        EstimationError: the ending is none of a table.
        OSError: the file cannot be written.
    """
    check_ending(path)
    ending = path.suffix.lower()
    if ending == ".parquet":
        data = _parquet(table)
    else:
        data = (table.to_csv() if ending == ".csv" else table.to_jsonl()).encode()
    write_whole(path, data)


def _parquet(table: "Table") -> bytes:
    import pyarrow
    from pyarrow import parquet

    types = {
        "text": pyarrow.string(),
        "number": pyarrow.float64(),
        "whole": pyarrow.int64(),
        "yes_no": pyarrow.bool_(),
    }
    columns = {}
    for column, kind in table.types.items():
        cells = [row[column] for row in table.rows]
        if kind == "text":
            cells = [None if cell is None else str(cell) for cell in cells]
        columns[column] = pyarrow.array(cells, type=types[kind])
    data = io.BytesIO()
    parquet.write_table(pyarrow.table(columns), data)
    return data.getvalue()
