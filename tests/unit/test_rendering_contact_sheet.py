"""Contact sheets show the base, every parameter where it acts, random variations; and sheets of any meshes."""

from dataclasses import replace

import numpy as np
import pytest
from chair_model import armchair
from simple_shapes import box, goblet, stool
from small_dataset import rod

from shapewright.errors import RenderingError
from shapewright.modeling import CompiledModel, compile_model
from shapewright.rendering import (
    LabelledMesh,
    compose_contact_sheet,
    compose_mesh_sheet,
    render_mesh,
    three_quarter_view,
)

SIZE, MARGIN, LABEL, HEADING = 64, 6, 36, 26


def pictures(sheet: np.ndarray, count: int, columns: int, top: int = MARGIN + HEADING) -> list[np.ndarray]:
    found = []
    for number in range(count):
        y = top + number // columns * (SIZE + MARGIN + LABEL)
        x = MARGIN + number % columns * (SIZE + MARGIN)
        found.append(sheet[y : y + SIZE, x : x + SIZE].astype(int))
    return found


def differ(first: np.ndarray, second: np.ndarray) -> bool:
    return bool(np.abs(first - second).mean() > 0.5)


def sheet_of(compiled: CompiledModel, **options: object) -> np.ndarray:
    return compose_contact_sheet(compiled, size=SIZE, columns=4, **options)  # type: ignore[arg-type]


def test_base_both_ends_and_variations_are_there() -> None:
    compiled = compile_model(rod())
    sheet = sheet_of(compiled, variations=3)
    base, short, long = pictures(sheet, 3, 4)
    assert differ(short, long)
    assert not differ(base, render_mesh(compiled.instance(np.ones(1)), rotation=three_quarter_view("z"), size=SIZE))
    ink = [(picture != picture[0, 0]).any(axis=2).sum(axis=0) for picture in (short, long)]
    assert (ink[0] > 0).sum() < (ink[1] > 0).sum() * 1.01, "both ends under one framing"
    first, second, _ = pictures(sheet, 3, 4, MARGIN + 2 * HEADING + SIZE + MARGIN + LABEL)
    assert differ(first, second)


def test_every_option_is_shown_and_a_parameter_where_it_is_active() -> None:
    compiled = compile_model(armchair())
    cells = pictures(sheet_of(compiled, variations=0), 1 + 3 + 2 + 3 * 2, 4)
    backs, arms, arm_heights = cells[1:4], cells[4:6], cells[8:10]
    assert differ(backs[0], backs[1])
    assert differ(backs[1], backs[2])
    assert differ(*arms)
    assert differ(*arm_heights)
    without = compiled.values_from_mapping({"armrests": 0})
    again = pictures(sheet_of(compiled, variations=0, base=without), 12, 4)
    assert differ(again[0], cells[0])
    assert differ(*again[8:10])


def test_the_same_generator_gives_the_same_sheet() -> None:
    compiled = compile_model(rod())
    sheets = [sheet_of(compiled, variations=2, rng=np.random.default_rng(seed)) for seed in (1, 1, 2)]
    np.testing.assert_array_equal(sheets[0], sheets[1])
    assert (sheets[0] != sheets[2]).any()


def test_a_sheet_that_is_too_large_is_refused_before_it_is_drawn() -> None:
    with pytest.raises(RenderingError, match="16384"):
        compose_contact_sheet(compile_model(rod()), variations=1000, size=500)


def test_texts_of_strangers_fit_on_their_line() -> None:
    model = rod()
    plain = sheet_of(compile_model(model), variations=0)
    for label in ("Le\nng\r\nth", "Length " * 28, "\t\u200b", "W" * 200):
        (length,) = model.parameters
        sheet = sheet_of(compile_model(replace(model, parameters=(replace(length, label=label),))), variations=0)
        assert sheet.shape == plain.shape


def test_meshes_are_drawn_in_sections_one_at_a_time() -> None:
    taken: list[str] = []

    def found():
        for name, mesh in (("stool", stool()), ("box", box())):
            taken.append(name)
            yield LabelledMesh(mesh, name, "0.5")

    sheet = compose_mesh_sheet([("query", [LabelledMesh(goblet(), "goblet")]), ("found", found())], size=SIZE)
    assert taken == ["stool", "box"]
    assert sheet.shape == (2 * (HEADING + SIZE + MARGIN + LABEL) + MARGIN, 2 * (SIZE + MARGIN) + MARGIN, 3)
    (query,) = pictures(sheet, 1, 2)
    assert not differ(query, render_mesh(goblet(), size=SIZE))
    first, second = pictures(sheet, 2, 2, MARGIN + 2 * HEADING + SIZE + MARGIN + LABEL)
    assert not differ(first, render_mesh(stool(), size=SIZE))
    assert not differ(second, render_mesh(box(), size=SIZE))


def test_a_heading_stays_on_its_line() -> None:
    plain, long = (compose_mesh_sheet([(text, [LabelledMesh(box(), "box")])], size=SIZE) for text in ("a", "a\nb" * 99))
    assert plain.shape == long.shape
    np.testing.assert_array_equal(plain[MARGIN + HEADING :], long[MARGIN + HEADING :])
