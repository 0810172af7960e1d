"""How a worker's children learn that it is about to stop."""

import mmap
import struct
import time
from typing import Final

_DEADLINE: Final = struct.Struct("d")


class WorkerStopping(Exception):  # noqa: N818 - a planned stop, not an error
    """The worker stops; the job goes back to the queue."""


class GivingWay(Exception):  # noqa: N818 - no error either
    """Other work is wanted more; the job goes back to the queue."""


class StopNotice:
    """A deadline in memory that a process shares with the children it forks.

    A plain shared value, because a lock (as in ``multiprocessing.Event``) would stay locked for ever when a
    child is killed inside it. ``time.monotonic`` is one clock for all processes of a machine.
    """

    def __init__(self) -> None:
        self._memory = mmap.mmap(-1, _DEADLINE.size)

    def announce(self, grace_s: float) -> None:
        """Tell that work must end within ``grace_s``; only the first call counts."""
        if not self._read():
            _DEADLINE.pack_into(self._memory, 0, time.monotonic() + grace_s)

    @property
    def is_due(self) -> bool:
        """Whether the time is over."""
        deadline = self._read()
        return deadline > 0 and time.monotonic() >= deadline

    def _read(self) -> float:
        return float(_DEADLINE.unpack_from(self._memory, 0)[0])
