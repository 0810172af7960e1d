"""Ground: the plane that the object stands on, left in the scan."""

from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.mesh import TriangleMesh
from shapewright.mesh.joining import joined

CELLS: Final = 24
"""Cells along each side of the sheet."""


def add_ground(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Add a square sheet that touches the bounding box of the object at one of its six sides.

    The sheet lies centered on that side, turned about its normal by any angle.

    Args:
        mesh: vertices at the same position are joined first; its faces come first in the outcome.
        strength: side of the sheet, as a multiple of the longest side of the bounding box.
        rng: source of the side and the angle.

    Raises:
        MeshError: the mesh has no area.
    """
    whole = mesh.cleaned()
    low, high = bounds = whole.bounds
    axis, end = int(rng.integers(3)), int(rng.integers(2))
    angle_rad = rng.uniform(0.0, 0.5 * np.pi)
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    flat = _square() * strength * float((high - low).max())
    vertices = np.empty((len(flat), 3))
    vertices[:, axis] = bounds[end, axis]
    others = [other for other in range(3) if other != axis]
    vertices[:, others] = 0.5 * (low + high)[others] + flat @ np.array([[cosine, sine], [-sine, cosine]])
    number = np.arange(len(flat)).reshape(CELLS + 1, CELLS + 1)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return joined([whole, TriangleMesh(vertices, faces)])


def _square() -> Float[np.ndarray, "N 2"]:
    steps = np.linspace(-0.5, 0.5, CELLS + 1)
    return np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)


GROUND: Final = Corruption(
    name="ground",
    meaning="side of the square sheet below the object, in longest sides of the bounding box",
    strengths=(1.0, 1.5, 2.0),
    default=1.5,
    least=0.1,
    most=10.0,
    corrupt=add_ground,
)
