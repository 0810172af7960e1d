"""Pictures of many objects at once, for classifiers to learn from (paper section 3.2)."""

from collections.abc import Iterator, Sequence
from typing import get_args

import numpy as np
from jaxtyping import Float, Float32, Int, UInt8

from shapewright.errors import RenderingError
from shapewright.mesh import TriangleMesh
from shapewright.rendering.context import shared_context
from shapewright.rendering.renderer import Scene, indirect_commands, renderer_for
from shapewright.rendering.styles import STYLES, WINDOW, Framing, ImageStyle

MAX_BATCH_VERTICES = 4_000_000
"""Vertices that one batch uploads at most, a single larger object apart."""


def render_images(
    vertices: Float[np.ndarray, "M V 3"] | Sequence[TriangleMesh],
    triangles: Int[np.ndarray, "F 3"] | None,
    rotations: Float[np.ndarray, "N 3 3"],
    scales: Float[np.ndarray, " N"],
    *,
    objects: Int[np.ndarray, " N"] | None = None,
    size: int = 224,
    style: ImageStyle = "edges",
    window: float = WINDOW,
    framing: Framing = "paper",
) -> UInt8[np.ndarray, "N H W 3"]:
    """Draw N pictures of M objects, each turned and scaled.

    Every object is normalised first, then rotated, scaled and projected orthographically onto the square
    [-window, window]. The framing ``sphere`` with window 1 shows every object whole at scales up to 1, and no
    smaller than it must be. The paper's framing (section 3.2) goes with window 2, the one of its depth images: the
    largest learning scale 2 lets an object whose far end is 1 away from its centre reach the rim exactly; only the
    ends of a box-like object's diagonals (up to 1.7) are cut off, and scale 0.8 still fills 40 % of the width.

    Both sides of a face look the same, so winding does not matter.

    Args:
        vertices: instances that share ``triangles``, or meshes of their own.
        triangles: corners of the shared topology; ``None`` with a list of meshes.
        rotations: of each picture.
        scales: of each picture.
        objects: which object each picture shows; by default picture i shows object i (N = M). Pictures of
            the same object should be neighbours, its vertices are then sent once.
        size: pixels a side.
        style: see :data:`ImageStyle`.
        window: half the side of a picture, in units of the scaled object.
        framing: how objects are normalised first, see :data:`Framing`.

    Returns:
        Pictures (N, size, size, 3), rows from top to bottom.

    Raises:
        RenderingError: no headless OpenGL, arrays that do not fit together, a picture too large.
    """
    count = len(rotations)
    shown = np.arange(count) if objects is None else np.asarray(objects, dtype=np.int64)
    _check(vertices, triangles, rotations, scales, shown, size, style)
    if count == 0:
        return np.empty((0, size, size, 3), dtype=np.uint8)
    with shared_context() as context:
        renderer = renderer_for(context)
        tiles = renderer.tiles_a_batch(size, STYLES[style])
        out = np.empty((count, size, size, 3), dtype=np.uint8)
        for start, stop in _batches(shown, tiles, vertices):
            part = slice(start, stop)
            scene = build_scene(vertices, triangles, rotations[part], scales[part], shown[part], framing)
            renderer.draw(scene, out[part], STYLES[style], window=window)
    return out


def build_scene(
    vertices: Float[np.ndarray, "M V 3"] | Sequence[TriangleMesh],
    triangles: Int[np.ndarray, "F 3"] | None,
    rotations: Float[np.ndarray, "N 3 3"],
    scales: Float[np.ndarray, " N"],
    shown: Int[np.ndarray, " N"],
    framing: Framing = "paper",
) -> Scene:
    """One batch for the renderer: only the objects it shows, normalised, one after the other."""
    used, shown = np.unique(shown, return_inverse=True)
    if isinstance(vertices, np.ndarray):
        assert triangles is not None
        chosen = vertices[used[0] : used[-1] + 1] if used[-1] - used[0] + 1 == len(used) else vertices[used]
        normalized, low, high = normalized_positions(chosen, triangles, framing)
        positions = normalized.reshape(-1, 3)
        corners = triangles
        first_vertex = np.arange(len(used)) * chosen.shape[1]
        first_corner = np.zeros(len(used), dtype=np.int64)
        corner_count = np.full(len(used), triangles.size)
    else:
        meshes = [vertices[i] for i in used]
        parts, lows, highs = zip(
            *(normalized_positions(mesh.vertices[None], mesh.faces, framing) for mesh in meshes), strict=True
        )
        low, high = np.concatenate(lows), np.concatenate(highs)
        positions = np.concatenate([part[0] for part in parts])
        corners = np.concatenate([mesh.faces for mesh in meshes])
        first_vertex = _offsets([len(mesh.vertices) for mesh in meshes])
        corner_count = np.array([mesh.faces.size for mesh in meshes])
        first_corner = _offsets(corner_count)
    placements = np.zeros((len(rotations), 3, 4))
    placements[:, :, :3] = rotations * np.asarray(scales)[:, None, None]
    return Scene(
        positions=positions,
        triangles=corners,
        commands=indirect_commands(shown, first_corner, corner_count, first_vertex),
        placements=placements,
        rectangles=covered_rectangles(low[shown], high[shown], placements),
        tints=np.ones(len(rotations), dtype=np.int64),
    )


def normalized_positions(
    vertices: Float[np.ndarray, "M V 3"], triangles: Int[np.ndarray, "F 3"], framing: Framing = "paper"
) -> tuple[Float32[np.ndarray, "M V 3"], Float32[np.ndarray, "M 3"], Float32[np.ndarray, "M 3"]]:
    """Vertices with the origin and the size that :data:`Framing` says; ends of the boxes around what faces use."""
    used = np.zeros(vertices.shape[1], dtype=bool)
    used[triangles] = True
    seen = vertices if used.all() or not used.any() else vertices[:, used]
    low, high = seen.min(axis=1), seen.max(axis=1)
    if framing == "paper":
        middle = vertices.mean(axis=1)
        reach = np.maximum(vertices.max(axis=1) - middle, middle - vertices.min(axis=1)).max(axis=1)
    else:
        middle = (low + high) / 2
        reach = np.sqrt(((seen - middle[:, None]) ** 2).sum(axis=2).max(axis=1))
    reach = np.where(reach > 0, reach, 1.0)[:, None]
    placed = ((vertices - middle[:, None]) / reach[:, None]).astype(np.float32)
    return placed, ((low - middle) / reach).astype(np.float32), ((high - middle) / reach).astype(np.float32)


def covered_rectangles(
    low: Float[np.ndarray, "N 3"], high: Float[np.ndarray, "N 3"], placements: Float[np.ndarray, "N 3 4"]
) -> Float[np.ndarray, "N 4"]:
    """Left, bottom, right, top of placed boxes with these corners."""
    centre, half = (low + high) / 2, (high - low) / 2
    turned = np.einsum("nij,nj->ni", placements[:, :2, :3], centre) + placements[:, :2, 3]
    reach = np.einsum("nij,nj->ni", np.abs(placements[:, :2, :3]), half)
    return np.concatenate([turned - reach, turned + reach], axis=1)


def _offsets(lengths: Sequence[int] | Int[np.ndarray, " M"]) -> Int[np.ndarray, " M"]:
    return np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(np.int64)


def _batches(
    shown: Int[np.ndarray, " N"], tiles: int, vertices: Float[np.ndarray, "M V 3"] | Sequence[TriangleMesh]
) -> Iterator[tuple[int, int]]:
    """Ranges of pictures that keep within the atlas and within :data:`MAX_BATCH_VERTICES`."""
    pending = [(start, min(start + tiles, len(shown))) for start in range(0, len(shown), tiles)][::-1]
    while pending:
        start, stop = pending.pop()
        used = np.unique(shown[start:stop])
        if isinstance(vertices, np.ndarray):
            size = len(used) * vertices.shape[1]
        else:
            size = sum(len(vertices[i].vertices) for i in used)
        if size > MAX_BATCH_VERTICES and len(used) > 1:
            middle = (start + stop) // 2
            pending += [(middle, stop), (start, middle)]
        else:
            yield start, stop


def _check(
    vertices: Float[np.ndarray, "M V 3"] | Sequence[TriangleMesh],
    triangles: Int[np.ndarray, "F 3"] | None,
    rotations: Float[np.ndarray, "N 3 3"],
    scales: Float[np.ndarray, " N"],
    shown: Int[np.ndarray, " N"],
    size: int,
    style: str,
) -> None:
    if style not in get_args(ImageStyle):
        raise RenderingError(f"unknown style {style!r}, choose from {list(get_args(ImageStyle))}", where="style")
    if size < 1:
        raise RenderingError("a picture has at least one pixel", where="size")
    if not len(rotations) == len(scales) == len(shown):
        raise RenderingError(
            f"{len(rotations)} rotations, {len(scales)} scales and {len(shown)} objects do not fit together"
        )
    if len(shown) and not (shown.min() >= 0 and shown.max() < len(vertices)):
        raise RenderingError(f"a picture shows an object that is not among the {len(vertices)}", where="objects")
    if isinstance(vertices, np.ndarray):
        if triangles is None:
            raise RenderingError("instances need the triangles they share", where="triangles")
        if not np.isfinite(vertices).all():
            raise RenderingError("a coordinate is NaN or infinite", where="vertices")
        if triangles.size and not (triangles.min() >= 0 and triangles.max() < vertices.shape[1]):
            raise RenderingError(f"a corner is not among the {vertices.shape[1]} vertices", where="triangles")
    elif triangles is not None:
        raise RenderingError("meshes bring their own triangles", where="triangles")
