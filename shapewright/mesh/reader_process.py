"""The process behind :class:`shapewright.mesh.reader.MeshReader`: ``python -m shapewright.mesh.reader_process``.

It has imported what reading takes, looks at no content itself, and forks a child for each file. The child limits
itself, can open no file and no connection, as no further descriptor is allowed, finds nothing of other files in its
memory, and cannot look into this process. In: one line of JSON, then the
file. Out: one line of JSON with the child's status, then what the child wrote: one line of JSON, then the arrays.
"""

import ctypes
import importlib
import json
import os
import resource
import signal
import sys
import traceback
from typing import Any, BinaryIO, Final

from shapewright.errors import MeshFileError
from shapewright.mesh import PointCloud, decode

_LONGEST_HEADER: Final = 1 << 16
_TRIMESH: Final = (
    "trimesh", "trimesh.exchange.gltf", "trimesh.exchange.ply", "trimesh.visual.material", "PIL.Image"
)  # fmt: skip
_LASPY: Final = ("laspy", "lazrs")
_IMPORTED: Final = {"ply": _TRIMESH, "glb": _TRIMESH, "gltf": _TRIMESH, "las": _LASPY, "laz": _LASPY}
"""Modules that reading a type takes, and what they import only while reading."""
_PR_SET_DUMPABLE: Final = 4


def main() -> None:
    """Answer requests from stdin on stdout, until there are no more."""
    _keep_others_out()
    source, sink = sys.stdin.buffer, sys.stdout.buffer
    while line := source.readline():
        request = json.loads(line)
        data = source.read(request["size"])
        for name in _IMPORTED.get(request["file_type"], ()):  # now, as a child can open no module
            importlib.import_module(name)
        status, output = _in_child(request["file_type"], request["limits"], data)
        sink.write(json.dumps({"status": status, "size": len(output)}).encode() + b"\n")
        sink.write(output)
        sink.flush()
        del line, request, data, output


def _in_child(file_type: str, limits: dict[str, Any], data: bytes) -> tuple[int, bytes]:
    """What a child wrote that was given this file, and its status: negative for the signal that ended it."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            for descriptor in (0, 1, reading):  # what belongs to other files
                os.close(descriptor)
            with os.fdopen(writing, "wb") as sink:
                _answer(file_type, limits, data, sink)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as source:
        most = _LONGEST_HEADER + 24 * (limits["vertices"] + limits["faces"])
        output = source.read(most + 1)
        if len(output) > most:  # no mesh within the limits
            os.kill(child, signal.SIGKILL)
            output = b""
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), output


def _answer(file_type: str, limits: dict[str, Any], data: bytes, sink: BinaryIO) -> None:
    _limit(resource.RLIMIT_AS, limits["memory_bytes"])
    _limit(resource.RLIMIT_CPU, limits["cpu_s"], spare=1)  # a second between the signal and the kill
    for kind in (resource.RLIMIT_CORE, resource.RLIMIT_FSIZE, resource.RLIMIT_NOFILE, resource.RLIMIT_NPROC):
        _limit(kind, 0)
    try:
        answer, body = _parse(file_type, limits, data)
    except MemoryError:
        reason = f"reading needs more than {limits['memory_bytes']} bytes of memory"
        answer, body = {"error": reason, "where": "reader process"}, []
    sink.write(json.dumps(answer).encode() + b"\n")
    for part in body:
        sink.write(part)


def _parse(file_type: str, limits: dict[str, Any], data: bytes) -> tuple[dict[str, object], list[bytes]]:
    try:
        query = decode.decode_query(data, file_type, decode.ReadLimits(**limits))
    except MeshFileError as error:
        return {"error": error.message, "where": error.where}, []
    if isinstance(query, PointCloud):
        return {"vertices": len(query.points), "faces": 0}, [query.points.tobytes()]
    return {"vertices": len(query.vertices), "faces": len(query.faces)}, [
        query.vertices.tobytes(),
        query.faces.tobytes(),
    ]


def _keep_others_out() -> None:
    """Let no process of the same user read this one's memory or change it (Linux)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_DUMPABLE, 0)


def _limit(kind: int, value: float, spare: int = 0) -> None:
    _, most = resource.getrlimit(kind)
    hard = int(value) + spare
    if most != resource.RLIM_INFINITY:
        hard = min(hard, most)
    resource.setrlimit(kind, (min(int(value), hard), hard))


if __name__ == "__main__":
    main()
