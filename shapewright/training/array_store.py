"""Where arrays are kept that cost minutes to compute: in memory, or in a folder and mapped into memory when read.

A key says everything that the array depends on, so a store never has to forget: what changed has another key.
"""

import io
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from shapewright.whole_file import write_whole


@runtime_checkable
class ArrayStore(Protocol):
    """Keeps arrays under keys such as ``features/<what>/0-12.npy``; several processes may share one."""

    def get(self, key: str) -> np.ndarray | None:
        """The array, mapped into memory where that is possible; ``None`` if it is not there or damaged."""
        ...

    def put(self, key: str, array: np.ndarray) -> None:
        """Keep an array, whole or not at all."""
        ...


class MemoryStore:
    """Keeps arrays as long as the object lives."""

    def __init__(self) -> None:
        self._arrays: dict[str, np.ndarray] = {}

    def get(self, key: str) -> np.ndarray | None:
        """The array that was put."""
        return self._arrays.get(key)

    def put(self, key: str, array: np.ndarray) -> None:
        """Keep the array itself."""
        self._arrays[key] = array


class FolderStore:
    """Keeps arrays as ``.npy`` files in a folder that is made when first written to."""

    def __init__(self, folder: str | Path) -> None:
        self._folder = Path(folder)

    def get(self, key: str) -> np.ndarray | None:
        """Map the file."""
        return mapped_array(self._folder / key)

    def put(self, key: str, array: np.ndarray) -> None:
        """Write the file.

        Raises:
            OSError: there is no room, or the folder cannot be written.
        """
        path = self._folder / key
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, npy_bytes(array))


def mapped_array(path: Path) -> np.ndarray | None:
    """An ``.npy`` file as a read-only map; ``None`` if there is none or it is damaged."""
    try:
        array: Any = np.load(path, mmap_mode="r", allow_pickle=False)
    except Exception:  # a broken header makes numpy raise almost anything, and all of it means damage
        return None
    return array if isinstance(array, np.ndarray) else None


def npy_bytes(array: np.ndarray) -> bytes:
    """An array as the content of an ``.npy`` file."""
    buffer = io.BytesIO()
    np.save(buffer, array, allow_pickle=False)
    return buffer.getvalue()
