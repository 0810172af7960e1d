"""Artefacts: bytes under keys, in a folder, in memory or in an S3-compatible store.

An artefact is there as a whole or not at all: a write goes to a new file (or upload) that takes its name at the
end, and one that fails leaves nothing behind.
"""

import re
import shutil
import tempfile
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote, urlsplit

import obstore
from obstore.exceptions import BaseError, NotFoundError
from obstore.store import LocalStore, MemoryStore, ObjectStore, from_url

from models_store.errors import ArtifactError, ArtifactNotFoundError

if TYPE_CHECKING:
    from obstore.store import RetryConfig

_KEY: Final = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*(/[A-Za-z0-9_-][A-Za-z0-9_.-]*)*")
_RETRY: "Final[RetryConfig]" = {"max_retries": 4, "retry_timeout": timedelta(seconds=30)}
_NO_SPACE: Final = ("No space left", "StorageFull", "os error 28", "os error 122", "os error 27", "QuotaExceeded")


class ArtifactStore:
    """Puts and gets artefacts. Keys look like ``meshes/<id>/source.off``: names of letters, digits, ``_-.``"""

    def __init__(self, store: ObjectStore, folder: Path | None = None) -> None:
        """Use an obstore store; ``folder`` is where its files lie if it is a local folder."""
        self._store = store
        self._folder = folder

    @classmethod
    def open(cls, url: str) -> "ArtifactStore":
        """Open the store behind a folder's path or a ``file://``, ``memory://`` or ``s3://`` address.

        The folder is created. An S3 store is not contacted yet; its keys, region and endpoint come from the
        ``AWS_*`` environment variables.

        Raises:
            ArtifactError: the address makes no sense, or the folder cannot be created.
        """
        scheme = urlsplit(url).scheme
        try:
            if scheme == "memory":
                return cls(MemoryStore())
            if scheme in ("", "file"):
                folder = Path(unquote(urlsplit(url).path) if scheme else url).absolute()
                folder.mkdir(parents=True, exist_ok=True)
                return cls(LocalStore(folder), folder)
            return cls(from_url(url, retry_config=_RETRY))
        except (BaseError, OSError, ValueError) as error:
            raise ArtifactError(f"cannot open the artefact store {url!r}: {error}") from error

    def put(self, key: str, data: bytes) -> None:
        """Write an artefact, in place of an older one.

        Raises:
            ArtifactError: the disk is full, or the store refuses; the older artefact is still there.
        """
        try:
            # One request instead of parts: as one put it is atomic and cleans up on every kind of store.
            obstore.put(self._store, _checked(key), data, use_multipart=False)
        except (BaseError, OSError) as error:
            raise _translated("write", key, error) from error

    def get(self, key: str) -> bytes:
        """Read an artefact.

        Raises:
            ArtifactNotFoundError: there is none under this key.
            ArtifactError: the store does not answer.
        """
        try:
            return bytes(obstore.get(self._store, _checked(key)).bytes())
        except (BaseError, OSError) as error:
            raise _translated("read", key, error) from error

    def exists(self, key: str) -> bool:
        """Whether there is an artefact under this key.

        Raises:
            ArtifactError: the store does not answer.
        """
        try:
            obstore.head(self._store, _checked(key))
        except (FileNotFoundError, NotFoundError):
            return False
        except (BaseError, OSError) as error:
            raise _translated("look for", key, error) from error
        return True

    def delete(self, key: str) -> None:
        """Remove an artefact; one that is not there is no error.

        Raises:
            ArtifactError: the store refuses.
        """
        try:
            obstore.delete(self._store, _checked(key))
        except (FileNotFoundError, NotFoundError):
            return
        except (BaseError, OSError) as error:
            raise _translated("delete", key, error) from error

    def local_copy(self, key: str, cache: Path) -> Path:
        """A file with the artefact's bytes, to be memory-mapped and not to be changed.

        In a local folder it is the artefact itself; otherwise it is fetched into ``cache`` once. Keys that are
        given to this are written once and never changed.

        Raises:
            ArtifactNotFoundError: there is none under this key.
            ArtifactError: it cannot be read, or there is no room for the copy.
        """
        if self._folder is not None:
            path = self._folder / _checked(key)
            if not path.is_file():
                raise ArtifactNotFoundError(f"there is no artefact {key}")
            return path
        path = cache / _checked(key)
        if path.is_file():
            return path
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
                partial = Path(scratch) / path.name
                with partial.open("wb") as out:
                    for chunk in obstore.get(self._store, key).stream():
                        out.write(chunk)
                partial.replace(path)
        except (BaseError, OSError) as error:
            raise _translated("read", key, error) from error
        return path

    def check(self) -> None:
        """Ask the store for a sign of life.

        Raises:
            ArtifactError: it does not answer, or its folder is gone.
        """
        if self._folder is not None and not self._folder.is_dir():
            raise ArtifactError("the artefact folder is gone")
        self.exists("sign-of-life")

    def free_bytes(self) -> int | None:
        """Free space of a local folder, in bytes; ``None`` for other stores."""
        return None if self._folder is None else shutil.disk_usage(self._folder).free


def _checked(key: str) -> str:
    if not _KEY.fullmatch(key):
        raise ArtifactError(f"not a key of an artefact: {key!r}")
    return key


def _translated(verb: str, key: str, error: Exception) -> ArtifactError:
    if isinstance(error, FileNotFoundError | NotFoundError) and verb != "write":
        return ArtifactNotFoundError(f"there is no artefact {key}")
    if any(sign in str(error) for sign in _NO_SPACE):
        return ArtifactError("there is no space left to store this (the disk is full)")
    return ArtifactError(f"cannot {verb} the artefact {key}: {str(error).splitlines()[0]}")
