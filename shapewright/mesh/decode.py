"""From the bytes of a file to a clean triangle mesh or a point cloud, in this very process.

Strangers' files go through :func:`shapewright.mesh.file.parse_query`, which runs this in a child process.
"""

from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np

from shapewright.errors import MeshError, MeshFileError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.las import read_las
from shapewright.mesh.pcd import read_pcd
from shapewright.mesh.places import first_at_place
from shapewright.mesh.point_cloud import LEAST_POINTS
from shapewright.mesh.rows import read_rows
from shapewright.mesh.sniff import POINT_TYPES
from shapewright.mesh.text import Arrays, read_obj, read_off, read_stl

FEWEST_FACES = 4
"""A tetrahedron; less is no solid object."""
LARGEST_COORDINATE = 1e15
"""Larger coordinates are damage, not size; they would overflow squared areas in single precision."""


@dataclass(frozen=True)
class ReadLimits:
    """How much a file may cost; beyond any of them it is refused.

    The last three hold only in a child process (:func:`shapewright.mesh.file.parse_query`). The points of a cloud
    count as vertices.
    """

    size_bytes: int = 64 * 2**20
    vertices: int = 2_000_000
    faces: int = 2_000_000
    memory_bytes: int = 3 * 2**30
    cpu_s: int = 60
    wall_s: float = 90.0


def decode_query(data: bytes, file_type: str, limits: ReadLimits) -> TriangleMesh | PointCloud:
    """Parse and clean checked content of a normalised type; what has no faces is a point cloud.

    Meshes are cleaned by :meth:`TriangleMesh.cleaned`. Of a point cloud, points with NaN are dropped, as organized
    scans have them where nothing was measured, and so are points at exactly the place of an earlier one.

    Raises:
        MeshFileError: damaged content, too many vertices or faces, a coordinate that is not finite, nothing with an
            area, fewer than :data:`FEWEST_FACES` faces, fewer than :data:`LEAST_POINTS` different points.
    """
    try:
        vertices, faces = _arrays(data, file_type, limits)
    except (ValueError, OverflowError) as error:  # a number of 5 000 digits and the like
        where = f"{file_type.upper()} content"
        raise MeshFileError(f"a number cannot be read: {str(error)[:100]}", where=where) from None
    if len(faces) == 0:
        return _cloud(vertices, limits)
    _check_count("vertices", len(vertices), limits.vertices)
    _check_count("faces", len(faces), limits.faces)
    try:
        mesh = TriangleMesh(vertices, faces)
        _check_size(mesh.vertices, "vertices")
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


def _arrays(data: bytes, file_type: str, limits: ReadLimits) -> Arrays:
    if file_type in POINT_TYPES:
        readers = {"pcd": read_pcd, "las": read_las, "laz": read_las}
        read_points = readers.get(file_type)
        points = read_points(data, limits.vertices) if read_points else read_rows(data)
        return points, np.empty((0, 3), dtype=np.int64)
    read = {"obj": read_obj, "off": read_off, "stl": read_stl}.get(file_type)
    return read(data) if read else _through_trimesh(data, file_type)


def _cloud(points: np.ndarray, limits: ReadLimits) -> PointCloud:
    _check_count("points", len(points), limits.vertices)
    infinite = np.isinf(points).any(axis=1)
    if infinite.any():
        raise MeshFileError("a coordinate is infinite", where=f"points[{int(np.argmax(infinite))}]")
    _check_size(points, "points")
    measured = points[~np.isnan(points).any(axis=1)]
    different = measured[first_at_place(measured) == np.arange(len(measured))]
    if len(different) < LEAST_POINTS:
        raise MeshFileError(
            f"the file has no faces, and {len(different)} different points are fewer than {LEAST_POINTS}",
            where="points",
        )
    return PointCloud(different)


def _check_count(kind: str, count: int, most: int) -> None:
    if count > most:
        raise MeshFileError(f"{count} {kind} are more than the limit of {most}", where=kind)


def _check_size(rows: np.ndarray, kind: str) -> None:
    beyond = (np.abs(rows) > LARGEST_COORDINATE).any(axis=1)
    if beyond.any():
        raise MeshFileError(f"a coordinate is beyond {LARGEST_COORDINATE:g}", where=f"{kind}[{int(np.argmax(beyond))}]")


def _through_trimesh(data: bytes, file_type: str) -> Arrays:
    """Read PLY and glTF; a scene becomes one mesh or cloud. No resolver is given, so nothing can be followed."""
    import trimesh

    try:
        loaded = trimesh.load_scene(
            BytesIO(data), file_type=file_type, resolver=None, process=False, skip_materials=True
        )
        mesh = loaded.to_mesh()
        vertices = mesh.vertices if len(mesh.faces) else _points(loaded)
    except MemoryError:
        raise
    except Exception as error:  # whatever a parser meets in a stranger's bytes
        reason = str(error) or type(error).__name__
        raise MeshFileError(f"damaged or truncated: {reason[:200]}", where=f"{file_type.upper()} content") from error
    return np.array(vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)


def _points(scene: Any) -> np.ndarray:
    """Return the points of a scene without faces, where its graph puts them."""
    import trimesh

    found = [np.empty((0, 3))]
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        if isinstance(scene.geometry[name], trimesh.PointCloud):
            found.append(trimesh.transform_points(scene.geometry[name].vertices, matrix))
    return np.concatenate(found)
