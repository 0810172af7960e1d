"""Reading files of meshes and point clouds: trusted ones here, strangers' ones in a child process with limits.

Types of meshes: OBJ, OFF, PLY, STL, GLB and self-contained glTF; without faces they are point clouds. Types of point
clouds: LAS, LAZ, PCD, and text with a point on each line (XYZ, PTS, ASC, CSV, TXT). Everything in a file becomes one
mesh or one cloud. What is dropped is listed at :meth:`shapewright.mesh.TriangleMesh.cleaned` and
:func:`shapewright.mesh.decode.decode_query`; what is refused, at the functions here. No link to a
file or an address is followed: an OBJ's material library is not looked at, a glTF with external parts is
refused. A truncated file is noticed wherever the type states its counts; an OBJ does not, so one that ends
between two faces reads as a smaller mesh.
"""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import nullcontext
from pathlib import Path
from typing import Final, TypeVar

from shapewright.errors import MeshError, MeshFileError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.decode import ReadLimits, decode_query
from shapewright.mesh.reader import MeshReader
from shapewright.mesh.sniff import check_content, normalized_type

__all__ = [
    "DEFAULT_LIMITS",
    "MeshReader",
    "ReadLimits",
    "load_mesh",
    "load_meshes",
    "load_queries",
    "load_query",
    "parse_mesh",
    "parse_query",
]

DEFAULT_LIMITS = ReadLimits()
_AHEAD: Final = 2
_Read = TypeVar("_Read", TriangleMesh, TriangleMesh | PointCloud)


def load_query(
    path: str | Path,
    *,
    limits: ReadLimits = DEFAULT_LIMITS,
    in_child: bool = False,
    reader: MeshReader | None = None,
) -> TriangleMesh | PointCloud:
    """Read a mesh, or a point cloud where the file has no faces; the type is the ending of the file's name.

    Args:
        path: the file.
        limits: what the file may cost; memory and time are only limited in a child.
        in_child: for a file that you do not trust: parse it in a child process, as :func:`parse_query` does.
        reader: the same, for many files.

    Raises:
        MeshFileError: the file cannot be opened, is over a limit of size or counts, is not what its name
            says, is damaged, or holds neither a usable surface nor points.
    """
    where = ascii(str(path))
    try:
        file_type = normalized_type(Path(path).suffix)
        with Path(path).open("rb") as file:
            data = file.read(limits.size_bytes + 1)
        if in_child or reader is not None:
            return parse_query(data, file_type, limits=limits, reader=reader)
        _check(data, file_type, limits)
        return decode_query(data, file_type, limits)
    except MeshError as error:
        place = f"{where}: {error.where}" if error.where else where
        raise MeshFileError(error.message, where=place) from None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise MeshFileError(f"cannot be read: {reason}", where=where) from None


def load_mesh(
    path: str | Path,
    *,
    limits: ReadLimits = DEFAULT_LIMITS,
    in_child: bool = False,
    reader: MeshReader | None = None,
) -> TriangleMesh:
    """Read a mesh, as :func:`load_query`; a point cloud is refused.

    Raises:
        MeshFileError: as :func:`load_query`, or the file has no faces.
    """
    where = ascii(str(path))
    query = load_query(path, limits=limits, in_child=in_child, reader=reader)
    try:
        return _surface(query)
    except MeshFileError as error:
        raise MeshFileError(error.message, where=f"{where}: {error.where}") from None


def load_queries(paths: Sequence[str | Path], *, jobs: int = 1) -> Iterator[TriangleMesh | PointCloud | MeshFileError]:
    """Read files that you do not trust, in their order: the mesh or point cloud, or why there is none.

    Args:
        paths: the files.
        jobs: files that are read at a time; a few are read before they are asked for.
    """
    return _load_each(load_query, paths, jobs)


def load_meshes(paths: Sequence[str | Path], *, jobs: int = 1) -> Iterator[TriangleMesh | MeshFileError]:
    """Read files that you do not trust, in their order, as :func:`load_queries`; a point cloud is refused."""
    return _load_each(load_mesh, paths, jobs)


def _load_each(
    load_one: Callable[..., _Read], paths: Sequence[str | Path], jobs: int
) -> Iterator[_Read | MeshFileError]:
    with MeshReader(kept=jobs) as reader, ThreadPoolExecutor(jobs) as pool:

        def load(path: str | Path) -> _Read | MeshFileError:
            try:
                return load_one(path, reader=reader)
            except MeshFileError as error:  # without its traceback, which holds the content of the file
                return MeshFileError(error.message, where=error.where)

        coming: deque[Future[_Read | MeshFileError]] = deque()
        try:
            for path in paths:
                coming.append(pool.submit(load, path))
                if len(coming) > _AHEAD * jobs:
                    yield coming.popleft().result()
            while coming:
                yield coming.popleft().result()
        finally:
            pool.shutdown(cancel_futures=True)


def parse_query(
    data: bytes, file_type: str, *, limits: ReadLimits = DEFAULT_LIMITS, reader: MeshReader | None = None
) -> TriangleMesh | PointCloud:
    """Read bytes from a stranger, in a child process that can open nothing and is limited in memory and time.

    Args:
        data: the whole file.
        file_type: ``"obj"``, ``".OBJ"`` and the like; held against the content.
        limits: what the file may cost.
        reader: makes the second of many files cheaper than the first.

    Raises:
        MeshFileError: as :func:`load_query`, or the child ran out of memory or time.
    """
    file_type = normalized_type(file_type)
    _check(data, file_type, limits)
    with MeshReader() if reader is None else nullcontext(reader) as given:
        return given.parse(data, file_type, limits)


def parse_mesh(
    data: bytes, file_type: str, *, limits: ReadLimits = DEFAULT_LIMITS, reader: MeshReader | None = None
) -> TriangleMesh:
    """Read bytes from a stranger, as :func:`parse_query`; a point cloud is refused.

    Raises:
        MeshFileError: as :func:`parse_query`, or the file has no faces.
    """
    return _surface(parse_query(data, file_type, limits=limits, reader=reader))


def _surface(query: TriangleMesh | PointCloud) -> TriangleMesh:
    if isinstance(query, PointCloud):
        raise MeshFileError(
            f"the file has no faces: it is a cloud of {len(query.points)} points, and a mesh is needed here"
            " (classification and retrieval take point clouds)",
            where="faces",
        )
    return query


def _check(data: bytes, file_type: str, limits: ReadLimits) -> None:
    if len(data) > limits.size_bytes:
        raise MeshFileError(
            f"the file is larger than the limit of {limits.size_bytes} bytes",
            where=f"byte {limits.size_bytes}",
        )
    check_content(data, file_type)
