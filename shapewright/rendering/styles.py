"""Looks of pictures and the numbers that frame them; plain values, no OpenGL."""

from dataclasses import dataclass
from typing import Final, Literal, get_args

SCALE_RANGE = (0.8, 2.0)
"""Scales of the learning images (paper section 3.2)."""
WINDOW = 2.0
"""Half the side of a picture, in units of the scaled object (whose coordinates lie within ±1 at scale 1)."""

Framing = Literal["paper", "sphere"]
"""``paper``: vertex mean at the origin, coordinates within ±1 (section 3.2).
``sphere``: middle of the bounding box at the origin, the farthest point at distance 1;
vertices that no face uses do not count."""

FRAMINGS: Final[tuple[Framing, ...]] = get_args(Framing)

ImageStyle = Literal["edges", "shaded", "lambert", "depth", "normals", "fused"]
"""Looks of triangles drawn with OpenGL. ``edges``: gray fill with dark silhouettes, creases and steps; ``fused``:
edges, depth and slope in one picture; ``shaded``: lit, for people."""

PictureStyle = Literal[ImageStyle, "splats"]
"""Looks that a classifier can learn: those of triangles, and ``splats``, see :mod:`shapewright.rendering.splats`."""

PICTURE_STYLES: Final[tuple[PictureStyle, ...]] = get_args(PictureStyle)


@dataclass(frozen=True)
class Style:
    """How the surface becomes a picture.

    Args:
        shader: name of the fragment shader without its ending.
        oversampling: samples along each side of a pixel; even, or 1 where speed counts more than smooth rims.
        line_strength: darkness of lines, for shaders that let one choose.
        background: red, green, blue in 0..1, for the same shaders.
        colors: of colour numbers 1 to 3.
    """

    shader: str
    oversampling: int = 2
    line_strength: float = 0.0
    background: tuple[float, float, float] = (1.0, 1.0, 1.0)
    colors: tuple[tuple[float, float, float], ...] = ((0.6, 0.6, 0.6),) * 3


STYLES: dict[str, Style] = {
    "edges": Style("edges", oversampling=2),
    "lambert": Style("lambert", oversampling=2),
    "depth": Style("depth", oversampling=2),
    "normals": Style("normals", oversampling=2),
    "fused": Style("fused", oversampling=1),
    "shaded": Style(
        "shaded",
        oversampling=2,
        line_strength=0.30,
        background=(0.972, 0.976, 0.984),
        colors=((0.66, 0.74, 0.84), (0.16, 0.44, 0.80), (0.95, 0.55, 0.14)),
    ),
}
