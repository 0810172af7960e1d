"""Readers of OBJ, OFF and STL geometry: nothing but vertices and faces, and the line of whatever is wrong.

They follow no link (an OBJ's ``mtllib`` is not even looked at) and notice truncated files, which general
readers let pass. Polygons become triangle fans.
"""

import re
import struct
from collections.abc import Iterator, Sequence

import numpy as np

from shapewright.errors import MeshFileError

Arrays = tuple[np.ndarray, np.ndarray]
"""Vertices (V, 3) float64 and faces (F, 3) int64."""

_STL_VERTEX = re.compile(rb"vertex[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)", re.IGNORECASE)


def read_obj(data: bytes) -> Arrays:
    """Read the ``v`` and ``f`` lines of a Wavefront OBJ; everything else is passed over.

    Groups become one mesh. Faces with fewer than 3 corners occur in the wild and are skipped.

    Raises:
        MeshFileError: a malformed line, an index without its vertex; ``where`` is the line.
    """
    rows: list[list[float]] = []
    faces: list[tuple[int, int, int]] = []
    for number, line in _logical_lines(data):
        words = line.split()
        if not words:
            continue
        if words[0] == b"v":
            rows.append(_numbers(words[1:4], number))
        elif words[0] == b"f":
            corners = [_obj_index(word, len(rows), number) for word in words[1:]]
            faces += _fan(corners)
    _check_indices(faces, len(rows))
    return _arrays(rows, faces)


def read_off(data: bytes) -> Arrays:
    """Read an ASCII OFF or COFF; colours are passed over, faces with fewer than 3 corners are skipped.

    Raises:
        MeshFileError: fewer lines than the counts say, a malformed line; ``where`` is the line.
    """
    lines = _off_lines(data)
    number, line = next(lines, (1, b""))
    header, rest = re.match(rb"\s*(C?OFF)?(.*)", line, re.DOTALL).groups()  # type: ignore[union-attr]
    if header is None:
        raise MeshFileError("expected OFF", where=f"line {number}")
    if not rest.strip():
        number, rest = next(lines, (number, b""))
    words = rest.split()
    if len(words) < 2 or not (words[0].isdigit() and words[1].isdigit()):
        raise MeshFileError("expected the counts of vertices and faces", where=f"line {number}")
    vertex_count, face_count = int(words[0]), int(words[1])
    rows: list[list[float]] = []
    faces: list[tuple[int, int, int]] = []
    for _ in range(vertex_count):
        number, line = _next_line(lines, number, f"{len(rows)} of {vertex_count} vertices")
        rows.append(_numbers(line.split()[:3], number))
    for index in range(face_count):
        number, line = _next_line(lines, number, f"{index} of {face_count} faces")
        words = line.split()
        size = int(words[0]) if words[0].isdigit() else 0
        if size < 1 or len(words) <= size:
            raise MeshFileError("truncated: a face with fewer corners than it states", where=f"line {number}")
        try:
            corners = [int(word) for word in words[1 : size + 1]]
        except ValueError:
            raise MeshFileError("a corner is no whole number", where=f"line {number}") from None
        if min(corners) < 0 or max(corners) >= vertex_count:
            raise MeshFileError(f"a corner is not one of {vertex_count} vertices", where=f"line {number}")
        faces += _fan(corners)
    return _arrays(rows, faces)


def read_stl(data: bytes) -> Arrays:
    """Read a binary or ASCII STL; each triangle brings its own three vertices.

    Raises:
        MeshFileError: an incomplete solid, a coordinate that is no number.
    """
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        vertices = np.frombuffer(data, record, offset=84)["corners"].reshape(-1, 3).astype(np.float64)
    else:
        lowered = data.lower()
        if b"endsolid" not in lowered[lowered.rfind(b"facet") :]:
            raise MeshFileError("truncated: no endsolid after the last facet", where=f"byte {len(data)}")
        words = _STL_VERTEX.findall(data)
        if len(words) != lowered.count(b"vertex") or len(words) % 3 or len(words) != 3 * lowered.count(b"endfacet"):
            raise MeshFileError("damaged: not every facet has three vertices of three numbers", where="solid")
        vertices = np.array([_numbers(triple, None) for triple in words], dtype=np.float64).reshape(-1, 3)
    return vertices, np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)


def _logical_lines(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Lines with their number; a backslash at the end continues a line."""
    pending = b""
    for number, line in enumerate(data.splitlines(), 1):
        if line.endswith(b"\\"):
            pending += line[:-1] + b" "
        else:
            yield number, pending + line
            pending = b""
    if pending:
        yield number, pending


def _off_lines(data: bytes) -> Iterator[tuple[int, bytes]]:
    for number, line in enumerate(data.splitlines(), 1):
        content = line.split(b"#", 1)[0].strip()
        if content:
            yield number, content


def _next_line(lines: Iterator[tuple[int, bytes]], last: int, got: str) -> tuple[int, bytes]:
    found = next(lines, None)
    if found is None:
        raise MeshFileError(f"truncated: the file ends after {got}", where=f"line {last}")
    return found


def _numbers(words: Sequence[bytes], line: int | None) -> list[float]:
    where = "solid" if line is None else f"line {line}"
    if len(words) < 3:
        raise MeshFileError("truncated: a vertex has fewer than three coordinates", where=where)
    try:
        return [float(word) for word in words]
    except ValueError:
        raise MeshFileError("a coordinate is no number", where=where) from None


def _obj_index(word: bytes, count: int, line: int) -> int:
    try:
        index = int(word.split(b"/", 1)[0])
    except ValueError:
        raise MeshFileError("a corner is no whole number", where=f"line {line}") from None
    if index == 0 or count + index < 0:
        raise MeshFileError(f"there is no vertex {index}", where=f"line {line}")
    return index - 1 if index > 0 else count + index


def _check_indices(faces: list[tuple[int, int, int]], count: int) -> None:
    # vertices may come after the faces that use them, so this has to wait for the end
    largest = max((max(face) for face in faces), default=-1)
    if largest >= count:
        raise MeshFileError(f"a face uses vertex {largest + 1} of {count}; is the file truncated?", where="faces")


def _fan(corners: list[int]) -> list[tuple[int, int, int]]:
    return [(corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1)]


def _arrays(rows: list[list[float]], faces: list[tuple[int, int, int]]) -> Arrays:
    return (
        np.array(rows, dtype=np.float64).reshape(-1, 3),
        np.array(faces, dtype=np.int64).reshape(-1, 3),
    )
