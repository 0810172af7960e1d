"""Pictures of a query and its fit side by side, each colored by how far it is from the other."""

from typing import Final

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.mesh import TriangleMesh
from shapewright.rendering.colormap import TOLERANCES_SHOWN, residual_colors
from shapewright.rendering.pictures import draw_together
from shapewright.rendering.styles import STYLES
from shapewright.rendering.views import three_quarter_view

_LEGEND: Final = 56  # pixels
_MARGIN: Final = 14
_BAR: Final = 12
_INK, _FAINT = (20, 24, 30), (110, 116, 125)


def compose_residuals(
    query: TriangleMesh,
    fit: TriangleMesh,
    query_distances: Float[np.ndarray, " Vq"],
    fit_distances: Float[np.ndarray, " Vm"],
    tolerance: float,
    *,
    rotation: Float[np.ndarray, "3 3"] | None = None,
    size: int = 512,
) -> UInt8[np.ndarray, "H W 3"]:
    """Draw the query colored by its distance to the fit, the fit by its distance to the query, and a legend below.

    Args:
        query: the unknown mesh.
        fit: the fitted mesh, in the same coordinates.
        query_distances: of each vertex of the query; what the model cannot follow is dark.
        fit_distances: of each vertex of the fit; what the model invents is dark.
        tolerance: marked on the legend; in the unit of the distances.
        rotation: turns both; by default :func:`three_quarter_view`, y upwards.
        size: pixels of each picture's side.

    Returns:
        A picture of (size + 56, 2 * size) pixels.

    Raises:
        RenderingError: no headless OpenGL, a picture too large.
    """
    turned = three_quarter_view() if rotation is None else rotation
    colors = [residual_colors(distances, tolerance) for distances in (query_distances, fit_distances)]
    drawn = draw_together([query, fit], [1, 2], turned, size, STYLES["shaded"], colors)
    return np.concatenate([np.concatenate([drawn[0], drawn[1]], axis=1), _legend(size, tolerance)])


def _legend(size: int, tolerance: float) -> UInt8[np.ndarray, "H W 3"]:
    """Return the captions of the two pictures, and a bar with all colors on which the tolerance is marked."""
    from PIL import Image, ImageDraw, ImageFont

    width = 2 * size
    sheet = Image.new("RGB", (width, _LEGEND), (255, 255, 255))
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(12)
    for left, caption in ((0, "query, by distance to the fit"), (size, "fit, by distance to the query")):
        draw.text((left + size / 2, 3), caption, fill=_INK, font=font, anchor="ma")
    left, right, top = _MARGIN, width - _MARGIN, 22
    most = TOLERANCES_SHOWN * tolerance
    colors = residual_colors(np.linspace(0.0, most, right - left), tolerance)
    bar = np.repeat((255 * colors).round().astype(np.uint8)[None], _BAR, axis=0)
    sheet.paste(Image.fromarray(bar), (left, top))
    place = left + (right - left) / TOLERANCES_SHOWN
    draw.line([(place, top - 3), (place, top + _BAR + 3)], fill=_INK, width=2)
    below = top + _BAR + 4
    draw.text((left, below), "0", fill=_FAINT, font=font, anchor="la")
    draw.text((place, below), f"tolerance {tolerance:g}", fill=_INK, font=font, anchor="ma")
    draw.text((right, below), f"{most:g} of the half extent, or more", fill=_FAINT, font=font, anchor="ra")
    return np.asarray(sheet)
