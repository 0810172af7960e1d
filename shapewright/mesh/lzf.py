"""LZF decompression, as in compressed PCD files (Marc Lehmann's LibLZF)."""

from typing import Final

LARGEST_GAIN: Final = 264 / 3
"""Bytes of output that one byte of input can stand for at most: three bytes repeat 264 earlier ones."""
_LITERALS_BELOW: Final = 32
_LONG_COPY: Final = 7


def decompress_lzf(data: bytes, size: int) -> bytes:
    """Return the original bytes.

    Args:
        data: the compressed bytes, all of them.
        size: of the result. Memory is taken as the result grows, never more than about this much.

    Raises:
        ValueError: the data ends in the middle, refers to bytes before its beginning, or is of another size.
    """
    output = bytearray()
    place, end = 0, len(data)
    while place < end:
        control = data[place]
        place += 1
        if control < _LITERALS_BELOW:
            run = data[place : place + control + 1]
            if len(run) <= control:
                raise ValueError("the compressed data ends in the middle")
            output += run
            place += control + 1
        else:
            length = control >> 5
            if place + (length == _LONG_COPY) >= end:
                raise ValueError("the compressed data ends in the middle")
            if length == _LONG_COPY:
                length += data[place]
                place += 1
            distance = ((control & 31) << 8 | data[place]) + 1
            place += 1
            _repeat(output, distance, length + 2)
        if len(output) > size:
            break
    if len(output) != size:
        raise ValueError(f"the compressed data is not of the {size} bytes that are stated")
    return bytes(output)


def _repeat(output: bytearray, distance: int, length: int) -> None:
    """Append bytes that were written before; those that overlap with the new ones repeat."""
    start = len(output) - distance
    if start < 0:
        raise ValueError("the compressed data refers to bytes before its beginning")
    if distance >= length:
        output += output[start : start + length]
    else:
        piece = bytes(output[start:])
        output += (piece * (length // distance + 1))[:length]
