"""A reader of PCD files, the format of the Point Cloud Library: ASCII, binary, and binary compressed.

Of all fields only the positions are kept. Counts and sizes in the header are compared with the content before
memory is taken for them.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from shapewright.errors import MeshFileError
from shapewright.mesh.lzf import LARGEST_GAIN, decompress_lzf

_HEADER_WORDS: Final = frozenset(
    ("VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA")
)
_TYPES: Final = {
    "F": {4: "<f4", 8: "<f8"},
    "I": {1: "<i1", 2: "<i2", 4: "<i4", 8: "<i8"},
    "U": {1: "<u1", 2: "<u2", 4: "<u4", 8: "<u8"},
}
_LONGEST_HEADER: Final = 1 << 16
_WIDEST_POINT: Final = 1 << 16


@dataclass(frozen=True)
class _Header:
    """What a file says about itself, and the bytes after that."""

    fields: tuple[str, ...]
    types: tuple[str, ...]
    counts: tuple[int, ...]
    points: int
    storage: str
    body: bytes
    lines: int

    @property
    def row(self) -> np.dtype:
        """One point in a binary file; fields are named by their number, as names may repeat."""
        columns = zip(self.types, self.counts, strict=True)
        return np.dtype([(f"{number}", kind, (count,)) for number, (kind, count) in enumerate(columns)])


def read_pcd(data: bytes, most_points: int) -> np.ndarray:
    """Return the positions in a PCD file, (N, 3) float64; points that were not measured are NaN.

    Raises:
        MeshFileError: a header that is damaged or does not fit the content, or more points than wanted; ``where``
            is the line of the header or of the point.
    """
    header = _read_header(data)
    if header.points > most_points:
        raise MeshFileError(f"{header.points} points are more than the limit of {most_points}", where="POINTS")
    places = [header.fields.index(axis) for axis in "xyz" if header.fields.count(axis) == 1]
    if len(places) != 3 or any(header.counts[place] != 1 for place in places):
        raise MeshFileError("expected one field each of x, y and z", where="FIELDS")
    if header.storage == "ascii":
        return _ascii_points(header, places)
    if header.storage == "binary":
        size = header.points * header.row.itemsize
        if len(header.body) < size:
            raise MeshFileError(
                f"truncated: {header.points} points take {size} bytes, there are {len(header.body)}", where="DATA"
            )
        rows = np.frombuffer(header.body, header.row, count=header.points)
        return np.column_stack([rows[f"{place}"][:, 0] for place in places]).astype(np.float64)
    return _compressed_points(header, places)


def _ascii_points(header: _Header, places: list[int]) -> np.ndarray:
    starts = np.cumsum([0, *header.counts])
    columns = [int(starts[place]) for place in places]
    width = int(starts[-1])
    points: list[list[float]] = []
    number = header.lines
    for number, line in enumerate(header.body.splitlines(), header.lines + 1):
        words = line.split()
        if not words:
            continue
        if len(words) != width:
            raise MeshFileError(f"expected {width} numbers, got {len(words)}", where=f"line {number}")
        try:
            points.append([float(words[column]) for column in columns])
        except ValueError:
            raise MeshFileError("a coordinate is not a number", where=f"line {number}") from None
    if len(points) != header.points:
        raise MeshFileError(f"{header.points} points stated, {len(points)} there", where=f"line {number}")
    return np.array(points, dtype=np.float64).reshape(-1, 3)


def _compressed_points(header: _Header, places: list[int]) -> np.ndarray:
    """Read fields one after the other, each of all points."""
    if len(header.body) < 8:
        raise MeshFileError("truncated: the compressed data has no size", where="DATA")
    packed, size = struct.unpack_from("<II", header.body)
    expected = header.points * header.row.itemsize
    if size != expected:
        raise MeshFileError(f"{header.points} points take {expected} bytes, {size} are stated", where="DATA")
    if len(header.body) < 8 + packed:
        raise MeshFileError(f"truncated: {packed} compressed bytes stated, {len(header.body) - 8} there", where="DATA")
    if size > packed * LARGEST_GAIN:
        raise MeshFileError(f"{packed} compressed bytes cannot stand for {size}", where="DATA")
    try:
        data = decompress_lzf(header.body[8 : 8 + packed], size)
    except ValueError as error:
        raise MeshFileError(f"damaged: {error}", where="DATA") from None
    sizes = [np.dtype(kind).itemsize * count for kind, count in zip(header.types, header.counts, strict=True)]
    starts = np.cumsum([0, *sizes]) * header.points
    columns = [np.frombuffer(data, header.types[k], count=header.points, offset=int(starts[k])) for k in places]
    return np.column_stack(columns).astype(np.float64)


def _read_header(data: bytes) -> _Header:
    entries: dict[str, list[str]] = {}
    end = number = 0
    for number, start, end in _lines(data[:_LONGEST_HEADER]):
        words = data[start:end].split(b"#", 1)[0].decode("ascii", "replace").split()
        if not words:
            continue
        name, values = words[0].upper(), words[1:]
        if name not in _HEADER_WORDS:
            raise MeshFileError(f"unknown entry {name[:20]!r} of the header", where=f"line {number}")
        entries["FIELDS" if name == "COLUMNS" else name] = values
        if name == "DATA":
            break
    missing = [name for name in ("FIELDS", "SIZE", "TYPE", "DATA") if not entries.get(name)]
    if missing:
        raise MeshFileError(f"truncated or damaged: the header has no {', '.join(missing)}", where=f"line {number}")
    fields = tuple(name.lower() for name in entries["FIELDS"])
    sizes = _whole_numbers(entries, "SIZE", len(fields))
    counts = _whole_numbers(entries, "COUNT", len(fields)) if "COUNT" in entries else (1,) * len(fields)
    if len(entries["TYPE"]) != len(fields):
        raise MeshFileError(f"expected {len(fields)} types, got {len(entries['TYPE'])}", where="TYPE")
    kinds = [_TYPES.get(kind.upper(), {}).get(size) for kind, size in zip(entries["TYPE"], sizes, strict=True)]
    types = tuple(kind for kind in kinds if kind is not None)
    if len(types) != len(fields):
        raise MeshFileError("expected F of 4 or 8 bytes, I or U of 1, 2, 4 or 8 bytes", where="TYPE")
    if min(counts) < 1 or sum(size * count for size, count in zip(sizes, counts, strict=True)) > _WIDEST_POINT:
        raise MeshFileError(f"a point of no bytes, or of more than {_WIDEST_POINT}", where="COUNT")
    storage = entries["DATA"][0].lower()
    if storage not in ("ascii", "binary", "binary_compressed"):
        raise MeshFileError(f"{storage[:20]!r} is not ascii, binary or binary_compressed", where="DATA")
    return _Header(fields, types, counts, _stated_points(entries), storage, data[end:].removeprefix(b"\n"), number)


def _lines(head: bytes) -> Iterator[tuple[int, int, int]]:
    """Give the number, the start and the end of each line that is complete."""
    number, start = 1, 0
    while (end := head.find(b"\n", start)) >= 0:
        yield number, start, end
        number, start = number + 1, end + 1


def _stated_points(entries: dict[str, list[str]]) -> int:
    width, height = (_whole_numbers(entries, name, 1)[0] if name in entries else None for name in ("WIDTH", "HEIGHT"))
    product = None if width is None else width * (1 if height is None else height)
    points = _whole_numbers(entries, "POINTS", 1)[0] if "POINTS" in entries else product
    if points is None:
        raise MeshFileError("the header states no number of points", where="POINTS")
    if product is not None and points != product:
        raise MeshFileError(f"{points} points stated, but width times height is {product}", where="POINTS")
    return points


def _whole_numbers(entries: dict[str, list[str]], name: str, count: int) -> tuple[int, ...]:
    words = entries[name]
    if len(words) != count or not all(word.isdigit() and word.isascii() and len(word) <= 12 for word in words):
        raise MeshFileError(f"expected {count} whole numbers, got {' '.join(words)[:40]!r}", where=name)
    return tuple(int(word) for word in words)
