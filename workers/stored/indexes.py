"""Indexes of collections as artefacts."""

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from workers.context import JobContext
from workers.stored.saving import saved_bytes

if TYPE_CHECKING:
    from shapewright.retrieval import CollectionIndex


def load_index(context: JobContext, key: str) -> "CollectionIndex":
    """Map an index that is written once into memory.

    Raises:
        ClassifierError: it is damaged.
        ArtifactError: it cannot be read, or is not there.
    """
    from shapewright.retrieval import CollectionIndex

    return CollectionIndex.load(context.artifacts.local_copy(key, context.settings.data_dir / "cache"))


def load_changing_index(context: JobContext, key: str) -> "CollectionIndex":
    """Read an index that is written again and again.

    Raises:
        ClassifierError: it is damaged.
        ArtifactError: it cannot be read, or is not there.
    """
    from shapewright.retrieval import CollectionIndex

    with tempfile.TemporaryDirectory(prefix="shapewright-index-") as folder:
        path = Path(folder) / "index.npz"
        path.write_bytes(context.artifacts.get(key))
        return CollectionIndex.load(path, memory_map=False)


def store_index(context: JobContext, key: str, index: "CollectionIndex") -> None:
    """Write an index.

    Raises:
        ArtifactError: there is no room for it.
    """
    context.artifacts.put(key, saved_bytes(index.save))
