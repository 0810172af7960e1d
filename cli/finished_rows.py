"""Rows of an estimated folder that outlast an interruption: a file of lines that is only appended to."""

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from shapewright.estimation.many import Outcome
    from shapewright.estimation.table.rows import TableRow


class FinishedRows:
    """Rows by what they depend on; a line that was cut short by a crash is left out.

    Args:
        path: of the file; it is made with the first row.
        conditions: what all rows of a run depend on: models, settings, what is known of the files.
    """

    def __init__(self, path: Path, conditions: Mapping[str, Any]) -> None:
        self._path = path
        self._conditions = json.dumps(conditions, sort_keys=True).encode()
        self._rows: dict[str, dict[str, Any]] = {}
        self._is_cut = False
        self._read()

    def key_of(self, file: Path) -> str | None:
        """Return what identifies the row of a file: its content and the conditions; ``None`` if it cannot be read."""
        try:
            with file.open("rb") as opened:
                digest = hashlib.file_digest(opened, "sha256")
        except OSError:
            return None
        digest.update(file.suffix.lower().encode())
        digest.update(self._conditions)
        return digest.hexdigest()

    def get(self, key: str | None, name: str) -> "TableRow | None":
        """Return the row with this key, under the name that the file has now."""
        from shapewright.estimation.table.rows import TableRow

        row = None if key is None else self._rows.get(key)
        return None if row is None else replace(TableRow(**row), file=name)

    def add(self, key: str | None, outcome: "Outcome") -> None:
        """Append a row, unless another try might end differently."""
        if key is None or not outcome.lasting:
            return
        row = asdict(outcome.row)
        line = json.dumps({"key": key, "row": row}, ensure_ascii=False).encode() + b"\n"
        descriptor = os.open(self._path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        try:
            os.write(descriptor, b"\n" + line if self._is_cut else line)
        finally:
            os.close(descriptor)
        self._is_cut = False
        self._rows[key] = row

    def _read(self) -> None:
        try:
            lines = self._path.read_bytes().split(b"\n")
        except FileNotFoundError:
            return
        self._is_cut = bool(lines[-1])
        for line in lines:
            try:
                entry = json.loads(line)
                self._rows[entry["key"]] = {**entry["row"]}
            except (ValueError, KeyError, TypeError):
                continue
