"""Writing a file completely or not at all, so that a full disk leaves nothing half done behind."""

import os
from pathlib import Path


def write_whole(path: str | Path, data: bytes) -> None:
    """Write beside the target first, then put it in its place; what was there before stays until then.

    Args:
        path: the target; a link is followed.
        data: the whole content.

    Raises:
        OSError: the file cannot be written; its ``filename`` is the target.
    """
    target = Path(os.path.realpath(path))
    partial = target.with_name(f".{target.name}.{os.getpid()}.partial")
    try:
        partial.write_bytes(data)
        partial.replace(target)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None
    finally:
        partial.unlink(missing_ok=True)
