"""Tables that more than one verb prints."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.table import Table

BAR_CELLS = 14


def parameter_table(parameters: Iterable[Mapping[str, Any]]) -> "Table":
    """Return a table of estimated parameters: label, measure, x, range, and where x lies in its range.

    Args:
        parameters: mappings with ``label``, ``unit``, ``value`` (x), ``base_value``, ``minimum``, ``maximum``.
    """
    from rich.table import Table

    table = Table("parameter", "measure", "x", "range of x", "in the range")
    for column in table.columns[1:]:
        column.no_wrap = True
    for parameter in parameters:
        value, low, high = parameter["value"], parameter["minimum"], parameter["maximum"]
        base = parameter["base_value"]
        measure = "" if base is None else f"{value * base:.4g} {parameter['unit'] or ''}".strip()
        table.add_row(
            parameter["label"], measure, f"{value:.3f}", f"{low:g} … {high:g}", position_bar(value, low, high)
        )
    return table


def probability_table(probabilities: Iterable[Mapping[str, Any]]) -> "Table":
    """Return a table of class probabilities, highest first."""
    from rich.table import Table

    table = Table("class", "probability", "")
    for row in sorted(probabilities, key=lambda row: -row["probability"]):
        share = row["probability"]
        table.add_row(row["class_name"], f"{share:.1%}", "█" * round(share * BAR_CELLS))
    return table


def position_bar(value: float, low: float, high: float) -> str:
    """Draw where a value lies between two ends, e.g. ``├────●───┤``."""
    share = 0.5 if high <= low else min(max((value - low) / (high - low), 0.0), 1.0)
    place = round(share * (BAR_CELLS - 1))
    return "├" + "─" * place + "●" + "─" * (BAR_CELLS - 1 - place) + "┤"
