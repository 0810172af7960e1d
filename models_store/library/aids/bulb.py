"""Modelling aid for rounded bodies: the sections of a bulb, for a loft."""

import math

from models_store.library.aids.loft import Section


def bulb(
    length: float, width: float, height: float, *, start: float, count: int = 6, peak: float = 1.0
) -> list[Section]:
    """Return the sections of a rounded body; a ``peak`` above 1 moves the widest place towards the start."""
    angles = [math.radians(18.0 + 144.0 * i / (count - 1)) for i in range(count)]
    lowest, highest = 1 - math.cos(angles[0]), 1 - math.cos(angles[-1])
    shares = [(1 - math.cos(angle) - lowest) / (highest - lowest) for angle in angles]
    return [
        Section(start + length * share**peak, width * math.sin(angle), height * math.sin(angle))
        for share, angle in zip(shares, angles, strict=True)
    ]
