"""Pictures that people look at, as PNG files."""

import io
from pathlib import Path
from typing import TYPE_CHECKING

from shapewright.whole_file import write_whole

if TYPE_CHECKING:
    import numpy as np
    from jaxtyping import Float, UInt8

    from shapewright.mesh import TriangleMesh


def save_picture(pixels: "UInt8[np.ndarray, 'H W 3']", path: Path) -> None:
    """Write a PNG, completely or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    from PIL import Image

    png = io.BytesIO()
    Image.fromarray(pixels).save(png, format="PNG")
    write_whole(path, png.getvalue())


def save_side_by_side(
    query: "TriangleMesh",
    fitted: "TriangleMesh",
    path: Path,
    *,
    model_to_query: "Float[np.ndarray, '3 3'] | None" = None,
    size: int = 512,
) -> None:
    """Write a PNG with the query, the fitted mesh and both in one picture, seen from the same place.

    Args:
        query: the unknown mesh.
        fitted: the fitted mesh, in the coordinates of the query.
        path: of the PNG.
        model_to_query: rotation of the fitted pose; undone, so that the picture shows the object upright (z
            of the model upwards) however the query lies in its file.
        size: pixels of each of the three pictures.
    """
    from shapewright.rendering import compose_side_by_side

    save_picture(compose_side_by_side(query, fitted, rotation=upright_view(model_to_query), size=size), path)


def upright_view(model_to_query: "Float[np.ndarray, '3 3'] | None" = None) -> "Float[np.ndarray, '3 3']":
    """Return the rotation of a picture that shows z of a model upwards, however the query lies in its file."""
    from shapewright.rendering import three_quarter_view

    view = three_quarter_view("z")
    return view if model_to_query is None else view @ model_to_query.T
