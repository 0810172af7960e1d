"""A reader of LAS and LAZ scans, through laspy."""

from io import BytesIO

import numpy as np

from shapewright.errors import MeshFileError


def read_las(data: bytes, most_points: int) -> np.ndarray:
    """Return the positions in a LAS or LAZ file, (N, 3) float64, with its offset and scale applied.

    Raises:
        MeshFileError: damaged or truncated content, or more points than wanted.
    """
    import laspy

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
            record = reader.read_points(count)
            points = np.column_stack([np.asarray(record[axis], dtype=np.float64) for axis in "xyz"])
    except (MeshFileError, MemoryError):
        raise
    except Exception as error:  # whatever a parser meets in a stranger's bytes
        reason = str(error) or type(error).__name__
        raise MeshFileError(f"damaged or truncated: {reason[:200]}", where="LAS content") from error
    if len(points) != count:
        raise MeshFileError(f"truncated: {count} points stated, {len(points)} there", where="LAS content")
    return points
