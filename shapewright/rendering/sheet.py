"""Sheets of small pictures: sections with a heading, cells with a picture and two lines of text."""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from jaxtyping import UInt8

from shapewright.errors import RenderingError

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
    """A picture, as wide as all others of its sheet, and the two lines below it."""

    pixels: UInt8[np.ndarray, "H W 3"]
    title: str
    caption: str


def check_sheet_size(counts: Sequence[int], size: int, columns: int, height: int | None = None) -> None:
    """Refuse a sheet that would be too large, before anything is drawn for it.

    Args:
        counts: cells of each section.
        size: width of each picture in pixels.
        columns: pictures in a row.
        height: of each picture; as its width if not given.

    Raises:
        RenderingError: more than MAX_SIDE pixels a side.
    """
    rows = sum(-(-count // columns) for count in counts)
    sides = (columns * (size + _MARGIN), rows * ((height or size) + _MARGIN + _LABEL) + len(counts) * _HEADING)
    if max(sides) > MAX_SIDE:
        raise RenderingError(f"the sheet would have {sides[0]} x {sides[1]} pixels, more than {MAX_SIDE} a side")


def compose_sheet(
    sections: Sequence[tuple[str, Sequence[Cell]]], size: int, columns: int
) -> UInt8[np.ndarray, "H W 3"]:
    """Lay out sections, each a heading and its cells in rows.

    Args:
        sections: heading and cells; all pictures are of one size.
        size: width of each picture in pixels.
        columns: pictures in a row.

    Raises:
        RenderingError: more than MAX_SIDE pixels a side.
    """
    from PIL import Image, ImageDraw, ImageFont

    tall = max((len(cell.pixels) for _, cells in sections for cell in cells), default=size)
    check_sheet_size([len(cells) for _, cells in sections], size, columns, tall)
    pitch = (size + _MARGIN, tall + _MARGIN + _LABEL)
    height = sum(_HEADING + -(-len(cells) // columns) * pitch[1] for _, cells in sections)
    sheet = Image.new("RGB", (columns * pitch[0] + _MARGIN, height + _MARGIN), _PAPER)
    draw = ImageDraw.Draw(sheet)
    font, large = ImageFont.load_default(11), ImageFont.load_default(14)
    top = _MARGIN
    for heading, cells in sections:
        draw.text((_MARGIN, top), _fitted(heading, sheet.width - 2 * _MARGIN, draw, large), fill=_INK, font=large)
        top += _HEADING
        for number, cell in enumerate(cells):
            x, y = _MARGIN + number % columns * pitch[0], top + number // columns * pitch[1]
            sheet.paste(Image.fromarray(cell.pixels), (x, y))
            for line, (text, ink) in enumerate(((cell.title, _INK), (cell.caption, _FAINT))):
                place = (x + 2, y + tall + 2 + line * _LINE)
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
