"""From the bytes of a file to a clean triangle mesh, in this very process.

Strangers' files go through :func:`shapewright.mesh.file.parse_mesh`, which runs this in a child process.
"""

from dataclasses import dataclass
from io import BytesIO

import numpy as np

from shapewright.errors import MeshError, MeshFileError
from shapewright.mesh import TriangleMesh
from shapewright.mesh.text import Arrays, read_obj, read_off, read_stl

FEWEST_FACES = 4
"""A tetrahedron; less is no solid object."""
LARGEST_COORDINATE = 1e15
"""Larger coordinates are damage, not size; they would overflow squared areas in single precision."""


@dataclass(frozen=True)
class ReadLimits:
    """How much a file may cost; beyond any of them it is refused.

    The last three hold only in a child process (:func:`shapewright.mesh.file.parse_mesh`).
    """

    size_bytes: int = 64 * 2**20
    vertices: int = 2_000_000
    faces: int = 2_000_000
    memory_bytes: int = 3 * 2**30
    cpu_s: int = 60
    wall_s: float = 90.0


def decode_mesh(data: bytes, file_type: str, limits: ReadLimits) -> TriangleMesh:
    """Parse and clean (:meth:`TriangleMesh.cleaned`) checked content of a normalised type.

    Raises:
        MeshFileError: damaged content, too many vertices or faces, NaN, nothing with an area, or fewer than
            :data:`FEWEST_FACES` faces.
    """
    readers = {"obj": read_obj, "off": read_off, "stl": read_stl}
    try:
        read = readers.get(file_type)
        vertices, faces = read(data) if read else _through_trimesh(data, file_type)
    except (ValueError, OverflowError) as error:  # a number of 5 000 digits and the like
        where = f"{file_type.upper()} content"
        raise MeshFileError(f"a number cannot be read: {str(error)[:100]}", where=where) from None
    if len(faces) == 0:
        raise MeshFileError("the file has no faces", where="faces")
    for kind, rows, most in (("vertices", vertices, limits.vertices), ("faces", faces, limits.faces)):
        if len(rows) > most:
            raise MeshFileError(f"{len(rows)} {kind} are more than the limit of {most}", where=kind)
    try:
        mesh = TriangleMesh(vertices, faces)
        largest = np.abs(mesh.vertices).max(axis=1)
        if (largest > LARGEST_COORDINATE).any():
            raise MeshFileError(
                f"a coordinate is beyond {LARGEST_COORDINATE:g}", where=f"vertices[{int(np.argmax(largest))}]"
            )
        mesh = mesh.cleaned()
    except MeshFileError:
        raise
    except MeshError as error:
        raise MeshFileError(error.message, where=error.where) from None
    if len(mesh.faces) < FEWEST_FACES:
        dropped = len(faces) - len(mesh.faces)
        raise MeshFileError(
            f"{len(mesh.faces)} faces with an area ({dropped} without): fewer than {FEWEST_FACES} faces is no"
            " solid object",
            where="faces",
        )
    return mesh


def _through_trimesh(data: bytes, file_type: str) -> Arrays:
    """PLY and glTF; the scene graph becomes one mesh, no resolver is given, so nothing can be followed."""
    import trimesh

    try:
        loaded = trimesh.load_scene(
            BytesIO(data), file_type=file_type, resolver=None, process=False, skip_materials=True
        )
        mesh = loaded.to_mesh()
    except MemoryError:
        raise
    except Exception as error:  # whatever a parser meets in a stranger's bytes
        reason = str(error) or type(error).__name__
        raise MeshFileError(f"damaged or truncated: {reason[:200]}", where=f"{file_type.upper()} content") from error
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)
