"""A reader of LAS and LAZ scans, through laspy."""

from io import BytesIO
from typing import Final

import numpy as np

from shapewright.errors import MeshFileError

_RECORD_COUNT: Final = slice(100, 104)
"""Bytes of the header with the number of variable-length records (LAS 1.0 to 1.5)."""
_LEAST_RECORD: Final = 54
"""Size of an empty record in bytes."""
_PANIC: Final = "PanicException"
"""Name of the exception that a panic in a Rust library becomes; no module exports it."""


def read_las(data: bytes, most_points: int) -> np.ndarray:
    """Return the positions in a LAS or LAZ file, (N, 3) float64, with its offset and scale applied.

    Raises:
        MeshFileError: damaged or truncated content, or more points than wanted.
    """
    import laspy

    # laspy does not stop reading records at the end of the file
    records = int.from_bytes(data[_RECORD_COUNT], "little")
    if records * _LEAST_RECORD > len(data):
        raise MeshFileError(f"{records} records stated, {len(data)} bytes there", where="LAS header")
    try:
        # one thread: a child that reads files may start no other
        with laspy.open(BytesIO(data), laz_backend=(laspy.LazBackend.Lazrs,), read_evlrs=False) as reader:
            count, row = reader.header.point_count, reader.header.point_format.size
            if count > most_points:
                raise MeshFileError(f"{count} points are more than the limit of {most_points}", where="LAS header")
            if not reader.header.are_points_compressed and count * row > len(data):
                raise MeshFileError(
                    f"truncated: {count} points of {row} bytes stated, {len(data)} bytes there", where="LAS header"
                )
            if reader.header.are_points_compressed:
                _check_chunks(data, reader.header.offset_to_point_data, count)
            record = reader.read_points(count)
            with np.errstate(all="ignore"):  # the caller refuses points that are not finite
                points = np.column_stack([np.asarray(record[axis], dtype=np.float64) for axis in "xyz"])
    except (MeshFileError, MemoryError):
        raise
    except BaseException as error:  # the parser fails in many ways; a panic of lazrs is not an Exception
        if not isinstance(error, Exception) and type(error).__name__ != _PANIC:
            raise
        reason = str(error) or type(error).__name__
        raise MeshFileError(f"damaged or truncated: {reason[:200]}", where="LAS content") from error
    if len(points) != count:
        raise MeshFileError(f"truncated: {count} points stated, {len(points)} there", where="LAS content")
    return points


def _check_chunks(data: bytes, start: int, points: int) -> None:
    """Refuse a chunk table with more chunks than points: lazrs allocates the whole table before it reads it.

    The compressed points begin with the offset of the table, or with -1 if the last eight bytes hold it.

    Raises:
        MeshFileError: the table has more chunks than points.
    """
    place = int.from_bytes(data[start : start + 8], "little", signed=True)
    if place == -1:
        place = int.from_bytes(data[-8:], "little", signed=True)
    chunks = int.from_bytes(data[place + 4 : place + 8], "little") if place >= 0 else 0
    if chunks > points:
        raise MeshFileError(f"{chunks} chunks stated for {points} points", where="LAZ content")
