"""Arrays of a training as artefacts, so that the next training finds them, whichever worker takes it."""

import io
from pathlib import Path
from typing import Any, Self

import numpy as np
import structlog

from models_store.artifacts import ArtifactStore
from models_store.errors import ArtifactError, ArtifactNotFoundError
from shapewright.training.array_store import mapped_array, npy_bytes
from workers.context import JobContext

log = structlog.get_logger(__name__)


class ArtifactArrays:
    """Keeps arrays in the artefact store (:class:`shapewright.training.ArrayStore`).

    What finds no room there stays in memory for as long as the object lives: a full disk costs the next training
    time, but this one nothing.

    Args:
        artifacts: the keys of the arrays are keys of artefacts.
        cache: where copies lie that are mapped into memory, if the artefacts are no local files.
    """

    def __init__(self, artifacts: ArtifactStore, cache: Path) -> None:
        self._artifacts = artifacts
        self._cache = cache
        self._unsaved: dict[str, np.ndarray] = {}

    @classmethod
    def of(cls, context: JobContext) -> Self:
        """The arrays of the installation that a job belongs to."""
        return cls(context.artifacts, context.settings.data_dir / "cache")

    def get(self, key: str) -> np.ndarray | None:
        """The array, mapped into memory if its file can be; ``None`` if there is none or it is damaged.

        Raises:
            ArtifactError: the store does not answer.
        """
        if key in self._unsaved:
            return self._unsaved[key]
        try:
            path = self._artifacts.local_copy(key, self._cache)
        except ArtifactNotFoundError:
            return None
        except ArtifactError as error:  # no room for a copy, most of all
            log.warning("stored array has no local copy, it is read into memory", key=key, error=str(error))
            return _read(self._artifacts.get(key))
        array = mapped_array(path)
        if array is None:
            log.warning("stored array is damaged, it is computed anew", key=key)
            (self._cache / key).unlink(missing_ok=True)  # a copy must not outlive what is put in its place
        return array

    def put(self, key: str, array: np.ndarray) -> None:
        """Keep an array in the artefact store, or in memory if that fails."""
        try:
            self._artifacts.put(key, npy_bytes(array))
        except ArtifactError as error:
            log.warning("array could not be stored, it is kept in memory", key=key, error=str(error))
            self._unsaved[key] = array


def _read(content: bytes) -> np.ndarray | None:
    try:
        array: Any = np.load(io.BytesIO(content), allow_pickle=False)
    except (ValueError, EOFError):
        return None
    return array if isinstance(array, np.ndarray) else None
