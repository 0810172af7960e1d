"""A sheet of small pictures of meshes, each under a framing of its own."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.rendering.pictures import render_mesh
from shapewright.rendering.sheet import Cell, compose_sheet
from shapewright.rendering.specks import specks


@dataclass(frozen=True, eq=False)
class LabelledMesh:
    """A mesh or a point cloud, and the two lines below its picture."""

    mesh: TriangleMesh | PointCloud
    title: str
    caption: str = ""


def compose_mesh_sheet(
    sections: Sequence[tuple[str, Iterable[LabelledMesh]]],
    *,
    rotation: Float[np.ndarray, "3 3"] | None = None,
    size: int = 192,
    columns: int = 6,
) -> UInt8[np.ndarray, "H W 3"]:
    """Draw meshes in sections, for example a query and what was found for it.

    Args:
        sections: heading and meshes; they are taken one at a time, so not all need be in memory.
        rotation: turns every mesh; by default :func:`three_quarter_view`, y upwards.
        size: pixels a side of each picture.
        columns: pictures in a row, or fewer if no section has as many.

    Raises:
        RenderingError: no headless OpenGL, or a sheet of more than MAX_SIDE pixels a side.
    """

    def cell(one: LabelledMesh) -> Cell:
        mesh = specks(one.mesh) if isinstance(one.mesh, PointCloud) else one.mesh
        return Cell(render_mesh(mesh, rotation=rotation, size=size), one.title, one.caption)

    drawn = [(heading, [cell(one) for one in meshes]) for heading, meshes in sections]
    return compose_sheet(drawn, size, max(1, min(columns, max(len(cells) for _, cells in drawn))))
