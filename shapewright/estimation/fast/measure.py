"""The z-buffer distance of a candidate."""

from dataclasses import replace

import numpy as np

from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import FINE
from shapewright.estimation.fast.target import Target


def outline_distance(target: Target, candidate: Candidate) -> Candidate:
    """Return the candidate with its z-buffer distance, measured on the surface with the fewest triangles."""
    model = candidate.model
    control = model.control_points(candidate.values)
    points = np.ascontiguousarray(candidate.placed(model.outline @ control))
    return replace(candidate, zbuffer=target.zbuffer_distance(points, model.outline_triangles))


def fine_distance(target: Target, candidate: Candidate) -> Candidate:
    """Return the candidate with the z-buffer distance of its fine surface, which the answer is judged by."""
    model = candidate.model
    control = model.control_points(candidate.values)
    points = np.ascontiguousarray(candidate.placed(model.matrices[FINE] @ control))
    return replace(candidate, zbuffer=target.zbuffer_distance(points, model.triangles[FINE]))
