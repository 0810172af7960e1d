"""Pictures of simple shapes stay as they are: every style, and the comparison of a query with a fitted mesh."""

import numpy as np
import pytest
import simple_shapes

from shapewright.rendering import compose_side_by_side, even_views, render_images, render_mesh

SHAPES = {
    "goblet": simple_shapes.goblet(),
    "stool": simple_shapes.stool(),
    "sheets": simple_shapes.crossing_sheets(),
    "soup": simple_shapes.flipped(simple_shapes.goblet(), share=0.5),
}


@pytest.mark.parametrize("style", ["edges", "shaded", "fused", "lambert", "depth", "normals"])
def test_learning_pictures(golden, style):
    framed = {} if style in ("edges", "shaded") else {"framing": "sphere", "window": 1.0}
    scales = [0.7, 0.8, 0.9, 1.0] if framed else [0.8, 1.2, 1.6, 2.0]
    images = render_images(
        list(SHAPES.values()),
        None,
        np.tile(even_views(4), (len(SHAPES), 1, 1)),
        np.tile(scales, len(SHAPES)),
        objects=np.repeat(np.arange(len(SHAPES)), 4),
        size=96,
        style=style,
        **framed,
    )
    sheet = images.reshape(len(SHAPES), 4, 96, 96, 3).transpose(0, 2, 1, 3, 4).reshape(-1, 4 * 96, 3)
    golden(f"learning_{style}", sheet)


@pytest.mark.parametrize("name", ["goblet", "stool"])
def test_pictures_for_people(golden, name):
    golden(f"portrait_{name}", render_mesh(SHAPES[name], size=160))


def test_query_beside_fitted(golden):
    query = SHAPES["goblet"]
    fitted = query.transformed(np.eye(3), np.array([0.12, 0.0, 0.0]), 0.96)
    golden("side_by_side", compose_side_by_side(query, fitted, size=160))
