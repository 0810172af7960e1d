"""Reading mesh files: trusted ones here, strangers' ones in a child process with limits.

Types: OBJ, OFF, PLY, STL, GLB and self-contained glTF. Everything in a file becomes one mesh. What is dropped
is listed at :meth:`shapewright.mesh.TriangleMesh.cleaned`; what is refused, at the functions here. No link to a
file or an address is followed: an OBJ's material library is not looked at, a glTF with external parts is
refused. A truncated file is noticed wherever the type states its counts; an OBJ does not, so one that ends
between two faces reads as a smaller mesh.
"""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np

from shapewright.errors import MeshError, MeshFileError
from shapewright.mesh import TriangleMesh
from shapewright.mesh_decode import ReadLimits, decode_mesh
from shapewright.mesh_sniff import check_content, normalized_type

__all__ = ["DEFAULT_LIMITS", "ReadLimits", "load_mesh", "parse_mesh"]

DEFAULT_LIMITS = ReadLimits()


def load_mesh(path: str | Path, *, limits: ReadLimits = DEFAULT_LIMITS, in_child: bool = False) -> TriangleMesh:
    """Read a file; its type is the ending of its name.

    Args:
        path: the file.
        limits: what the file may cost; memory and time are only limited in a child.
        in_child: for a file that you do not trust: parse it in a child process, as :func:`parse_mesh` does.

    Raises:
        MeshFileError: the file cannot be opened, is over a limit of size or counts, is not what its name
            says, is damaged, or holds no usable surface.
    """
    where = ascii(str(path))
    try:
        file_type = normalized_type(Path(path).suffix)
        with Path(path).open("rb") as file:
            data = file.read(limits.size_bytes + 1)
        _check_size(data, limits)
        check_content(data, file_type)
        return parse_mesh(data, file_type, limits=limits) if in_child else decode_mesh(data, file_type, limits)
    except MeshError as error:
        place = f"{where}: {error.where}" if error.where else where
        raise MeshFileError(error.message, where=place) from None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise MeshFileError(f"cannot be read: {reason}", where=where) from None


def parse_mesh(data: bytes, file_type: str, *, limits: ReadLimits = DEFAULT_LIMITS) -> TriangleMesh:
    """Read bytes from a stranger, in a child process that can open nothing and is limited in memory and time.

    Args:
        data: the whole file.
        file_type: ``"obj"``, ``".OBJ"`` and the like; held against the content.
        limits: what the file may cost.

    Raises:
        MeshFileError: as :func:`load_mesh`, or the child ran out of memory or time.
    """
    file_type = normalized_type(file_type)
    _check_size(data, limits)
    check_content(data, file_type)
    request = {"file_type": file_type, "limits": vars(limits)}
    output = _run_child(json.dumps(request).encode() + b"\n" + data, limits)
    header, _, body = output.partition(b"\n")
    try:
        answer = json.loads(header)
        if "error" in answer:
            raise MeshFileError(str(answer["error"]), where=answer["where"])
        split = int(answer["vertices"]) * 24
        vertices = np.frombuffer(body[:split], dtype=np.float64).reshape(-1, 3)
        faces = np.frombuffer(body[split:], dtype=np.int64).reshape(-1, 3)
        return TriangleMesh(vertices.copy(), faces.copy())
    except MeshFileError:
        raise
    except (ValueError, KeyError, TypeError, MeshError):
        raise MeshFileError("the reader gave no sensible answer", where="reader process") from None


def _check_size(data: bytes, limits: ReadLimits) -> None:
    if len(data) > limits.size_bytes:
        raise MeshFileError(
            f"the file is larger than the limit of {limits.size_bytes} bytes",
            where=f"byte {limits.size_bytes}",
        )


def _run_child(request: bytes, limits: ReadLimits) -> bytes:
    package_root = str(Path(__file__).resolve().parents[1])
    # the environment is made anew: no secrets of ours, and one thread, as each reserves address space
    environment = {
        "PATH": os.defpath,
        "PYTHONPATH": package_root,
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
        "MKL_NUM_THREADS": "1",
    }
    command = [sys.executable, "-P", "-s", "-B", "-m", "shapewright.mesh_file_child"]
    with subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=environment,
        cwd="/",
    ) as child:
        try:
            output, _ = child.communicate(request, timeout=limits.wall_s)
        except subprocess.TimeoutExpired:
            raise MeshFileError(f"reading took more than {limits.wall_s:g} s", where="reader process") from None
        finally:
            child.kill()
    if child.returncode == -signal.SIGXCPU:
        raise MeshFileError(f"reading took more than {limits.cpu_s} s of processor time", where="reader process")
    if child.returncode != 0:
        raise MeshFileError(
            f"the reader broke off with status {child.returncode}; {limits.memory_bytes} bytes of memory may not"
            " be enough",
            where="reader process",
        )
    return output
