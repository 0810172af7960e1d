"""The one OpenGL context of a process: headless on EGL, made on first use, current only while it draws."""

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import moderngl

from shapewright.errors import RenderingError

REQUIRED_OPENGL = 430
"""Indirect draws with one command an object need OpenGL 4.3; Mesa's software renderer has 4.5."""

DEBIAN_PACKAGES = ("libegl1", "libegl-mesa0", "libgl1", "libgl1-mesa-dri", "libgles2")
"""What ``apt-get install`` has to bring for headless drawing."""

_BACKEND: dict[str, Any] = {"backend": "egl", "libgl": "libGL.so.1", "libegl": "libEGL.so.1"}


class _Holder:
    """What this process knows of its context; ``owner_pid`` tells a forked child from its parent."""

    def __init__(self) -> None:
        self.lock = threading.RLock()
        self.context: Any = None  # a moderngl.Context; its own type hints are incomplete
        self.owner_pid: int | None = None
        self.depth = 0


_holder = _Holder()


def _renew_lock_in_child() -> None:
    # Another thread of the parent may have held the lock at the moment of the fork.
    _holder.lock = threading.RLock()
    _holder.depth = 0


os.register_at_fork(after_in_child=_renew_lock_in_child)


def _create_context() -> Any:
    try:
        return moderngl.create_standalone_context(require=REQUIRED_OPENGL, **_BACKEND)
    except Exception as error:  # moderngl and glcontext raise bare Exception
        raise RenderingError(
            f"headless OpenGL {REQUIRED_OPENGL / 100:.1f} is not available ({error}); on Debian or Ubuntu: "
            f"apt-get install {' '.join(DEBIAN_PACKAGES)}"
        ) from error


@contextmanager
def shared_context() -> Iterator[Any]:
    """Lend this process's :class:`moderngl.Context` to the calling thread, current until the block ends.

    The first call makes the context; importing this module does not. Threads take turns.

    Raises:
        RenderingError: EGL or OpenGL 4.3 is missing, or the process was forked from one that had already
            opened its context (the driver's threads do not survive a fork, drawing would hang).
    """
    if _holder.owner_pid is not None and _holder.owner_pid != os.getpid():
        raise RenderingError(
            f"process {os.getpid()} was forked from process {_holder.owner_pid} after that one had opened "
            "OpenGL; start processes that draw with 'spawn', or do not draw before the fork"
        )
    with _holder.lock:
        if _holder.context is None:
            _holder.owner_pid = os.getpid()
            try:
                _holder.context = _create_context()
            except BaseException:
                _holder.owner_pid = None
                raise
        context = _holder.context
        if _holder.depth == 0:
            context.__enter__()
        _holder.depth += 1
        try:
            yield context
        finally:
            _holder.depth -= 1
            if _holder.depth == 0:
                context.__exit__(None, None, None)


def context_is_open() -> bool:
    """Whether this process has opened its context; forking is safe for drawing children until then."""
    return _holder.context is not None and _holder.owner_pid == os.getpid()


def renderer_name() -> str:
    """What draws, e.g. ``llvmpipe (LLVM 15.0.6, 256 bits)``; goes into benchmarks and records.

    Raises:
        RenderingError: as :func:`shared_context`.
    """
    with shared_context() as context:
        return str(context.info["GL_RENDERER"])
