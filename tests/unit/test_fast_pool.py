"""The threads of a search: results in order, errors and cancellations reach the caller, tasks stop."""

import threading

import pytest

from shapewright.errors import Cancelled
from shapewright.estimation.fast.pool import Pool, Stopped


def nothing() -> None:
    pass


def test_results_are_in_the_order_of_the_items():
    second_is_done = threading.Event()

    def work(item: int) -> int:
        if item == 0:
            second_is_done.wait(0.2)  # with one thread it never comes
        if item == 1:
            second_is_done.set()
        return 10 * item

    with Pool(nothing) as pool:
        assert pool.map(work, range(6)) == [0, 10, 20, 30, 40, 50]
        assert pool.map(work, []) == []


def test_an_error_in_a_task_reaches_the_caller():
    def work(item: int) -> int:
        if item == 3:
            raise ValueError("item 3")
        return item

    with Pool(nothing) as pool, pytest.raises(ValueError, match="item 3"):
        pool.map(work, range(5))


def test_when_the_caller_cancels_running_tasks_end_and_waiting_ones_are_dropped():
    begun, ended = [], []
    running = threading.Event()

    def ask() -> None:
        if running.is_set():
            raise Cancelled

    with Pool(ask) as pool:

        def work(item: int) -> None:
            begun.append(item)
            running.set()
            try:
                while True:
                    pool.check()
                    threading.Event().wait(0.001)
            except Stopped:
                ended.append(item)
                raise

        with pytest.raises(Cancelled):
            pool.map(work, range(500))
        assert sorted(ended) == sorted(begun)  # none runs on when map has raised
        assert len(begun) < 500
        with pytest.raises(Stopped):
            pool.check()


def test_the_caller_is_asked_in_its_own_thread_before_anything_is_waited_for():
    asked = []
    with Pool(lambda: asked.append(threading.current_thread())) as pool:
        pool.map(lambda item: item, [1])
    assert asked
    assert set(asked) == {threading.current_thread()}
