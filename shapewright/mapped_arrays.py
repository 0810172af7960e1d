"""Arrays in one ``.npz`` file, each placed so that it can be mapped into memory unless the file is compressed.

numpy reads such a file like any other; its first member, ``header``, is a JSON document that says what it holds.
"""

import io
import json
import os
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

_ALIGNMENT: Final = 64
_HEADER: Final = "header"


def write_arrays(
    path: str | Path, header: Mapping[str, Any], arrays: Mapping[str, np.ndarray], *, compressed: bool = False
) -> None:
    """Write a header and arrays, completely or not at all; the data of each begin at a multiple of 64 bytes.

    Args:
        path: the file.
        header: JSON values.
        arrays: by name.
        compressed: for files that are small rather than quick to open; their arrays cannot be mapped into memory.

    Raises:
        OSError: the file cannot be written.
    """
    target = Path(path)
    text = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    partial = target.with_name(f"{target.name}.partial{os.getpid()}")
    try:
        method = zipfile.ZIP_DEFLATED if compressed else zipfile.ZIP_STORED
        with zipfile.ZipFile(partial, "w", method, allowZip64=True, compresslevel=9) as archive:
            for name, array in {_HEADER: text, **arrays}.items():
                _write_aligned(archive, f"{name}.npy", array)
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)


def read_header(path: str | Path) -> dict[str, Any]:
    """Read what a file says about itself.

    Raises:
        ValueError: the file has no header or is damaged.
        OSError: the file cannot be opened.
    """
    source = Path(path)
    try:
        with zipfile.ZipFile(source) as archive:
            header = json.loads(_read_array(archive, source, f"{_HEADER}.npy", memory_map=False).tobytes())
    except _DAMAGE as error:
        raise ValueError(_reason(error)) from error
    if not isinstance(header, dict):
        raise ValueError("its header is no object")
    return header


def read_arrays(path: str | Path, names: Sequence[str], *, memory_map: bool = True) -> list[Any]:
    """Read the named arrays; with ``memory_map`` they stay in the file, read-only, and are read when used.

    Raises:
        ValueError: one is missing, or the file is damaged.
        OSError: the file cannot be opened.
    """
    source = Path(path)
    try:
        with zipfile.ZipFile(source) as archive:
            return [_read_array(archive, source, f"{name}.npy", memory_map=memory_map) for name in names]
    except _DAMAGE as error:
        raise ValueError(_reason(error)) from error


_DAMAGE: Final = (zipfile.BadZipFile, zlib.error, KeyError, ValueError, TypeError, EOFError)


def _reason(error: Exception) -> str:
    return str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)


def _write_aligned(archive: zipfile.ZipFile, name: str, array: Any) -> None:
    """Store an array so that its data begin at a multiple of 64 bytes of the file (padding in the extra field)."""
    buffer = io.BytesIO()
    np.lib.format.write_array_header_1_0(buffer, np.lib.format.header_data_from_array_1_0(np.ascontiguousarray(array)))
    npy_header = buffer.getvalue()
    info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
    # 30 bytes of local header and the name precede the extra field; force_zip64 adds its own 20 bytes
    begin = archive.fp.tell() + 30 + len(name) + 20 + 4 + len(npy_header)  # type: ignore[union-attr]
    padding = -begin % _ALIGNMENT
    info.compress_type = archive.compression
    info.extra = b"\x57\x53" + padding.to_bytes(2, "little") + bytes(padding)
    with archive.open(info, "w", force_zip64=True) as member:
        member.write(npy_header)
        member.write(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)


def _read_array(archive: zipfile.ZipFile, path: Path, name: str, *, memory_map: bool) -> Any:
    if not memory_map:
        with archive.open(name) as member:
            return np.lib.format.read_array(member, allow_pickle=False)
    info = archive.getinfo(name)
    if info.compress_type != zipfile.ZIP_STORED:
        raise ValueError("its arrays are compressed")
    with path.open("rb") as file:
        file.seek(info.header_offset + 26)
        name_length = int.from_bytes(file.read(2), "little")
        extra_length = int.from_bytes(file.read(2), "little")
        file.seek(info.header_offset + 30 + name_length + extra_length)
        version = np.lib.format.read_magic(file)
        if version != (1, 0):
            raise ValueError("its arrays are of an unknown version")
        shape, fortran_order, dtype = np.lib.format.read_array_header_1_0(file)
        if fortran_order or dtype.hasobject:
            raise ValueError("its arrays are of an unknown kind")
        if file.tell() + dtype.itemsize * int(np.prod(shape)) > path.stat().st_size:
            raise ValueError("it is truncated")
        if 0 in shape:  # a model without parameters; an empty range cannot be mapped
            return np.empty(shape, dtype)
        return np.memmap(path, dtype, "r", file.tell(), shape)
