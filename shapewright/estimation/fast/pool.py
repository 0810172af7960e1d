"""Threads that share the candidates of one search, and stop soon after the caller wants to stop."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import TypeVar

import numba

Item = TypeVar("Item")
Result = TypeVar("Result")

_LOOK_EVERY_S = 0.05


class Stopped(Exception):  # noqa: N818 - a signal between the threads of a search, not an error
    """Raised inside a task whose search was cancelled."""


class Pool:
    """Runs the tasks of one search on all processors; the kernels release the interpreter's lock.

    Whoever lets compiled kernels use fewer threads (``numba.set_num_threads``) has fewer here, too.

    While tasks run, the calling thread keeps asking its caller whether to go on. When the caller raises, the running
    tasks are told through :meth:`check`, and waiting ones are dropped.
    """

    def __init__(self, ask: Callable[[], None]) -> None:
        self._ask = ask
        self._stopping = False
        self._executor = ThreadPoolExecutor(_processors(), thread_name_prefix="fast-estimation")

    def __enter__(self) -> "Pool":
        return self

    def __exit__(self, *_: object) -> None:
        self._stopping = True
        self._executor.shutdown(wait=True, cancel_futures=True)

    def check(self) -> None:
        """Raise ``Stopped`` if the search was cancelled; tasks call it between steps of some milliseconds."""
        if self._stopping:
            raise Stopped

    def map(self, work: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
        """Do the work for each item; results are in the order of the items.

        Raises:
            Cancelled: the caller wants to stop; tasks that were running have ended by then.
        """
        futures: list[Future[Result]] = [self._executor.submit(work, item) for item in items]
        pending: set[Future[Result]] = set(futures)
        try:
            while pending:
                self._ask()
                pending = wait(pending, timeout=_LOOK_EVERY_S, return_when=FIRST_COMPLETED).not_done
        except BaseException:
            self._stopping = True
            for future in futures:
                future.cancel()
            wait(futures)
            raise
        return [future.result() for future in futures]


def _processors() -> int:
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(available, numba.get_num_threads())
