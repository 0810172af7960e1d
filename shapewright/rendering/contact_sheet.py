"""A sheet of small pictures of one model: the base, each parameter at its ends, random variations."""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.errors import RenderingError
from shapewright.modeling import CompiledModel
from shapewright.modeling.contexts import active_row, distinct_values
from shapewright.modeling.parameter import Parameter
from shapewright.rendering.pictures import draw_together
from shapewright.rendering.styles import STYLES, ImageStyle
from shapewright.rendering.views import three_quarter_view

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw
    from PIL.ImageFont import FreeTypeFont, ImageFont

MAX_SIDE: Final = 16_384
"""Pixels that a sheet may have a side."""

_LINE: Final = 15
_LABEL: Final = 2 * _LINE + 6
_HEADING: Final = 26
_MARGIN: Final = 6
_INK, _FAINT, _PAPER = (20, 24, 30), (110, 116, 125), (255, 255, 255)


@dataclass(frozen=True)
class Cell:
    """A picture and the two lines below it."""

    pixels: UInt8[np.ndarray, "H W 3"]
    title: str
    caption: str


def compose_contact_sheet(
    compiled: CompiledModel,
    *,
    base: Float[np.ndarray, " P"] | None = None,
    variations: int = 24,
    rng: np.random.Generator | None = None,
    rotation: Float[np.ndarray, "3 3"] | None = None,
    size: int = 192,
    columns: int = 8,
    style: ImageStyle = "shaded",
) -> UInt8[np.ndarray, "H W 3"]:
    """Draw what a person must look at before a model is done.

    The pictures of one parameter share their framing, so that sizes can be compared; every other picture is
    filled by its object. A parameter that the base leaves without effect is shown where it is active.

    Args:
        base: values that everything but the variations starts from; the base model's if not given.
        variations: random ones.
        rng: source of their values; seeded with 0 if not given.
        rotation: turns every mesh; by default :func:`three_quarter_view`, z upwards.
        size: pixels a side of each picture.
        columns: pictures in a row.
        style: as in :func:`shapewright.rendering.render_mesh`.

    Raises:
        ParameterError: not P values, or NaN.
        RenderingError: no headless OpenGL, or a sheet of more than MAX_SIDE pixels a side.
    """
    turned = three_quarter_view("z") if rotation is None else rotation
    start = compiled.settle((compiled.base_values() if base is None else base)[None])[0]
    counts = [1 + sum(len(p.options) or 2 for p in compiled.model.parameters), variations]
    _check_size(counts, size, columns)
    drawing = _Drawing(compiled, turned, size, style)
    sections = [
        (f"{compiled.model.name}: base and parameters", list(drawing.parameters(start))),
        ("random variations", list(drawing.variations(np.random.default_rng(0) if rng is None else rng, variations))),
    ]
    return _composed([section for section in sections if section[1]], size, columns)


@dataclass(frozen=True)
class _Drawing:
    compiled: CompiledModel
    rotation: Float[np.ndarray, "3 3"]
    size: int
    style: ImageStyle

    def parameters(self, start: Float[np.ndarray, " P"]) -> Iterator[Cell]:
        yield Cell(self._drawn(start[None])[0], "base", f"{len(self.compiled.model.parameters)} parameters")
        space = self.compiled.space
        for column, parameter in enumerate(space.parameters):
            row = active_row(space, column, start)
            if row is None:
                continue
            rows = distinct_values(space, column, row)
            changed = [f"{space.parameters[i].name} {row[i]:g}" for i in np.flatnonzero(row != start) if i != column]
            for pixels, values in zip(self._drawn(rows, beside=row), rows, strict=True):
                caption = ", ".join([_measure(parameter, float(values[column])), *changed])
                yield Cell(pixels, parameter.label, caption)

    def variations(self, rng: np.random.Generator, count: int) -> Iterator[Cell]:
        for number, row in enumerate(self.compiled.random_values(rng, count)):
            yield Cell(self._drawn(row[None])[0], f"variation {number}", "")

    def _drawn(
        self, rows: Float[np.ndarray, "B P"], beside: Float[np.ndarray, " P"] | None = None
    ) -> UInt8[np.ndarray, "B H W 3"]:
        meshes = [self.compiled.instance(row) for row in (rows if beside is None else [*rows, beside])]
        return draw_together(meshes, [1] * len(rows), self.rotation, self.size, STYLES[self.style])


def _measure(parameter: Parameter, x: float) -> str:
    options = dict(parameter.named_options())
    if options:
        return options[x]
    shown = f"x = {x:.3g}"
    if parameter.base_value is None:
        return shown
    return f"{shown}: {x * parameter.base_value:.3g} {parameter.unit or ''}".strip()


def _check_size(counts: Sequence[int], size: int, columns: int) -> None:
    rows = sum(-(-count // columns) for count in counts)
    sides = (columns * (size + _MARGIN), rows * (size + _MARGIN + _LABEL) + len(counts) * _HEADING)
    if max(sides) > MAX_SIDE:
        raise RenderingError(f"the sheet would have {sides[0]} x {sides[1]} pixels, more than {MAX_SIDE} a side")


def _composed(sections: Sequence[tuple[str, Sequence[Cell]]], size: int, columns: int) -> UInt8[np.ndarray, "H W 3"]:
    from PIL import Image, ImageDraw, ImageFont

    pitch = (size + _MARGIN, size + _MARGIN + _LABEL)
    height = sum(_HEADING + -(-len(cells) // columns) * pitch[1] for _, cells in sections)
    sheet = Image.new("RGB", (columns * pitch[0] + _MARGIN, height + _MARGIN), _PAPER)
    draw = ImageDraw.Draw(sheet)
    font, large = ImageFont.load_default(11), ImageFont.load_default(14)
    top = _MARGIN
    for heading, cells in sections:
        draw.text((_MARGIN, top), heading, fill=_INK, font=large)
        top += _HEADING
        for number, cell in enumerate(cells):
            x, y = _MARGIN + number % columns * pitch[0], top + number // columns * pitch[1]
            sheet.paste(Image.fromarray(cell.pixels), (x, y))
            for line, (text, ink) in enumerate(((cell.title, _INK), (cell.caption, _FAINT))):
                place = (x + 2, y + size + 2 + line * _LINE)
                draw.text(place, _fitted(text, size - 4, draw, font), fill=ink, font=font)
        top += -(-len(cells) // columns) * pitch[1]
    return np.asarray(sheet)


def _fitted(text: str, width: float, draw: "ImageDraw", font: "FreeTypeFont | ImageFont") -> str:
    """Put a text on one line and cut it so that it fits, with an ellipsis."""
    line = " ".join(text.split())
    if draw.textlength(line, font) <= width:
        return line
    kept = bisect_left(range(len(line)), True, key=lambda end: draw.textlength(line[:end] + "…", font) > width)
    return line[: max(kept - 1, 0)] + "…"
