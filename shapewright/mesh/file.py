"""Reading mesh files: trusted ones here, strangers' ones in a child process with limits.

Types: OBJ, OFF, PLY, STL, GLB and self-contained glTF. Everything in a file becomes one mesh. What is dropped
is listed at :meth:`shapewright.mesh.TriangleMesh.cleaned`; what is refused, at the functions here. No link to a
file or an address is followed: an OBJ's material library is not looked at, a glTF with external parts is
refused. A truncated file is noticed wherever the type states its counts; an OBJ does not, so one that ends
between two faces reads as a smaller mesh.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import nullcontext
from pathlib import Path
from typing import Final

from shapewright.errors import MeshError, MeshFileError
from shapewright.mesh import TriangleMesh
from shapewright.mesh.decode import ReadLimits, decode_mesh
from shapewright.mesh.reader import MeshReader
from shapewright.mesh.sniff import check_content, normalized_type

__all__ = ["DEFAULT_LIMITS", "MeshReader", "ReadLimits", "load_mesh", "load_meshes", "parse_mesh"]

DEFAULT_LIMITS = ReadLimits()
_AHEAD: Final = 2


def load_mesh(
    path: str | Path,
    *,
    limits: ReadLimits = DEFAULT_LIMITS,
    in_child: bool = False,
    reader: MeshReader | None = None,
) -> TriangleMesh:
    """Read a file; its type is the ending of its name.

    Args:
        path: the file.
        limits: what the file may cost; memory and time are only limited in a child.
        in_child: for a file that you do not trust: parse it in a child process, as :func:`parse_mesh` does.
        reader: the same, for many files.

    Raises:
        MeshFileError: the file cannot be opened, is over a limit of size or counts, is not what its name
            says, is damaged, or holds no usable surface.
    """
    where = ascii(str(path))
    try:
        file_type = normalized_type(Path(path).suffix)
        with Path(path).open("rb") as file:
            data = file.read(limits.size_bytes + 1)
        if in_child or reader is not None:
            return parse_mesh(data, file_type, limits=limits, reader=reader)
        _check(data, file_type, limits)
        return decode_mesh(data, file_type, limits)
    except MeshError as error:
        place = f"{where}: {error.where}" if error.where else where
        raise MeshFileError(error.message, where=place) from None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise MeshFileError(f"cannot be read: {reason}", where=where) from None


def load_meshes(paths: Sequence[str | Path], *, jobs: int = 1) -> Iterator[TriangleMesh | MeshFileError]:
    """Read files that you do not trust, in their order: the mesh, or why there is none.

    Args:
        paths: the files.
        jobs: read at a time; a few are read ahead of who takes them.
    """

    def load(path: str | Path) -> TriangleMesh | MeshFileError:
        try:
            return load_mesh(path, reader=reader)
        except MeshFileError as error:  # without its traceback, which holds the content of the file
            return MeshFileError(error.message, where=error.where)

    with MeshReader(kept=jobs) as reader, ThreadPoolExecutor(jobs) as pool:
        coming: deque[Future[TriangleMesh | MeshFileError]] = deque()
        try:
            for path in paths:
                coming.append(pool.submit(load, path))
                if len(coming) > _AHEAD * jobs:
                    yield coming.popleft().result()
            while coming:
                yield coming.popleft().result()
        finally:
            pool.shutdown(cancel_futures=True)


def parse_mesh(
    data: bytes, file_type: str, *, limits: ReadLimits = DEFAULT_LIMITS, reader: MeshReader | None = None
) -> TriangleMesh:
    """Read bytes from a stranger, in a child process that can open nothing and is limited in memory and time.

    Args:
        data: the whole file.
        file_type: ``"obj"``, ``".OBJ"`` and the like; held against the content.
        limits: what the file may cost.
        reader: makes the second of many files cheaper than the first.

    Raises:
        MeshFileError: as :func:`load_mesh`, or the child ran out of memory or time.
    """
    file_type = normalized_type(file_type)
    _check(data, file_type, limits)
    with MeshReader() if reader is None else nullcontext(reader) as given:
        return given.parse(data, file_type, limits)


def _check(data: bytes, file_type: str, limits: ReadLimits) -> None:
    if len(data) > limits.size_bytes:
        raise MeshFileError(
            f"the file is larger than the limit of {limits.size_bytes} bytes",
            where=f"byte {limits.size_bytes}",
        )
    check_content(data, file_type)
