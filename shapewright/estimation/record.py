"""What an estimator has found so far of one model, and the answer that can be made of it at any moment."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.estimation.comparison import Comparison
from shapewright.estimation.generator import InstanceGenerator, ParameterInfo
from shapewright.estimation.query import UNITS, Query
from shapewright.estimation.result import Estimation, ParameterEstimate, Stage, StageName
from shapewright.estimation.verdict import choose, judge
from shapewright.mesh import TriangleMesh
from shapewright.modeling.units import LENGTH_UNITS_M

SHOWN_SUBDIVISION_STEPS = 2
"""The fitted mesh is subdivided at least this often, even if coarser instances were compared."""


@dataclass(frozen=True, eq=False)
class Found:
    """Settled values and a pose in the normalized space of the query; without one the initial pose is meant."""

    values: Float[np.ndarray, " P"]
    pose: Pose | None = None


@dataclass(eq=False)
class Record:
    """The stages of an estimator's work with one model; every estimator fills it in the same way.

    Attributes:
        estimator: name of the estimator.
        comparison: the query and the model.
        expected: the stages of a complete work, in order; the first is of layer 1.
        found: the best of each stage so far.
        finished: the stages that are done.
    """

    estimator: str
    comparison: Comparison
    expected: Sequence[StageName]
    found: dict[StageName, Found] = field(default_factory=dict)
    finished: set[StageName] = field(default_factory=set)

    def put(self, stage: StageName, values: Float[np.ndarray, " P"], pose: Pose | None = None) -> None:
        """Keep the best of a stage so far; it replaces what was kept of the stage before."""
        self.found[stage] = Found(values, pose)

    def finish(self, stage: StageName) -> None:
        """Note that a stage is done."""
        self.finished.add(stage)

    def estimation(self) -> Estimation | None:
        """Make the answer of what is there; ``None`` before the first stage has found anything."""
        if not self.found:
            return None
        comparison = self.comparison
        stages = tuple(self._stage(name) for name in self.expected if name in self.found)
        answer = choose(stages, comparison.settings)
        steps = max(comparison.settings.subdivision_steps, SHOWN_SUBDIVISION_STEPS)
        instance = comparison.generator.instance(answer.values, steps)
        return Estimation(
            estimator=self.estimator,
            model=comparison.generator.model,
            layer=answer.layer,
            values=answer.values,
            parameters=parameter_estimates(comparison.generator, answer.values, comparison.prepared.query),
            pose=answer.pose,
            distances=answer.distances,
            stages=stages,
            mesh=TriangleMesh(answer.pose.apply(instance.vertices), instance.faces),
            complete=self.finished.issuperset(self.expected),
            verdict=judge(stages, answer, comparison.settings),
        )

    def _stage(self, name: StageName) -> Stage:
        found = self.found[name]
        instance = self.comparison.instance(found.values)
        pose = found.pose or self.comparison.initial_pose(instance)
        return Stage(
            name=name,
            values=found.values,
            pose=self.comparison.to_file.compose(pose),
            distances=self.comparison.distances(instance, pose),
            complete=name in self.finished,
        )


def parameter_estimates(
    generator: InstanceGenerator, values: Float[np.ndarray, " P"], query: Query
) -> tuple[ParameterEstimate, ...]:
    """Describe settled values for people; lengths in the unit of the query if the scale is known.

    Args:
        generator: the compiled model.
        values: x of each parameter.
        query: whose unit may be known.
    """
    lowest, highest = generator.space.ranges(values[None])
    active = generator.space.active(values[None])[0]
    known_scale = query.scale_of(generator.model.unit_m) is not None
    estimates = (
        ParameterEstimate(
            name=parameter.name,
            label=parameter.label,
            unit=parameter.unit,
            value=float(values[i]),
            base_value=parameter.base_value,
            minimum=float(lowest[0, i]),
            maximum=float(highest[0, i]),
            active=bool(active[i]),
            option=dict(parameter.named_options()).get(float(values[i])),
        )
        for i, parameter in enumerate(generator.model.parameters)
    )
    if not known_scale:
        return tuple(estimates)
    described = zip(estimates, generator.model.parameters, strict=True)
    return tuple(_in_units(estimate, parameter, query) for estimate, parameter in described)


def _in_units(estimate: ParameterEstimate, parameter: ParameterInfo, query: Query) -> ParameterEstimate:
    """Say a length in the unit of the query."""
    unit_m = LENGTH_UNITS_M.get(parameter.unit or "")
    if query.units is None or parameter.base_value is None or unit_m is None:
        return estimate
    factor = unit_m * UNITS[query.units]
    return replace(estimate, unit=query.units, base_value=parameter.base_value * factor)
