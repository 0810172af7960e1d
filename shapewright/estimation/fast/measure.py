"""The z-buffer distance of a candidate."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import FINE
from shapewright.estimation.fast.target import Target


def drawn(candidate: Candidate) -> tuple[Float[np.ndarray, "V 3"], Int[np.ndarray, "F 3"]]:
    """Return the placed surface with the fewest triangles that depth images may be taken of."""
    model = candidate.model
    points = candidate.placed(model.outline.points(model.control_points(candidate.values)))
    return points, model.outline_triangles


def outline_distance(target: Target, candidate: Candidate) -> Candidate:
    """Return the candidate with its z-buffer distance, measured on that surface."""
    return replace(candidate, zbuffer=target.zbuffer_distance(*drawn(candidate)))


def fine_distance(target: Target, candidate: Candidate) -> Candidate:
    """Return the candidate with the z-buffer distance of its fine surface, which the answer is judged by."""
    model = candidate.model
    points = candidate.placed(model.surfaces[FINE].points(model.control_points(candidate.values)))
    return replace(candidate, zbuffer=target.zbuffer_distance(points, model.triangles[FINE]))
