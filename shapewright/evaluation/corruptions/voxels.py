"""Voxel steps: a surface made of the sides of little cubes, as from medical and game tools."""

from typing import Final

import numpy as np

from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.evaluation.voxels import voxel_sides, voxelize
from shapewright.mesh import TriangleMesh


def step_by_voxels(mesh: TriangleMesh, strength: float, rng: np.random.Generator) -> TriangleMesh:
    """Return the outer surface of the voxels that the mesh goes through, as squares along the axes.

    Hollows that the voxels enclose are filled. The surface is closed; where voxels touch at an edge only, four squares
    share it.

    Args:
        mesh: any surface.
        strength: voxels along the longest side of the bounding box.
        rng: source of the place of the grid.

    Raises:
        MeshError: the mesh has no area.
    """
    grid = voxelize(mesh.cleaned(), strength, 1, rng)
    corners, faces = voxel_sides(grid.filled())
    return TriangleMesh(grid.placed(corners), faces)


VOXELS: Final = Corruption(
    name="voxels",
    meaning="voxels along the longest side of the bounding box",
    strengths=(64.0, 40.0, 24.0),
    default=40.0,
    least=2.0,
    most=256.0,
    corrupt=step_by_voxels,
)
