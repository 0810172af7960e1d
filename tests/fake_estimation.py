"""A stand-in for the estimators: it compares extents, which takes milliseconds."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from shapewright.distances.alignment import Pose
from shapewright.estimation import Distances, Estimation, EstimationSettings, InstanceGenerator, Query
from shapewright.estimation.record import parameter_estimates
from shapewright.mesh import TriangleMesh
from shapewright.progress import NULL_PROGRESS, Progress


def estimate_by_extent(
    query: Query,
    models: Sequence[InstanceGenerator],
    settings: EstimationSettings | None = None,
    *,
    progress: Progress = NULL_PROGRESS,
    banks: Any = None,
) -> Estimation:
    """Find the first parameter of the first model from the proportions of an upright mesh."""
    progress.report(0.5, "comparing extents")
    compiled = models[0]
    asked = _size(query.mesh)
    tried = []
    for x in np.linspace(compiled.space.parameters[0].minimum, compiled.space.parameters[0].maximum, 16):
        values = np.ones(len(compiled.space.parameters))
        values[0] = x
        size = _size(compiled.instance(values, 0))
        tried.append(
            (float(np.abs(size / size.max() - asked / asked.max()).sum()), tuple(values), asked.max() / size.max())
        )
    distance, found, scale = min(tried)
    values, pose = np.array(found), Pose(scale=float(scale))
    instance = compiled.instance(values, 0)
    return Estimation(
        estimator="by extent",
        model=compiled.model,
        layer=3,
        values=values,
        parameters=parameter_estimates(compiled, values, query),
        pose=pose,
        distances=Distances(1.0, 0.01, distance, 1.0),
        stages=(),
        mesh=TriangleMesh(pose.apply(instance.vertices), instance.faces),
    )


def _size(mesh: TriangleMesh) -> Any:
    return np.ptp(mesh.vertices, axis=0)
