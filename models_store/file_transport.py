"""The embedded broker: a kombu transport that keeps messages as files in a folder.

kombu's own ``filesystem`` transport writes a message in place, so that a reader can see half of it, and keeps
its bindings in shared files without locking their creation. Here a message becomes visible by one rename, the
reader that removes the file owns the message, and there are no bindings: a routing key is a queue.
"""

import contextlib
import json
import logging
import os
import re
import time
from pathlib import Path
from queue import Empty
from typing import Any, Final
from uuid import uuid4

from kombu.transport import TRANSPORT_ALIASES, virtual

log = logging.getLogger(__name__)

SCHEME: Final = "shapewright-folder"
POLLING_INTERVAL_S: Final = 0.05
_LONGEST_WAIT_S: Final = 0.5
_QUEUE_NAME: Final = re.compile(r"[A-Za-z0-9@_-][A-Za-z0-9@._-]*")


def register() -> None:
    """Let kombu know the scheme; doing it again changes nothing."""
    TRANSPORT_ALIASES[SCHEME] = f"{__name__}:Transport"


class Channel(virtual.Channel):
    """Queues are sub-folders of ``transport_options["folder"]``; a message is a file, named by its time."""

    def _folder(self, queue: str) -> Path:
        if not _QUEUE_NAME.fullmatch(queue):
            raise ValueError(f"not the name of a queue: {queue!r}")
        return Path(self.connection.client.transport_options["folder"]) / queue

    def _new_queue(self, queue: str, **_: Any) -> None:
        self._folder(queue).mkdir(parents=True, exist_ok=True)

    def _has_queue(self, queue: str, **_: Any) -> bool:
        return self._folder(queue).is_dir()

    def _put(self, queue: str, message: dict[str, Any], **_: Any) -> None:
        folder = self._folder(queue)
        folder.mkdir(parents=True, exist_ok=True)
        name = f"{time.time_ns():020d}-{uuid4().hex}"
        partial = folder / f"{name}.partial"
        try:
            partial.write_text(json.dumps(message))
            partial.rename(folder / f"{name}.message")
        except BaseException:
            with contextlib.suppress(OSError):
                partial.unlink(missing_ok=True)
            raise

    def _messages(self, queue: str) -> list[Path]:
        folder = self._folder(queue)
        try:
            names = sorted(name for name in os.listdir(folder) if name.endswith(".message"))  # noqa: PTH208
        except FileNotFoundError:  # swept away under us: the same as empty
            return []
        return [folder / name for name in names]

    def _get(self, queue: str, timeout: float | None = None) -> dict[str, Any]:
        for path in self._messages(queue):
            try:
                content = path.read_bytes()
                path.unlink()
            except FileNotFoundError:  # another reader has it
                continue
            try:
                message: dict[str, Any] = json.loads(content)
            except ValueError:
                log.warning("dropped a damaged message: %s", path.name)
                continue
            return message
        raise Empty

    def _size(self, queue: str) -> int:
        return len(self._messages(queue))

    def _purge(self, queue: str) -> int:
        messages = self._messages(queue)
        for path in messages:
            path.unlink(missing_ok=True)
        return len(messages)


class Transport(virtual.Transport):
    """Polls the folder; one listing each time, so an idle worker costs next to nothing."""

    Channel = Channel
    driver_type = "folder"
    driver_name = "shapewright-folder"
    polling_interval = POLLING_INTERVAL_S
    connection_errors: tuple[Any, ...] = (*virtual.Transport.connection_errors, OSError)
    implements = virtual.Transport.implements.extend(asynchronous=False, exchange_type=frozenset({"direct"}))

    def drain_events(self, connection: Any, timeout: Any = None) -> Any:  # type: ignore[override]
        """Wait for one message, but never so long that a worker is slow to notice that it shall stop."""
        timeout = min(timeout or _LONGEST_WAIT_S, _LONGEST_WAIT_S)
        return super().drain_events(connection, timeout=timeout)  # type: ignore[no-untyped-call]

    def driver_version(self) -> str:
        """There is no driver."""
        return "N/A"
