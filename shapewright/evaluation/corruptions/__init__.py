"""Corruptions: what scanning, sharing and converting do to a mesh, so that evaluations can measure what they cost."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.evaluation.corruptions.decimated import DECIMATED
from shapewright.evaluation.corruptions.half import HALF
from shapewright.evaluation.corruptions.holes import HOLES
from shapewright.evaluation.corruptions.noise import NOISE

CORRUPTIONS: Final[Mapping[str, Corruption]] = MappingProxyType(
    {corruption.name: corruption for corruption in (NOISE, HOLES, DECIMATED, HALF)}
)
"""Every corruption by its name."""

__all__ = ["CORRUPTIONS", "Corruption"]
