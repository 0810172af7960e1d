"""The last fit of an answer: by surfaces alone, where the model follows the query (ours).

Depth images decide between answers where a model cannot follow its query. Where it can, they mislead: noise makes thin
parts thicker and outlines wider, holes show what lies behind them, and a fit with the smallest z-buffer distance takes
that for the shape. Distances along the normals average such errors out.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.deviation import candidate_deviation, mutual_deviation
from shapewright.estimation.fast.fitted_model import FINE
from shapewright.estimation.fast.least_squares import Effort, fit
from shapewright.estimation.fast.measure import fine_distance
from shapewright.estimation.fast.target import Target

FOLLOWED: Final = 0.004
"""Systematic residual, in half extents, below which a model follows a query."""
SCATTERED: Final = 0.45
"""Share of the mean residual that is systematic, below which residuals are noise of the query: it is 0.25 where each of
16 neighbors is off on its own, 0.36 in fits to instances with noise, 0.6 and more in fits to real meshes."""
ROUGHLY: Final = 0.01
"""Z-buffer distances that differ by less do not decide between two fits whose surfaces are compared."""
_MOST_DEPTH: Final = (1.25, 0.03)
"""A fit whose z-buffer distance is larger than this factor times the former one, and this more, has lost its query."""
_SURFACES: Final = Effort(rounds=12, points=2000, steps=FINE, damping=1e-4)


def follow_surface(
    target: Target, candidate: Candidate, *, keeps_scale: bool = False, keeps_rotation: bool = False
) -> Candidate:
    """Fit an answer once more by surfaces alone.

    Args:
        target: the query.
        candidate: the answer, with the z-buffer distance of its fine surface.
        keeps_scale: whether the scale of the pose stays.
        keeps_rotation: whether its rotation stays.

    Returns:
        The new fit, with its z-buffer distance, if its surface is nearer and its depth images hardly farther, or if no
        residual is left but noise; else the answer as it was.
    """
    found = fit(
        target, replace(candidate, zbuffer=np.inf), _SURFACES, keeps_scale=keeps_scale, keeps_rotation=keeps_rotation
    )
    found = fine_distance(target, found)
    if found.zbuffer <= candidate.zbuffer + ROUGHLY:
        return found if _distance(target, found) < _distance(target, candidate) else candidate
    factor, more = _MOST_DEPTH
    if found.zbuffer > factor * candidate.zbuffer + more:
        return candidate
    left = candidate_deviation(target, found)
    follows = left is not None and left.systematic < min(FOLLOWED, SCATTERED * left.mean)
    return found if follows else candidate


def _distance(target: Target, candidate: Candidate) -> float:
    measured = mutual_deviation(target, candidate)
    return np.inf if measured is None else sum(measured)
