"""The tables that people read."""

import io

from rich.console import Console

from cli.report import parameter_table, position_bar, probability_table


def _text(table: object, width: int = 125) -> str:
    console = Console(file=io.StringIO(), width=width)
    console.print(table)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def _row(label: str, value: float, minimum: float, maximum: float, **rest: object) -> dict[str, object]:
    row = {"label": label, "value": value, "minimum": minimum, "maximum": maximum}
    return {"unit": None, "base_value": None, "option": None, "active": True, **row, **rest}


def test_a_measure_is_x_times_the_base_value() -> None:
    text = _text(
        parameter_table(
            [
                _row("stem length", 1.25, 0.5, 2.0, unit="mm", base_value=80.0),
                _row("bulge", 0.5, 0.5, 1.5),
            ]
        )
    )
    assert "100 mm" in text
    assert "1.250" in text
    assert "0.5 … 2" in text


def test_an_option_has_its_name_and_what_means_nothing_is_inactive() -> None:
    text = _text(
        parameter_table([_row("back", 2.0, 1.0, 3.0, option="high"), _row("tilt", 1.0, 0.5, 2.0, active=False)])
    )
    option, inactive = text.splitlines()[-3:-1]
    assert "high" in option
    assert "●" not in option
    assert "inactive" in inactive
    assert "1.000" not in inactive


def test_names_and_verdicts_have_room_on_a_narrow_screen() -> None:
    known = {"status": "determined_up_to_scale", "interval": [1.03, 7.48]}
    rows = [
        _row("Lower bowl width (relative to the belly)", 1.04, 0.8, 2.0, **known),
        _row("Bowl depth", 2.15, 0.3, 2.2, unit="cm", base_value=4.0, **known),
        _row("Foot", 1.0, 0.0, 1.0, option="with"),
    ]
    narrow = _text(parameter_table(rows, width=80), 80)
    for text in ("Lower bowl width", "1.040", "8.6 cm", "4.12 … 29.9 cm", "up to scale", "with"):
        assert text in narrow
    assert "range of x" not in narrow
    assert "range of x" in _text(parameter_table(rows, width=125))


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
