"""An estimator that knows nothing and takes no time: every answer is the base of a model, as large as the query."""

from collections.abc import Sequence

import numpy as np

from shapewright.distances.alignment import Pose
from shapewright.errors import MeshError
from shapewright.estimation import Distances, Estimation, EstimationSettings, ParameterEstimate, Query, Stage
from shapewright.modeling import CompiledModel


def parameters_of(model: CompiledModel, values: np.ndarray) -> tuple[ParameterEstimate, ...]:
    """The parameters at these values, without a verdict."""
    active = model.space.active(values[None])[0]
    return tuple(
        ParameterEstimate(p.name, p.label, p.unit, float(x), p.base_value, p.minimum, p.maximum, bool(on))
        for p, x, on in zip(model.model.parameters, values, active, strict=True)
    )


def base_answer(query: Query, models: Sequence[CompiledModel], settings: EstimationSettings) -> Estimation:
    """The base of the first model; the z-buffer distance is a number that depends on the mesh.

    Raises:
        MeshError: the mesh has fewer than four faces.
    """
    if len(query.mesh.faces) < 4:
        raise MeshError("too few faces")
    model = models[0]
    values = model.base_values()
    instance = model.instance(values)
    low, high = query.mesh.bounds
    length = float(np.linalg.norm(np.ptp(instance.bounds, axis=0)))
    pose = Pose(np.eye(3), 0.5 * (low + high), float(np.linalg.norm(high - low)) / length)
    normalized = query.mesh.normalized().mesh
    distances = Distances(0.1, 0.02, float(np.abs(normalized.vertices).mean()), 100.0)
    first = Stage("panorama", values, pose, Distances(0.1, 0.06, 1.0, 1.0))
    return Estimation(
        estimator=settings.estimator,
        model=model.model,
        layer=3,
        values=values,
        parameters=parameters_of(model, values),
        pose=pose,
        distances=distances,
        stages=(first, Stage("zbuffer", values, pose, distances)),
        mesh=instance.transformed(pose.rotation, pose.translation, pose.scale),
    )
