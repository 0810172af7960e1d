"""Pictures for people: one mesh, well framed and lit, and a query beside the mesh that was fitted to it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.errors import RenderingError
from shapewright.mesh import TriangleMesh
from shapewright.rendering.context import shared_context
from shapewright.rendering.renderer import Scene, indirect_commands, renderer_for
from shapewright.rendering.smoothing import corner_normals
from shapewright.rendering.styles import STYLES, WINDOW, ImageStyle, Style
from shapewright.rendering.views import three_quarter_view

FILL = 0.90
"""Share of the picture's side that the object takes."""
LARGE = 1024
"""Pictures with more pixels a side are smoothed with 4 instead of 16 samples a pixel, to save memory."""
QUERY_TINT, FITTED_TINT = 2, 3
"""Colour numbers of the query (blue) and of the fitted mesh (orange)."""


def compose_grid(images: UInt8[np.ndarray, "N H W 3"], columns: int = 5) -> UInt8[np.ndarray, "H2 W2 3"]:
    """Pictures of one size beside and below each other; what is left of the last row is white."""
    count, height, width, _ = images.shape
    columns = min(count, columns)
    rows = -(-count // columns)
    cells = np.full((rows * columns, height, width, 3), 255, dtype=np.uint8)
    cells[:count] = images
    sheet = cells.reshape(rows, columns, height, width, 3).transpose(0, 2, 1, 3, 4)
    return np.ascontiguousarray(sheet.reshape(rows * height, columns * width, 3))


def render_mesh(
    mesh: TriangleMesh,
    *,
    rotation: Float[np.ndarray, "3 3"] | None = None,
    size: int = 512,
    style: ImageStyle = "shaded",
    color: tuple[float, float, float] | None = None,
) -> UInt8[np.ndarray, "H W 3"]:
    """Draw one mesh to be looked at: it fills the picture, curved surfaces are smooth.

    Args:
        rotation: turns the mesh before it is drawn; by default :func:`three_quarter_view`, y upwards.
        size: pixels a side.
        style: ``shaded`` or ``edges``, see :data:`shapewright.rendering.ImageStyle`.
        color: red, green, blue in 0..1 for ``shaded``.

    Raises:
        RenderingError: no headless OpenGL, a picture too large.
    """
    turned = three_quarter_view() if rotation is None else rotation
    look = STYLES[style] if color is None else replace(STYLES[style], colors=(color,) * 3)
    picture: UInt8[np.ndarray, "H W 3"] = draw_together([mesh], [1], turned, size, look)[0]
    return picture


def compose_side_by_side(
    query: TriangleMesh,
    fitted: TriangleMesh,
    *,
    rotation: Float[np.ndarray, "3 3"] | None = None,
    size: int = 512,
) -> UInt8[np.ndarray, "H W 3"]:
    """Three pictures in a row under one framing: query (blue), fitted mesh (orange), both laid over another.

    In the overlay both are half transparent: where they agree the colours mix to grey, what only the query has
    is light blue, what only the fitted mesh has is light orange.

    Args:
        query: the unknown mesh.
        fitted: the generated mesh in the query's coordinates.
        rotation: turns both; by default :func:`three_quarter_view`, y upwards.
        size: pixels of each picture's side.

    Returns:
        A picture (size, 3 * size, 3).

    Raises:
        RenderingError: no headless OpenGL, a picture too large.
    """
    turned = three_quarter_view() if rotation is None else rotation
    look = STYLES["shaded"]
    blue, orange = draw_together([query, fitted], [QUERY_TINT, FITTED_TINT], turned, size, look)
    overlay = ((blue.astype(np.uint16) + orange + 1) // 2).astype(np.uint8)
    return np.concatenate([blue, orange, overlay], axis=1)


def draw_together(
    meshes: Sequence[TriangleMesh],
    tints: Sequence[int],
    rotation: Float[np.ndarray, "3 3"],
    size: int,
    style: Style,
    colors: Sequence[Float[np.ndarray, "_ 3"]] | None = None,
) -> UInt8[np.ndarray, "N H W 3"]:
    """One picture a colour number, each of its mesh, all under the framing that shows every mesh whole.

    Meshes beyond the last colour are framed with the others and not drawn. With ``colors`` of the vertices of each
    mesh (``shaded`` only) the numbers only count.
    """
    if size < 1:
        raise RenderingError("a picture has at least one pixel", where="size")
    look = replace(style, oversampling=4 if size <= LARGE else 2)
    every = np.concatenate([mesh.vertices[np.unique(mesh.faces)] for mesh in meshes])
    turned = every @ rotation.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    reach = float(max((high - low)[:2].max() / 2, (high - low)[2] / 6)) or 1.0
    origin = rotation.T @ ((low + high) / 2)
    corners = [mesh.triangles.reshape(-1, 3) for mesh in meshes]
    sizes = [len(part) for part in corners]
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)
    positions = ((np.concatenate(corners) - origin) * (FILL * WINDOW / reach)).astype(np.float32)
    triangles = np.concatenate([np.arange(count) for count in sizes]).reshape(-1, 3)
    normals = np.concatenate([corner_normals(mesh).reshape(-1, 3) for mesh in meshes])
    of_corners = None
    if colors is not None:
        of_corners = np.concatenate([own[mesh.faces].reshape(-1, 3) for mesh, own in zip(meshes, colors, strict=True)])
    with shared_context() as context:
        renderer = renderer_for(context)
        renderer.tiles_a_batch(size, look)
        out = np.empty((len(tints), size, size, 3), dtype=np.uint8)
        for number, tint in enumerate(tints):
            scene = Scene(
                positions=positions,
                triangles=triangles,
                commands=indirect_commands(np.array([number]), starts, sizes, starts),
                placements=np.concatenate([rotation, np.zeros((3, 1))], axis=1)[None],
                rectangles=np.array([[-WINDOW, -WINDOW, WINDOW, WINDOW]]),
                tints=np.array([tint]),
                normals=normals,
                colors=None if of_corners is None else of_corners.astype(np.float32),
            )
            renderer.draw(scene, out[number : number + 1], look)
    return out
