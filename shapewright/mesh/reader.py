"""Reading files of strangers: in child processes that can open nothing and are limited in memory and time."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np

from shapewright.errors import MeshError, MeshFileError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.decode import ReadLimits

_WHERE = "reader process"


class MeshReader:
    """Reads many files, each in a child process of its own.

    The children are forked from a process that has imported what reading takes, started with the first file: one
    more file costs milliseconds beyond its reading. Threads may share a reader; what they read at the same time is
    read by as many processes. Close it, or use it in a ``with`` statement.

    Args:
        kept: processes that wait for the next file.
    """

    def __init__(self, kept: int = 1) -> None:
        self._kept = kept
        self._idle: list[_Process] = []
        self._lock = threading.Lock()

    def __enter__(self) -> "MeshReader":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def prepare(self) -> None:
        """Start a process for the next file, unless one waits; it imports what reading takes in its own time."""
        with self._lock:
            if len(self._idle) < min(self._kept, 1):
                self._idle.append(_Process())

    def close(self) -> None:
        """End the processes that wait; reading one more file starts a new one."""
        with self._lock:
            idle, self._idle = self._idle, []
        for process in idle:
            process.end()

    def parse(self, data: bytes, file_type: str, limits: ReadLimits) -> TriangleMesh | PointCloud:
        """Read checked content of a normalised type; see :func:`shapewright.mesh.file.parse_query`.

        Raises:
            MeshFileError: as :func:`shapewright.mesh.decode.decode_query`, or the child ran out of memory or time.
        """
        request = {"file_type": file_type, "limits": vars(limits)}
        process = self._waiting()
        try:
            try:
                status, output = process.ask(request, data, limits.wall_s)
            except ReaderLostError:  # whatever befell it while it waited is not this file's fault
                process.end()
                process = _Process()
                status, output = process.ask(request, data, limits.wall_s)
        except BaseException:
            process.end()
            raise
        self._put_back(process, trusted=status == 0)
        return _query_of(status, output, limits)

    def _waiting(self) -> "_Process":
        with self._lock:
            return self._idle.pop() if self._idle else _Process()

    def _put_back(self, process: "_Process", *, trusted: bool) -> None:
        """Keep a process for the next file, unless its last child broke: who tries to break one gets a fresh one."""
        with self._lock:
            keep = trusted and len(self._idle) < self._kept
            if keep:
                self._idle.append(process)
        if not keep:
            process.end()


class ReaderLostError(MeshFileError):
    """The process that reads files is gone."""


class _Process:
    """A running :mod:`shapewright.mesh.reader_process`, for one file at a time."""

    def __init__(self) -> None:
        # the environment is made anew: no secrets of ours, and one thread, as each reserves address space
        environment = {
            "PATH": os.defpath,
            "PYTHONPATH": str(Path(__file__).resolve().parents[2]),
            "OPENBLAS_NUM_THREADS": "1",
            "OMP_NUM_THREADS": "1",
            "MKL_NUM_THREADS": "1",
        }
        self._popen = subprocess.Popen(
            [sys.executable, "-P", "-s", "-B", "-m", "shapewright.mesh.reader_process"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
            cwd="/",
            process_group=0,  # so that it can be ended together with its child
        )

    def ask(self, request: dict[str, Any], data: bytes, timeout_s: float) -> tuple[int, bytes]:
        """The status of the child that read this file, and what it wrote.

        Raises:
            ReaderLostError: the process is gone.
            MeshFileError: it took too long; the process is of no more use.
        """
        late = threading.Event()

        def give_up() -> None:
            late.set()
            self._kill()

        assert self._popen.stdin is not None
        assert self._popen.stdout is not None
        timer = threading.Timer(timeout_s, give_up)
        timer.daemon = True
        timer.start()
        try:
            self._popen.stdin.write(json.dumps(request | {"size": len(data)}).encode() + b"\n")
            self._popen.stdin.write(data)
            self._popen.stdin.flush()
            header = json.loads(self._popen.stdout.readline())
            output = self._popen.stdout.read(header["size"])
            if len(output) < header["size"]:
                raise EOFError
        except (OSError, ValueError, EOFError):
            if not late.is_set():
                raise ReaderLostError("the reader is gone", where=_WHERE) from None
        finally:
            timer.cancel()
            timer.join()
        if late.is_set():  # perhaps just in time, but nobody is there for the next file
            raise MeshFileError(f"reading took more than {timeout_s:g} s", where=_WHERE)
        return header["status"], output

    def end(self) -> None:
        """End it, whatever it does."""
        self._kill()
        for pipe in (self._popen.stdin, self._popen.stdout):
            with contextlib.suppress(OSError):  # what is left to be written goes nowhere
                pipe.close()  # type: ignore[union-attr]
        self._popen.wait()

    def _kill(self) -> None:
        if self._popen.returncode is None:  # unless it was waited for, its number and its group are still its own
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._popen.pid, signal.SIGKILL)


def _query_of(status: int, output: bytes, limits: ReadLimits) -> TriangleMesh | PointCloud:
    if status == -signal.SIGXCPU:
        raise MeshFileError(f"reading took more than {limits.cpu_s} s of processor time", where=_WHERE)
    if status != 0:
        raise MeshFileError(
            f"the reader broke off with status {status}; {limits.memory_bytes} bytes of memory may not be enough",
            where=_WHERE,
        )
    header, _, body = output.partition(b"\n")
    try:
        answer = json.loads(header)
        if "error" in answer:
            raise MeshFileError(str(answer["error"]), where=answer["where"])
        if answer["vertices"] > limits.vertices or answer["faces"] > limits.faces:
            raise ValueError("more than it may answer")
        split = int(answer["vertices"]) * 24
        vertices = np.frombuffer(body[:split], dtype=np.float64).reshape(-1, 3)
        faces = np.frombuffer(body[split:], dtype=np.int64).reshape(-1, 3)
        if answer["faces"] == 0:
            return PointCloud(vertices.copy())
        return TriangleMesh(vertices.copy(), faces.copy())
    except MeshFileError:
        raise
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError, MeshError):
        raise MeshFileError("the reader gave no sensible answer", where=_WHERE) from None
