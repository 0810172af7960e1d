"""Corruptions: what scanning, sharing and converting do to a mesh, so that evaluations can measure what they cost."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from shapewright.evaluation.corruptions.closed import CLOSED
from shapewright.evaluation.corruptions.clustered import CLUSTERED
from shapewright.evaluation.corruptions.corruption import Corruption
from shapewright.evaluation.corruptions.decimated import DECIMATED
from shapewright.evaluation.corruptions.dust import DUST
from shapewright.evaluation.corruptions.flipped import FLIPPED
from shapewright.evaluation.corruptions.ground import GROUND
from shapewright.evaluation.corruptions.half import HALF
from shapewright.evaluation.corruptions.holes import HOLES
from shapewright.evaluation.corruptions.noise import NOISE
from shapewright.evaluation.corruptions.outliers import OUTLIERS
from shapewright.evaluation.corruptions.points import POINTS
from shapewright.evaluation.corruptions.stitched import STITCHED
from shapewright.evaluation.corruptions.uneven import UNEVEN
from shapewright.evaluation.corruptions.voxels import VOXELS

_ALL: Final = (
    NOISE,
    HOLES,
    DECIMATED,
    HALF,
    FLIPPED,
    CLUSTERED,
    OUTLIERS,
    DUST,
    GROUND,
    STITCHED,
    CLOSED,
    VOXELS,
    UNEVEN,
    POINTS,
)

CORRUPTIONS: Final[Mapping[str, Corruption]] = MappingProxyType({corruption.name: corruption for corruption in _ALL})
"""Every corruption by its name."""

__all__ = ["CORRUPTIONS", "Corruption"]
