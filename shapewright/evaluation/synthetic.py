"""Synthetic queries: random instances of known values in a random pose, whose surface is cut anew.

They measure what real meshes cannot: whether values, options, model and pose come out right.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from shapewright.distances.alignment import Pose
from shapewright.errors import EvaluationError
from shapewright.estimation.query import UNITS, Unit
from shapewright.evaluation.anew import cut_anew
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel

SCALES: Final = (0.01, 100.0)
"""The scale of a pose is log-uniform in this range where it is not known."""
SHIFT: Final = 5.0
"""A query is shifted by up to this many of its diagonals along each axis."""


@dataclass(frozen=True, eq=False)
class Truth:
    """What a synthetic query was made of.

    Attributes:
        compiled: the model.
        values: x of each parameter, settled.
        active: which parameters mean something beside these values.
        pose: model space to the coordinates of the query.
    """

    compiled: CompiledModel
    values: Float[np.ndarray, " P"]
    active: Bool[np.ndarray, " P"]
    pose: Pose

    @property
    def options(self) -> dict[str, str]:
        """The chosen option of each active parameter that has options."""
        return {
            parameter.name: dict(parameter.named_options())[float(self.values[i])]
            for i, parameter in enumerate(self.compiled.model.parameters)
            if parameter.options and self.active[i]
        }


@dataclass(frozen=True, eq=False)
class SyntheticQuery:
    """A mesh and what it was made of; with ``units`` its scale is known."""

    mesh: TriangleMesh
    truth: Truth
    units: Unit | None = None


def models_in_turn(models: Sequence[CompiledModel], count: int, seed: int) -> list[CompiledModel]:
    """Choose the model of each of ``count`` queries: every model as often as any other, in random order.

    More queries with the same seed begin with the same ones.

    Raises:
        EvaluationError: there are no models.
    """
    if not models:
        raise EvaluationError("there is no model to draw queries from")
    rounds = -(-count // len(models))
    order = [i for number in range(rounds) for i in np.random.default_rng([seed, number]).permutation(len(models))]
    return [models[i] for i in order[:count]]


def draw_query(compiled: CompiledModel, seed: int, number: int, *, known_scale: bool = False) -> SyntheticQuery:
    """Draw a synthetic query; the same arguments give the same one.

    Values are random and settled, the rotation is uniform, the shift uniform. With ``known_scale`` the coordinates
    are in a random unit that the query names, otherwise the scale is log-uniform.

    Args:
        compiled: the model.
        seed: of the whole evaluation.
        number: of the query.
        known_scale: whether the query says its unit.

    Raises:
        EvaluationError: the scale is to be known, and the model does not say what its unit stands for.
    """
    rng = np.random.default_rng([seed, number, 1])
    values = compiled.random_values(rng, 1)
    instance = compiled.instance(values[0])
    units: Unit | None = None
    scale = float(np.exp(rng.uniform(*np.log(SCALES))))
    if known_scale:
        if compiled.model.unit_m is None:
            raise EvaluationError("the model does not say how many meters its unit is", where=compiled.model.name)
        units = tuple(UNITS)[int(rng.integers(len(UNITS)))]
        scale = compiled.model.unit_m * UNITS[units]
    rotation = Rotation.random(rng=rng).as_matrix()
    low, high = instance.bounds
    reach = scale * SHIFT * float(np.linalg.norm(high - low))
    pose = Pose(rotation, rng.uniform(-reach, reach, 3), scale)
    mesh = cut_anew(instance, rng).transformed(pose.rotation, pose.translation, pose.scale)
    truth = Truth(compiled, values[0], compiled.space.active(values)[0], pose)
    return SyntheticQuery(mesh, truth, units)
