"""The version of stored panorama descriptors, and the check that refuses what another version wrote.

Descriptors of two versions have the same size and mean different things. A file that people keep (a bank, exemplars, an
index) names the version in its header, and :func:`read_descriptor_header` refuses another one. A cache names it in its
keys, by :func:`descriptor_version`, so it finds nothing of another version and computes it again. No other module looks
at the version.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from shapewright.distances.panorama import VERSION
from shapewright.mapped_arrays import read_header

FIRST_VERSION = 1
"""The version of the descriptors in files that do not name one; they were written before a second one was possible."""


class OutdatedFileError(ValueError):
    """A file that was written by another version of the format or of the descriptor."""


def descriptor_version() -> int:
    """Return the version of the descriptors that this library computes, for keys of what depends on them."""
    return VERSION


def descriptor_header(file_format: str, version: int, rest: Mapping[str, Any]) -> dict[str, Any]:
    """Make the header of a file that holds descriptors.

    Args:
        file_format: name of the format.
        version: of the format.
        rest: what else the file says about itself.
    """
    return {"format": file_format, "version": version, "descriptor_version": descriptor_version(), **rest}


def read_descriptor_header(path: str | Path, file_format: str, version: int) -> dict[str, Any]:
    """Read the header of a file that holds descriptors, and check it.

    Raises:
        OutdatedFileError: it is of another version of the format or of the descriptor.
        ValueError: it is damaged or of another format.
        OSError: it cannot be opened.
    """
    header = read_header(path)
    if header.get("format") != file_format:
        raise ValueError(f"expected the format {file_format!r}, got {header.get('format')!r}")
    if header.get("version") != version:
        raise OutdatedFileError(
            f"the file is of version {header.get('version')!r} of its format, this library reads {version}"
        )
    found, expected = header.get("descriptor_version", FIRST_VERSION), descriptor_version()
    if found != expected:
        raise OutdatedFileError(
            f"the file was made by another version of the descriptor ({found!r}, not {expected}); make it anew"
        )
    return header
