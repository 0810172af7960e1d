"""Tables that more than one verb prints."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.table import Table

    from shapewright.modeling import Condition, ProceduralModel, Symmetry

BAR_CELLS = 14
ALL_COLUMNS_WIDTH = 125
"""Characters of a line from which on all columns of an estimation have room."""


STATUS_TEXTS = {
    "determined": "determined",
    "determined_up_to_scale": "up to scale",
    "not_determined": "not determined",
    "inactive": "inactive",
    "at_range_end": "at the end of its range",
}


def parameter_table(parameters: Iterable[Mapping[str, Any]], *, width: int = ALL_COLUMNS_WIDTH) -> "Table":
    """Return a table of estimated parameters: label, measure or option, x, range, and where x lies in its range.

    If an estimator judges, there are columns of what it says: where the value lies with a probability of 90 %, and
    whether the mesh determines it. A narrow table leaves the range out then, and x where there is a measure.

    Args:
        width: characters of a line.
        parameters: mappings with ``label``, ``unit``, ``value`` (x), ``base_value``, ``minimum``, ``maximum``,
            ``option`` and ``active``, perhaps with ``status`` and ``interval``.
    """
    from rich.markup import escape
    from rich.table import Table

    listed = list(parameters)
    judged = any(parameter.get("status") for parameter in listed)
    verdicts = ("90 % interval", "known") if judged else ()
    narrow = judged and width < ALL_COLUMNS_WIDTH
    table = Table("parameter", "measure", *verdicts, *(() if narrow else ("x", "range of x", "in the range")))
    for column in table.columns[1:]:
        column.no_wrap = True
    kept = len(table.columns)
    for parameter in listed:
        label = escape(parameter["label"])
        if not parameter["active"]:
            table.add_row(label, "inactive", style="dim")
            continue
        known = (_interval_text(parameter), STATUS_TEXTS.get(parameter.get("status") or "", "")) if judged else ()
        value, low, high = parameter["value"], parameter["minimum"], parameter["maximum"]
        if parameter["option"] is not None:
            cells = (label, escape(parameter["option"]), *known, f"{value:g}", f"{low:g} … {high:g}", "")
            table.add_row(*cells[:kept])
            continue
        base = parameter["base_value"]
        measure = "" if base is None else escape(f"{value * base:.4g} {parameter['unit'] or ''}".strip())
        if narrow and base is None:
            measure = f"{value:.3f}"
        bar = position_bar(value, low, high)
        style = "dim" if parameter.get("status") == "not_determined" else None
        cells = (label, measure, *known, f"{value:.3f}", f"{low:.3g} … {high:.3g}", bar)
        table.add_row(*cells[:kept], style=style)
    return table


def _interval_text(parameter: Mapping[str, Any]) -> str:
    """Say where the displayed value lies, e.g. ``71.2 … 74.0 mm``."""
    interval = parameter.get("interval")
    if interval is None:
        return ""
    base = parameter["base_value"]
    low, high = sorted(x * (1.0 if base is None else base) for x in interval)
    unit = "" if base is None else f" {parameter['unit'] or ''}"
    return f"{low:.3g} … {high:.3g}{unit}".rstrip()


def model_table(model: "ProceduralModel") -> "Table":
    """Return a table of a model's parameters: name, label, range of x or options, base value, what they depend on."""
    from rich.markup import escape
    from rich.table import Table

    table = Table("parameter", "label", "range of x", "base value", "depends on")
    for parameter in model.parameters:
        base = "" if parameter.base_value is None else f"{parameter.base_value:g} {parameter.unit or ''}".strip()
        options = ", ".join(f"{x:g} {option}" for x, option in parameter.named_options())
        limits = [f"{limit.bound} {limit.offset:g} + {limit.factor:g} {limit.parameter}" for limit in parameter.limits]
        conditions = [f"only if {conditions_text(parameter.active_when, model)}"] if parameter.active_when else []
        bounds = options or f"{parameter.minimum:g} … {parameter.maximum:g}"
        cells = (parameter.name, parameter.label, bounds, base, "; ".join(conditions + limits))
        table.add_row(*map(escape, cells))
    return table


def conditions_text(conditions: "Iterable[Condition]", model: "ProceduralModel") -> str:
    """Say what must hold, e.g. ``armrests is with and back is low or high``."""
    by_name = {parameter.name: parameter for parameter in model.parameters}
    said = []
    for condition in conditions:
        options = by_name[condition.parameter].named_options()
        names = [option for x, option in options if condition.minimum <= x <= condition.maximum]
        bounds = f"{condition.minimum:g} … {condition.maximum:g}"
        said.append(f"{condition.parameter} is {' or '.join(names) if options else bounds}")
    return " and ".join(said)


def symmetry_text(symmetry: "Symmetry") -> str:
    """Say what leaves each instance as it is, e.g. ``mirror y, turn 90 deg about z``."""
    return ", ".join(symmetry.maps()) or "none"


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
