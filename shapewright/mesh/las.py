"""A reader of LAS and LAZ scans, through laspy."""

from io import BytesIO
from typing import Final

import numpy as np

from shapewright.errors import MeshFileError

_RECORD_COUNT: Final = slice(100, 104)
"""Bytes of a header that hold the number of the records between it and the points (LAS 1.0 to 1.5)."""
_LEAST_RECORD: Final = 54
"""Bytes of a record without content."""
_PANIC: Final = "PanicException"
"""What a library in Rust raises where it meets something that its authors held to be impossible; it has no module."""


def read_las(data: bytes, most_points: int) -> np.ndarray:
    """Return the positions in a LAS or LAZ file, (N, 3) float64, with its offset and scale applied.

    Raises:
        MeshFileError: damaged or truncated content, or more points than wanted.
    """
    import laspy

    # laspy goes on reading records behind the end of a file
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
            with np.errstate(all="ignore"):  # who takes the points looks whether they are finite
                points = np.column_stack([np.asarray(record[axis], dtype=np.float64) for axis in "xyz"])
    except (MeshFileError, MemoryError):
        raise
    except BaseException as error:  # whatever a parser meets in a stranger's bytes; a panic of lazrs is no Exception
        if not isinstance(error, Exception) and type(error).__name__ != _PANIC:
            raise
        reason = str(error) or type(error).__name__
        raise MeshFileError(f"damaged or truncated: {reason[:200]}", where="LAS content") from error
    if len(points) != count:
        raise MeshFileError(f"truncated: {count} points stated, {len(points)} there", where="LAS content")
    return points


def _check_chunks(data: bytes, start: int, points: int) -> None:
    """Refuse a table of more chunks than there are points: room for all of it is taken before it is read.

    The compressed points begin with the place of the table, or with -1 if that is in the last eight bytes.

    Raises:
        MeshFileError: it is refused.
    """
    place = int.from_bytes(data[start : start + 8], "little", signed=True)
    if place == -1:
        place = int.from_bytes(data[-8:], "little", signed=True)
    chunks = int.from_bytes(data[place + 4 : place + 8], "little") if place >= 0 else 0
    if chunks > points:
        raise MeshFileError(f"{chunks} chunks stated for {points} points", where="LAZ content")
