"""Waiting for events: the limit is there to end a test that hangs, and no slow machine comes near it."""

import time
from collections.abc import Callable
from typing import Final, TypeVar

PATIENCE_S: Final = 600.0
"""Seconds until something that happens without fail is given up. The limit of a whole test is in pyproject.toml."""
T = TypeVar("T")


def wait_until(found: Callable[[], T], otherwise: Callable[[], str] = lambda: "it does not happen") -> T:
    """Return the first true value; ``otherwise`` tells what went wrong if none comes."""
    deadline = time.monotonic() + PATIENCE_S
    while not (value := found()):
        assert time.monotonic() < deadline, otherwise()
        time.sleep(0.02)
    return value
