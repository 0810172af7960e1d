"""A strip of queries above what was fitted to them, in a given order (paper Figure 11)."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.mesh import TriangleMesh
from shapewright.rendering.pictures import FITTED_TINT, QUERY_TINT, draw_together
from shapewright.rendering.sheet import Cell, compose_sheet
from shapewright.rendering.styles import STYLES
from shapewright.rendering.views import three_quarter_view


@dataclass(frozen=True, eq=False)
class Pair:
    """A query, the mesh that was fitted to it, and two lines of text.

    Attributes:
        query: the unknown mesh.
        fitted: the fitted mesh in the coordinates of the query.
        rotation: of the fitted pose; undone in the picture, so that all objects stand alike, z upwards.
        title: the first line.
        caption: the second line.
    """

    query: TriangleMesh
    fitted: TriangleMesh
    rotation: Float[np.ndarray, "3 3"]
    title: str
    caption: str


def compose_strip(
    pairs: Iterable[Pair], *, heading: str = "", size: int = 128, columns: int = 12
) -> UInt8[np.ndarray, "H W 3"]:
    """Draw pairs beside each other in their order: the query (blue) above the fitted mesh (orange).

    Args:
        pairs: they are taken one at a time, so not all need be in memory.
        heading: a line above all.
        size: pixels a side of each picture.
        columns: pairs in a row; what is left goes on below.

    Raises:
        RenderingError: no headless OpenGL, or a strip of more than MAX_SIDE pixels a side.
    """
    view, look = three_quarter_view("z"), STYLES["shaded"]
    cells = []
    for pair in pairs:
        drawn = draw_together([pair.query, pair.fitted], [QUERY_TINT, FITTED_TINT], view @ pair.rotation.T, size, look)
        cells.append(Cell(np.concatenate(list(drawn)), pair.title, pair.caption))
    return compose_sheet([(heading, cells)], size, max(1, min(columns, len(cells))))
