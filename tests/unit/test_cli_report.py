"""The tables that people read."""

import io

from rich.console import Console

from cli.report import parameter_table, position_bar, probability_table


def _text(table: object) -> str:
    console = Console(file=io.StringIO(), width=120)
    console.print(table)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def test_a_measure_is_x_times_the_base_value() -> None:
    text = _text(
        parameter_table(
            [
                {"label": "stem length", "unit": "mm", "value": 1.25, "base_value": 80.0, "minimum": 0.5, "maximum": 2},
                {"label": "bulge", "unit": None, "value": 0.5, "base_value": None, "minimum": 0.5, "maximum": 1.5},
            ]
        )
    )
    assert "100 mm" in text
    assert "1.250" in text
    assert "0.5 … 2" in text


def test_the_bar_shows_where_a_value_lies() -> None:
    low, middle, high = (position_bar(value, 0.0, 1.0) for value in (0.0, 0.5, 1.0))
    assert low.startswith("├●")
    assert high.endswith("●┤")
    assert len({len(low), len(middle), len(high)}) == 1
    assert position_bar(1.0, 1.0, 1.0).count("●") == 1


def test_probabilities_come_highest_first() -> None:
    rows = [{"class_name": "sword", "probability": 0.1}, {"class_name": "table", "probability": 0.9}]
    text = _text(probability_table(rows))
    assert text.index("table") < text.index("sword")
