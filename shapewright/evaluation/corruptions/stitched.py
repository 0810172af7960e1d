"""Bad stitching: several one-sided scans that were put together a little off."""

from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from shapewright.errors import MeshError
from shapewright.evaluation.corruptions.corruption import Corruption, diagonal
from shapewright.evaluation.depth_scans import scan_front_and_back
from shapewright.mesh import TriangleMesh
from shapewright.mesh.joining import joined

SIZE: Final = 128
"""Pixels along each side of a depth picture."""


def stitch_badly(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Replace the surface by six depth pictures of it, each moved by a small rigid motion of its own.

    The pictures are taken along both directions of three perpendicular axes, so neighboring ones overlap; what none of
    them sees is missing. A motion shifts a picture by ``strength`` diagonals in a random direction, and turns it about
    the middle of the object, around a random axis, by so much that points half a diagonal away move as far again.

    Args:
        mesh: any surface.
        strength: length of each shift, as a share of the diagonal.
        rng: source of the axes and the motions.

    Raises:
        MeshError: the mesh has no area, or the pictures show nothing.
    """
    whole = mesh.cleaned()
    axes = Rotation.random(rng=rng).as_matrix()
    scans: list[TriangleMesh | None] = []
    for first in range(3):
        frame = np.ascontiguousarray(np.roll(axes, first, axis=0))
        scans += scan_front_and_back(whole, frame, SIZE)
    center, length = whole.bounds.mean(axis=0), diagonal(whole)
    moved = []
    for scan in scans:
        around, toward = (direction / np.linalg.norm(direction) for direction in rng.normal(size=(2, 3)))
        if scan is not None:
            turn = Rotation.from_rotvec(2.0 * strength * around)
            vertices = turn.apply(scan.vertices - center) + center + strength * length * toward
            moved.append(TriangleMesh(vertices, scan.faces))
    if not moved:
        raise MeshError("pictures from six directions show nothing", where="vertices")
    return joined(moved).cleaned()


STITCHED: Final = Corruption(
    name="stitched",
    meaning="shift of each of six one-sided scans, as a share of the diagonal",
    strengths=(0.005, 0.015, 0.03),
    default=0.015,
    least=0.0,
    most=0.5,
    corrupt=stitch_badly,
)
