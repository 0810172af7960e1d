"""One row of the table: a mesh with what was estimated, or with the reason why nothing was."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from shapewright.estimation.result import Estimation

Cell = str | float | int | bool | None

FIXED: Final = (
    "file",
    "model",
    "layer",
    "complete",
    "panorama",
    "surface",
    "zbuffer",
    "zbuffer_raw",
    "seconds",
    "error",
)
"""Columns of every table, in their order; those of parameters and ratios come after them."""
_KEPT: Final = ("estimator", "model", "layer", "complete", "values", "parameters", "pose", "distances", "ratios")


@dataclass(frozen=True)
class TableRow:
    """A mesh and its estimation.

    Attributes:
        file: name of the mesh.
        answer: what :func:`answer_of` keeps of the estimation; ``None`` if there is none.
        error: why there is none.
        seconds: that the estimation took.
    """

    file: str
    answer: Mapping[str, Any] | None = None
    error: str | None = None
    seconds: float | None = None


def answer_of(estimation: Estimation) -> dict[str, Any]:
    """Keep what a table shows and what the fitted mesh can be generated from again; plain values, ready for JSON."""
    document = estimation.to_dict()
    return {name: document[name] for name in _KEPT}


def column_of(parameter: str) -> str:
    """Return the column of a parameter: its name, unless a fixed column has it."""
    return f"parameter.{parameter}" if parameter in FIXED else parameter


def cells_of(row: TableRow) -> dict[str, Cell]:
    """Return the cells of a row by their columns, without those of ratios.

    The value of a parameter is what people read: x times the base value, or the name of an option. It is missing where
    the parameter is inactive. Beside it are ``NAME.low`` and ``NAME.high``, the ends of its 90 % interval,
    ``NAME.status`` and ``NAME.unit``.
    """
    cells: dict[str, Cell] = dict.fromkeys(FIXED)
    cells |= {"file": row.file, "seconds": _finite(row.seconds), "error": row.error}
    if row.answer is None:
        return cells
    answer = row.answer
    cells |= {"model": answer["model"]["name"], "layer": answer["layer"], "complete": answer["complete"]}
    cells |= {name: _finite(distance) for name, distance in answer["distances"].items()}
    for parameter in answer["parameters"]:
        cells |= _parameter_cells(parameter)
    return cells


def quotient(cells: Mapping[str, Cell], numerator: str, denominator: str) -> float | None:
    """Return a quotient of two columns; ``None`` where one of them is empty, no number, or the divisor is zero."""
    above, below = number(cells.get(numerator)), number(cells.get(denominator))
    return None if above is None or not below else _finite(above / below)


def number(cell: Cell) -> float | None:
    """Return a cell as a number, ``None`` if it is none."""
    return None if cell is None or isinstance(cell, bool | str) else float(cell)


def _parameter_cells(parameter: Mapping[str, Any]) -> dict[str, Cell]:
    column, active = column_of(parameter["name"]), parameter["active"]
    status = parameter["status"] if active else "inactive"
    if parameter["option"] is not None:
        return {column: parameter["option"] if active else None, f"{column}.status": status}
    factor = 1.0 if parameter["base_value"] is None else parameter["base_value"]
    low, high = sorted(x * factor for x in parameter["interval"]) if parameter["interval"] else (None, None)
    return {
        column: _finite(parameter["value"] * factor) if active else None,
        f"{column}.low": _finite(low),
        f"{column}.high": _finite(high),
        f"{column}.status": status,
        f"{column}.unit": None if parameter["base_value"] is None else parameter["unit"],
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
