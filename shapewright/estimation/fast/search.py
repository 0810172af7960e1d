"""The search of the fast estimator, from many starts to one polished answer."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.estimation.fast.branches import other_choices
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import COARSE, FINE, FittedModel
from shapewright.estimation.fast.least_squares import Effort, fit
from shapewright.estimation.fast.polish import Polish, fine_distance, outline_distance
from shapewright.estimation.fast.pool import Pool
from shapewright.estimation.fast.starts import find_starts, spread
from shapewright.estimation.fast.target import Target

INSTANCES: Final = 48
"""Random instances of each model that are scored."""
STARTS, STARTS_OF_EACH = 16, 3
"""Candidates that least squares begin with: the best of all, and of each model."""

_COARSE: Final = Effort(rounds=5, points=400, steps=COARSE, neighbors=1, width=0.2, damping=1e-2, pull=1e-6)
_MEDIUM: Final = Effort(rounds=8, points=1000, steps=FINE)
_GLANCE: Final = Effort(rounds=3, points=400, steps=COARSE, neighbors=4, width=0.05, pull=1e-7)
_DENSE: Final = Effort(rounds=8, points=2000, steps=FINE, damping=1e-4)

_GAIN: Final = 1e-4
"""Smallest fall of the z-buffer distance for which another option is taken."""


@dataclass(frozen=True)
class Known:
    """What is known of the pose from model to normalized query space.

    Attributes:
        scale: of the pose; ``None`` if it is free.
        rotations: (R, 3, 3), the only ones to begin with; ``None`` for all.
        keeps_rotation: whether the rotation is exact.
    """

    scale: float | None = None
    rotations: Float[np.ndarray, "R 3 3"] | None = None
    keeps_rotation: bool = False


@dataclass(eq=False)
class Search:
    """One search over one query; ``best`` is kept at any moment.

    Attributes:
        target: the query.
        known: of the pose.
        found: every candidate that was measured at the end of a stage, for alternatives.
    """

    target: Target
    known: Known
    found: list[Candidate] = field(default_factory=list)
    by_stage: dict[str, Candidate] = field(default_factory=dict)
