"""Independent tasks in several child processes, in bounded memory, with a progress that can cancel."""

import multiprocessing
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from typing import Final, TypeVar

BEAT_S: Final = 0.5
"""Seconds after which ``beat`` is called again while nothing is finished."""

Task = TypeVar("Task")
Outcome = TypeVar("Outcome")


def in_processes(
    tasks: Iterator[tuple[int, Task]],
    work: Callable[[Task], Outcome],
    *,
    jobs: int,
    begin: Callable[[], None],
    beat: Callable[[], None],
) -> Iterator[tuple[int, Outcome]]:
    """Yield the number and the outcome of each task as soon as it is finished, in any order.

    At most two tasks for each process wait at once; ``tasks`` is asked for more as others finish. Each process computes
    with one thread: several would only stand in the way of the other processes.

    Args:
        tasks: numbers and tasks; picklable.
        work: what is done to a task; picklable, such as a function of a module.
        jobs: processes. They are started afresh: a fork of a process with threads can hang.
        begin: called in each process before its first task; picklable.
        beat: called here again and again while they work; what it raises ends the work.

    Raises:
        Exception: what ``work`` or ``beat`` raises; tasks that have not begun are dropped.
    """
    pool = ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"), initializer=_begin, initargs=(begin,))
    pending: dict[Future[Outcome], int] = {}

    def finished() -> Iterator[tuple[int, Outcome]]:
        done, _ = wait(pending, timeout=BEAT_S, return_when=FIRST_COMPLETED)
        beat()
        for future in done:
            yield pending.pop(future), future.result()

    try:
        for number, task in tasks:
            pending[pool.submit(work, task)] = number
            while len(pending) >= 2 * jobs:
                yield from finished()
        while pending:
            yield from finished()
    finally:
        pool.shutdown(cancel_futures=True)


def _begin(begin: Callable[[], None]) -> None:
    import numba

    numba.set_num_threads(1)
    begin()
