"""What a worker process loads before its first estimation, so that the job need not wait for it."""

import threading
from importlib import import_module
from typing import Final

import structlog

log = structlog.get_logger(__name__)

_MODULES: Final = ("shapewright.estimation.fast.warm_up", "shapewright.estimation.residual_views")
"""What an estimation job imports, directly or through these."""


def load_estimation() -> threading.Thread:
    """Import what an estimation needs, and load its compiled kernels in a thread.

    Imports come first and in the calling thread: two threads that import modules of one package at the same time can
    see each other's half-made modules. A job that arrives while kernels are loaded runs beside the thread.

    Returns:
        The thread, which is started.
    """
    for module in _MODULES:
        import_module(module)

    def load() -> None:
        from shapewright.estimation.fast.warm_up import load_kernels

        try:
            loaded = load_kernels()
        except Exception:
            log.exception("loading compiled kernels failed; the first estimation loads them")
            return
        log.debug("compiled kernels loaded" if loaded else "kernels not compiled yet; the first estimation does it")

    thread = threading.Thread(target=load, name="warm-up", daemon=True)
    thread.start()
    return thread
