"""What an estimation answers."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from types import MappingProxyType
from typing import Any, Final, Literal

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.errors import Cancelled
from shapewright.estimation.generator import ModelInfo
from shapewright.estimation.residuals import Residuals
from shapewright.mesh import TriangleMesh

Layer = Literal[1, 2, 3]
StageName = Literal["panorama", "surface", "surface+zbuffer", "zbuffer", "start", "fit", "polish"]
ParameterStatus = Literal["determined", "determined_up_to_scale", "not_determined", "inactive", "at_range_end"]
Interval = tuple[float, float]

STAGE_LAYERS: Final[Mapping[StageName, Layer]] = MappingProxyType(
    {"panorama": 1, "surface": 2, "surface+zbuffer": 3, "zbuffer": 3, "start": 1, "fit": 2, "polish": 3}
)
"""The four optimizations of Figure 4 and those of the fast estimator, each group in its order, and their layers."""


@dataclass(frozen=True)
class Distances:
    """Distances between the query and one posed instance, both in the normalized space of the query.

    ``zbuffer`` is normalized by the covered pixels, ``zbuffer_raw`` is the sum of Algorithm 1.
    """

    panorama: float
    surface: float
    zbuffer: float
    zbuffer_raw: float

    def to_dict(self) -> dict[str, float]:
        """Plain floats, ready for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class ParameterEstimate:
    """An estimated parameter. ``value`` is x (1 is the base model); with a ``base_value`` people read x times it.

    Attributes:
        name: identifier.
        label: what people read.
        unit: of the displayed value; the query's own where it is known.
        value: x.
        base_value: what x = 1 means to people, in ``unit``.
        minimum: smallest x that the other values leave.
        maximum: largest x that the other values leave.
        active: False if another value makes this one meaningless; x is 1 then.
        option: name of a choice's value.
        status: what the query says about it; ``None`` where the estimator does not judge.
        interval: where x lies with a probability of 90 %, given this structure; ``None`` if that is unknown, the
            parameter is inactive or it is a choice.
    """

    name: str
    label: str
    unit: str | None
    value: float
    base_value: float | None
    minimum: float
    maximum: float
    active: bool = True
    option: str | None = None
    status: ParameterStatus | None = None
    interval: Interval | None = None

    @property
    def displayed_value(self) -> float:
        """The value in ``unit``: x times the base value, or x itself if there is none."""
        return self.value if self.base_value is None else self.value * self.base_value

    @property
    def displayed_interval(self) -> Interval | None:
        """The interval in ``unit``, low end first."""
        if self.interval is None or self.base_value is None:
            return self.interval
        low, high = sorted(x * self.base_value for x in self.interval)
        return low, high

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {**asdict(self), "interval": None if self.interval is None else list(self.interval)}


@dataclass(frozen=True)
class Ratio:
    """Two lengths beside each other, which a query determines whatever its scale is.

    Attributes:
        numerator: name of a parameter that is a length.
        denominator: name of another one.
        label: what people read, e.g. ``Stem length : Bowl depth``.
        value: the quotient of the displayed values, or of x where a base value is missing.
        interval: where it lies with a probability of 90 %, given this structure.
        status: what the query says about it.
    """

    numerator: str
    denominator: str
    label: str
    value: float
    interval: Interval | None = None
    status: ParameterStatus | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {**asdict(self), "interval": None if self.interval is None else list(self.interval)}


@dataclass(frozen=True)
class Combination:
    """A weighted sum of displayed values that the query determines although it does not determine its members.

    Attributes:
        label: what people read.
        weights: of the displayed value of each parameter, by name; the largest is 1.
        interval_share: width of its 90 % interval as a share of what the ranges allow.
    """

    label: str
    weights: Mapping[str, float]
    interval_share: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {"label": self.label, "weights": dict(self.weights), "interval_share": self.interval_share}


@dataclass(frozen=True, eq=False)
class Stage:
    """The outcome of one of the optimizations of an estimator.

    ``pose`` maps model space to the query's own file coordinates. ``complete`` is False if the work was
    cancelled in the middle of it.
    """

    name: StageName
    values: Float[np.ndarray, " P"]
    pose: Pose
    distances: Distances
    complete: bool = True

    @property
    def layer(self) -> Layer:
        """The layer of the paper that the stage belongs to."""
        return STAGE_LAYERS[self.name]

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {
            "name": self.name,
            "layer": self.layer,
            "values": self.values.tolist(),
            "pose": self.pose.to_dict(),
            "distances": self.distances.to_dict(),
            "complete": self.complete,
        }


@dataclass(frozen=True, eq=False)
class Alternative:
    """Another answer that fits nearly as well.

    Attributes:
        kind: what is different: the pose, an option, or the model.
        model: whose parameters they are.
        values: x of each parameter.
        parameters: the same with names and ranges.
        pose: model space to the query's own file coordinates.
        distances: of this answer.
        label: what people read.
    """

    kind: Literal["pose", "option", "model"]
    model: ModelInfo
    values: Float[np.ndarray, " P"]
    parameters: tuple[ParameterEstimate, ...]
    pose: Pose
    distances: Distances
    label: str

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {
            "kind": self.kind,
            "label": self.label,
            "model": _model_dict(self.model),
            "values": self.values.tolist(),
            "parameters": [parameter.to_dict() for parameter in self.parameters],
            "pose": self.pose.to_dict(),
            "distances": self.distances.to_dict(),
        }


@dataclass(frozen=True, eq=False)
class ModelTried:
    """How near a model came.

    Attributes:
        model: one of the class.
        distances: of its best fit; ``None`` if others were nearer and it was given up before one.
        panorama: distance of the nearest of its random instances; ``None`` where no bank was scanned.
    """

    model: ModelInfo
    distances: Distances | None = None
    panorama: float | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {
            "model": _model_dict(self.model),
            "distances": None if self.distances is None else self.distances.to_dict(),
            "panorama": self.panorama,
        }


@dataclass(frozen=True)
class FailedThreshold:
    """A distance that is not below its threshold, and so kept a layer's result from being the answer."""

    name: Literal["surface", "zbuffer"]
    value: float
    threshold: float


@dataclass(frozen=True, eq=False)
class Verdict:
    """How well the answer rebuilds the query.

    Attributes:
        layer: the layer whose result is the answer.
        failed: the thresholds that higher layers missed, the highest layer first.
        residuals: where the surfaces of query and fit part, if that was measured.
    """

    layer: Layer
    failed: tuple[FailedThreshold, ...] = ()
    residuals: Residuals | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON; residuals as numbers by part only."""
        return {
            "layer": self.layer,
            "failed": [asdict(threshold) for threshold in self.failed],
            "residuals": None if self.residuals is None else self.residuals.to_dict(),
        }


@dataclass(frozen=True, eq=False)
class Estimation:
    """Parameters, pose and mesh that rebuild a query, and how well they do.

    Attributes:
        estimator: which estimator found it.
        model: the model that fits best.
        layer: the layer whose result is the answer, by the thresholds.
        values: x of each parameter.
        parameters: the same with names and ranges.
        pose: model space to the query's own file coordinates.
        distances: of the answer.
        stages: every optimization of the model that was run, in order.
        mesh: the fitted mesh, in the query's own file coordinates.
        complete: False if the work was cancelled and this is the best so far.
        tried: every model of the class, best first.
        ratios: quotients of lengths.
        combinations: what is determined although its members are not.
        alternatives: other answers that fit nearly as well.
        verdict: which thresholds failed, and where the surfaces part.
    """

    estimator: str
    model: ModelInfo
    layer: Layer
    values: Float[np.ndarray, " P"]
    parameters: tuple[ParameterEstimate, ...]
    pose: Pose
    distances: Distances
    stages: tuple[Stage, ...]
    mesh: TriangleMesh
    complete: bool = True
    tried: tuple[ModelTried, ...] = ()
    ratios: tuple[Ratio, ...] = ()
    combinations: tuple[Combination, ...] = ()
    alternatives: tuple[Alternative, ...] = ()
    verdict: Verdict | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON; all but the mesh."""
        return {
            "estimator": self.estimator,
            "model": _model_dict(self.model),
            "layer": self.layer,
            "complete": self.complete,
            "values": self.values.tolist(),
            "parameters": [parameter.to_dict() for parameter in self.parameters],
            "pose": self.pose.to_dict(),
            "distances": self.distances.to_dict(),
            "verdict": None if self.verdict is None else self.verdict.to_dict(),
            "ratios": [ratio.to_dict() for ratio in self.ratios],
            "combinations": [combination.to_dict() for combination in self.combinations],
            "alternatives": [alternative.to_dict() for alternative in self.alternatives],
            "tried": [tried.to_dict() for tried in self.tried],
            "stages": [stage.to_dict() for stage in self.stages],
        }


class EstimationCancelled(Cancelled):
    """An estimation was cancelled. ``best`` is its best result so far, None if there is none yet."""

    def __init__(self, best: Estimation | None) -> None:
        super().__init__("the estimation was cancelled")
        self.best = best


def _model_dict(model: ModelInfo) -> dict[str, str]:
    return {"id": model.digest, "name": model.name}
