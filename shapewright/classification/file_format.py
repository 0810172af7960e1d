"""What the writer and the readers of a classifier's file share: its names, and how its metadata is found."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from shapewright.errors import ClassifierError

FORMAT = "shapewright-classifier"
FORMAT_VERSION = 4
"""Raise it when files written before are read no longer, or would answer otherwise."""
METADATA_KEY = "shapewright"

# ONNX files are protocol buffers: fields with a number and a wire type.
_MODEL_PROPERTIES: Final = 14
_PROPERTY_KEY: Final = 1
_PROPERTY_VALUE: Final = 2
_VARINT, _FIXED_64, _BYTES, _FIXED_32 = 0, 1, 2, 5


def exemplars_file(onnx: Path) -> Path:
    """Return where the exemplars of a classifier's file lie: beside it."""
    return onnx.with_suffix(".exemplars.npz")


def read_metadata(onnx: bytes) -> dict[str, Any]:
    """Return the metadata of a classifier's file, without loading its network; NaN becomes ``None``.

    Raises:
        ClassifierError: the file is damaged, is not one of ours, or has another version.
    """
    try:
        properties = [dict(_fields(value)) for number, value in _fields(onnx) if number == _MODEL_PROPERTIES]
        texts = {bytes(one[_PROPERTY_KEY]).decode(): bytes(one[_PROPERTY_VALUE]) for one in properties}
        metadata = json.loads(texts[METADATA_KEY], parse_constant=lambda _: None)
        version = (metadata["format"], metadata["version"])
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise ClassifierError(f"not a file of a classifier, or damaged: {error!r}", where="metadata") from error
    if version != (FORMAT, FORMAT_VERSION):
        raise ClassifierError(f"expected {FORMAT} version {FORMAT_VERSION}, got {version}", where="metadata")
    return dict(metadata)


def _fields(message: bytes | memoryview) -> Iterator[tuple[int, memoryview]]:
    """Walk through the fields of a protocol buffer that hold bytes; the others are passed over."""
    view, place = memoryview(message), 0
    while place < len(view):
        tag, place = _varint(view, place)
        wire_type = tag & 7
        if wire_type == _VARINT:
            _, place = _varint(view, place)
        elif wire_type in (_FIXED_32, _FIXED_64):
            place += 4 if wire_type == _FIXED_32 else 8
        elif wire_type == _BYTES:
            length, place = _varint(view, place)
            if place + length > len(view):
                raise ValueError("the file ends in the middle of a field")
            yield tag >> 3, view[place : place + length]
            place += length
        else:
            raise ValueError(f"wire type {wire_type} is not known")


def _varint(view: memoryview, place: int) -> tuple[int, int]:
    """Return a number of variable length, and the place after it."""
    value = shift = 0
    while True:
        byte = view[place]
        place += 1
        value |= (byte & 0x7F) << shift
        if not byte & 0x80:
            return value, place
        shift += 7
