"""Bytes of what saves itself to a file only, on their way into the artefact store."""

import tempfile
from collections.abc import Callable
from pathlib import Path


def saved_bytes(save: Callable[[Path], None]) -> bytes:
    """Return what ``save`` writes to the path that it is given.

    Raises:
        OSError: there is no room for the file.
    """
    with tempfile.TemporaryDirectory(prefix="shapewright-artefact-") as folder:
        path = Path(folder) / "artefact.npz"
        save(path)
        return path.read_bytes()
