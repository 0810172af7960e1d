"""How an answer compares with what a synthetic query was made of.

*What counts.* A parameter is compared only where that makes sense: the model is right, the parameter is active in the
truth, and every option that decides whether it is active is right. What an error means is a share of the parameter's
whole range. Values are compared as they are, in both modes; where the scale of the pose is free a model that grows and
a pose that shrinks are the same, so there single lengths are expected to be off, and ratios are what to look at.

*When a pose is right.* Where the model is right: its rotation is within :data:`ROTATION_DEG` of the true one, or of the
true one after a rotation that the model declares to leave its instances as they are (a product of its mirrors and turns
that is a rotation), or the turn between the two leaves the true instance where it is: a stool of three legs has a
symmetry that other stools have not, and a goblet of twelve sides is round. And the posed instance lies where the true
one does: the centers of their bounding boxes, along the axes of the true pose, are within :data:`PLACE` of the true
box's diagonal, and so are their diagonals. Shift and scale themselves are not compared, since a model that grows takes
them with it.
"""

from dataclasses import dataclass
from itertools import combinations
from typing import Final

import numpy as np
from jaxtyping import Bool, Float

from shapewright.distances.alignment import Pose
from shapewright.distances.rasterize import prepared
from shapewright.distances.triangles import TriangleDistance
from shapewright.estimation.result import ParameterStatus, Ratio
from shapewright.estimation.sampling_kernels import sample_surface
from shapewright.evaluation.estimated import Answer
from shapewright.evaluation.synthetic import Truth
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel, Symmetry, Turn
from shapewright.modeling.elements import Mirror

ROTATION_DEG: Final = 10.0
PLACE: Final = 0.05
CLOSE: Final = 0.05
"""Share of its range by which a value may be off, and of the true ratio by which a ratio may be."""
_SAME: Final = 0.01
"""Share of its diagonal by which hardly a point of an instance leaves the surface in a turn that is a symmetry."""
_HARDLY: Final = 95.0
_SAMPLES: Final = 1000


@dataclass(frozen=True)
class RecoveredParameter:
    """A continuous parameter that can be compared.

    Attributes:
        name: its name.
        error: distance of the value from the true one, as a share of the parameter's range.
        status: what the verdict says of it.
        covered: whether the interval holds the true value; ``None`` without an interval.
        half_width: half the interval, as a share of the range.
    """

    name: str
    error: float
    status: ParameterStatus | None
    covered: bool | None
    half_width: float | None


@dataclass(frozen=True)
class RecoveredOption:
    """A parameter with options that can be compared."""

    name: str
    right: bool


@dataclass(frozen=True)
class Recovery:
    """How much of the truth an answer recovers.

    Attributes:
        model: name of the true model.
        model_right: whether the answer is an instance of it.
        parameters, options: those that can be compared.
        active_parameters: continuous parameters that are active in the truth, compared or not.
        options_all_right: whether every option that is active in the truth is right.
        ratios_right: of each offered ratio that can be compared, whether it is right.
        pose_right: ``None`` where the model is wrong.
        pose_offered: whether the pose, or one of the alternatives that are offered, turns the object right.
    """

    model: str
    model_right: bool
    parameters: tuple[RecoveredParameter, ...] = ()
    options: tuple[RecoveredOption, ...] = ()
    active_parameters: int = 0
    options_all_right: bool = False
    ratios_right: tuple[bool, ...] = ()
    pose_right: bool | None = None
    pose_offered: bool | None = None


def recover(truth: Truth, answer: Answer) -> Recovery:
    """Compare an answer with the truth."""
    compiled = truth.compiled
    model = compiled.model
    measures = np.array([not parameter.options for parameter in model.parameters], dtype=bool)
    active = int((measures & truth.active).sum())
    if answer.model != model.name:
        return Recovery(model.name, model_right=False, active_parameters=active)
    counted = comparable(truth, answer.values)
    same = answer.values == truth.values
    options = truth.active & ~measures
    pose_right = is_pose_right(truth, answer)
    return Recovery(
        model=model.name,
        model_right=True,
        parameters=tuple(_parameter(truth, answer, int(i)) for i in np.flatnonzero(counted & measures)),
        options=tuple(
            RecoveredOption(model.parameters[i].name, bool(same[i])) for i in np.flatnonzero(counted & options)
        ),
        active_parameters=active,
        options_all_right=bool(same[options].all()),
        ratios_right=tuple(_offered_ratios(truth, answer.ratios, counted)),
        pose_right=pose_right,
        pose_offered=pose_right or any(_is_turned_right(truth, pose) for pose in answer.other_poses),
    )


def comparable(truth: Truth, values: Float[np.ndarray, " P"]) -> Bool[np.ndarray, " P"]:
    """Tell which parameters are active in the truth and have every option right that decides over that."""
    parameters = truth.compiled.model.parameters
    columns = truth.compiled.space.columns
    decided = np.ones(len(parameters), dtype=bool)
    for i, parameter in enumerate(parameters):  # a parameter depends on those before it only
        for condition in parameter.active_when:
            j = columns[condition.parameter]
            option_right = not parameters[j].options or values[j] == truth.values[j]
            decided[i] &= decided[j] and option_right
    return decided & truth.active


def _parameter(truth: Truth, answer: Answer, i: int) -> RecoveredParameter:
    parameter, estimate, true = truth.compiled.model.parameters[i], answer.parameters[i], float(truth.values[i])
    extent = parameter.maximum - parameter.minimum
    low, high = estimate.interval or (np.nan, np.nan)
    return RecoveredParameter(
        name=parameter.name,
        error=abs(float(answer.values[i]) - true) / extent,
        status=estimate.status,
        covered=None if estimate.interval is None else bool(low <= true <= high),
        half_width=None if estimate.interval is None else 0.5 * (high - low) / extent,
    )


def _offered_ratios(truth: Truth, ratios: tuple[Ratio, ...], counted: Bool[np.ndarray, " P"]) -> list[bool]:
    """Tell of each ratio that is offered as determined, and can be compared, whether it is right."""
    parameters, columns = truth.compiled.model.parameters, truth.compiled.space.columns
    right = []
    for ratio in ratios:
        ends = columns[ratio.numerator], columns[ratio.denominator]
        if not counted[list(ends)].all() or ratio.status not in (None, "determined"):
            continue
        bases = [parameters[i].base_value for i in ends]
        factors = (1.0, 1.0) if None in bases else bases
        over, under = (float(truth.values[i]) * (factor or 0.0) for i, factor in zip(ends, factors, strict=True))
        right.append(bool(abs(ratio.value * under - over) <= CLOSE * abs(over)))
    return right


def is_pose_right(truth: Truth, answer: Answer) -> bool:
    """Tell whether the posed answer stands, lies and reaches like the truth; see the module for what that means."""
    if not _is_turned_right(truth, answer.pose):
        return False
    wanted_center, wanted_length = _box(truth.compiled, truth.values, truth.pose, truth.pose)
    center, length = _box(truth.compiled, answer.values, answer.pose, truth.pose)
    away = float(np.linalg.norm(center - wanted_center))
    return away <= PLACE * wanted_length and abs(length - wanted_length) <= PLACE * wanted_length


def _box(
    compiled: CompiledModel, values: Float[np.ndarray, " P"], pose: Pose, axes: Pose
) -> tuple[Float[np.ndarray, " 3"], float]:
    """Center and diagonal of a posed instance's bounding box along the axes of a pose, in the query's units."""
    instance: TriangleMesh = compiled.instance(values)
    points = pose.apply(instance.vertices) @ axes.rotation
    low, high = points.min(axis=0), points.max(axis=0)
    return 0.5 * (low + high), float(np.linalg.norm(high - low))


def _is_turned_right(truth: Truth, found: Pose) -> bool:
    difference = truth.pose.rotation.T @ found.rotation
    traces = np.einsum("nij,ij->n", symmetry_rotations(truth.compiled.model.symmetry), difference)
    angle_deg = np.degrees(np.arccos(np.clip(0.5 * (traces.max() - 1.0), -1.0, 1.0)))
    return bool(angle_deg <= ROTATION_DEG) or _stays(truth.compiled.instance(truth.values), difference)


def _stays(instance: TriangleMesh, turn: Float[np.ndarray, "3 3"]) -> bool:
    """Tell whether a turn about its center leaves the surface of an instance where it is."""
    vertices, triangles = prepared(instance.vertices, instance.faces)
    faces, weights, _ = sample_surface(vertices, triangles, _SAMPLES, 0.5)
    points = np.einsum("nk,nkd->nd", weights, vertices[triangles[faces]])
    center = points.mean(axis=0)
    distance = TriangleDistance(instance)
    moved = [distance(center + (points - center) @ rotation.T) for rotation in (turn, turn.T)]
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    return float(np.percentile(moved, _HARDLY)) <= _SAME * diagonal


def symmetry_rotations(symmetry: Symmetry) -> Float[np.ndarray, "N 3 3"]:
    """Return every rotation that leaves the model's instances as they are, by its declared mirrors and turns.

    A product of two mirrors is a rotation, a single mirror is not. The identity is the first one.
    """
    pairs = [np.eye(3)]
    pairs += [Mirror(a).matrix() @ Mirror(b).matrix() for a, b in combinations(symmetry.mirrors, 2)]
    if symmetry.axis is None:
        return np.stack(pairs)
    angles = 360.0 / symmetry.order * np.arange(symmetry.order)
    return np.stack([Turn(symmetry.axis, float(angle_deg)).matrix() @ pair for angle_deg in angles for pair in pairs])
