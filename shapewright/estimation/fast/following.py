"""The last fit of an answer: by surfaces alone, where the model follows the query (ours).

Depth images decide between answers where a model cannot follow its query. Where it can, they mislead: noise makes thin
parts thicker and outlines wider, holes show what lies behind them, and a fit with the smallest z-buffer distance takes
that for the shape. Distances along the normals average such errors out.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.deviation import candidate_deviation
from shapewright.estimation.fast.fitted_model import FINE
from shapewright.estimation.fast.least_squares import Effort, fit
from shapewright.estimation.fast.measure import fine_distance
from shapewright.estimation.fast.target import Target

FOLLOWED: Final = 0.004
"""Systematic residual, in half extents, below which a model follows a query."""
SCATTERED: Final = 0.45
"""Share of the mean residual that is systematic, below which residuals are noise of the query: it is 0.25 where each of
16 neighbors is off on its own, 0.36 in fits to instances with noise, 0.6 and more in fits to real meshes."""
_SURFACES: Final = Effort(rounds=6, points=2000, steps=FINE, damping=1e-4)
_FITS: Final = 2
"""A fit ends as soon as samples come no nearer to each other; the values still do in a second one."""


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
        The new fit, with its z-buffer distance, if that is no larger or if what is left of its residuals is noise; else
        the answer as it was.
    """
    found = replace(candidate, zbuffer=np.inf)
    for _ in range(_FITS):
        found = fit(target, found, _SURFACES, keeps_scale=keeps_scale, keeps_rotation=keeps_rotation)
    found = fine_distance(target, found)
    if found.zbuffer <= candidate.zbuffer:
        return found
    left = candidate_deviation(target, found)
    is_noise = left is not None and left.systematic < min(FOLLOWED, SCATTERED * left.mean)
    return found if is_noise else candidate
