"""The picture that shows a fit to a person."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from jaxtyping import Float

    from shapewright.mesh import TriangleMesh


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
    from PIL import Image

    from shapewright.rendering import compose_side_by_side, three_quarter_view

    view = three_quarter_view("z")
    rotation = view if model_to_query is None else view @ model_to_query.T
    Image.fromarray(compose_side_by_side(query, fitted, rotation=rotation, size=size)).save(path)
