"""A reader of point clouds as text: XYZ, PTS, ASC, CSV, TXT and whatever else has a point on each line."""

from typing import Final

import numpy as np

from shapewright.errors import MeshFileError

_COMMENTS: Final = (b"#", b"//")
_AXES: Final = (b"x", b"y", b"z")


def read_rows(data: bytes) -> np.ndarray:
    """Return the positions in lines of three or more numbers, (N, 3) float64.

    Numbers are separated by blanks, tabs, commas or semicolons. The first three are the position, unless a line of
    names above them says where x, y and z are. Further columns are ignored, and so are comments (``#``, ``//``).
    A line with nothing but a whole number, as PTS files begin with, states how many points follow.

    Raises:
        MeshFileError: a line of fewer numbers, a coordinate that is not a number, another number of points than
            stated; ``where`` is the line.
    """
    points: list[list[float]] = []
    columns = [0, 1, 2]
    stated: int | None = None
    named = False
    number = 0
    for number, line in enumerate(data.removeprefix(b"\xef\xbb\xbf").splitlines(), 1):
        words = _words(line)
        if not words:
            continue
        if len(words) == 1 and words[0].isdigit():
            stated = (stated or 0) + int(words[0][:12])
            continue
        try:
            points.append([float(words[column]) for column in columns])
        except (ValueError, IndexError):
            if points or named or _are_numbers(words):
                raise MeshFileError(_reason(words, max(columns) + 1), where=f"line {number}") from None
            named = True
            columns = _named_columns(words) or columns
    if stated is not None and stated != len(points):
        raise MeshFileError(f"{stated} points stated, {len(points)} there", where=f"line {number}")
    return np.array(points, dtype=np.float64).reshape(-1, 3)


def is_rows(head: bytes) -> bool:
    """Tell whether text looks like lines of numbers: one of the first lines that are no comments is."""
    lines = (words for line in head.removeprefix(b"\xef\xbb\xbf").splitlines() if (words := _words(line)))
    return any(len(words) >= 3 and _are_numbers(words[:3]) for words, _ in zip(lines, range(4), strict=False))


def _words(line: bytes) -> list[bytes]:
    """Split a line at the separator that it has; one kind a line, so a decimal comma is noticed."""
    for comment in _COMMENTS:
        line = line.split(comment, 1)[0]
    line = line.strip()
    for separator in (b";", b","):
        if separator in line:
            return [word.strip() for word in line.split(separator)]
    return line.split()


def _are_numbers(words: list[bytes]) -> bool:
    try:
        return all(float(word) is not None for word in words)
    except ValueError:
        return False


def _named_columns(words: list[bytes]) -> list[int] | None:
    names = [word.strip(b"\"'").lower() for word in words]
    return [names.index(axis) for axis in _AXES] if all(names.count(axis) == 1 for axis in _AXES) else None


def _reason(words: list[bytes], least: int) -> str:
    if len(words) < least:
        return f"expected at least {least} numbers, got {len(words)}"
    return "a coordinate is not a number (separate numbers by blanks, commas or semicolons, with decimal points)"
