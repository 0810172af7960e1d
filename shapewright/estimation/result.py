"""What an estimation answers."""

from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.errors import Cancelled
from shapewright.mesh import TriangleMesh

Layer = Literal[1, 2, 3]
StageName = Literal["panorama", "surface", "surface+zbuffer", "zbuffer"]

STAGE_LAYERS: dict[StageName, Layer] = {"panorama": 1, "surface": 2, "surface+zbuffer": 3, "zbuffer": 3}
"""The four optimisations of Figure 4 in their order, and their layers."""


@dataclass(frozen=True)
class Distances:
    """Distances between the query and one posed instance, both in the normalised space of the query.

    ``zbuffer`` is normalised by the covered pixels, ``zbuffer_raw`` is the sum of Algorithm 1.
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

    The range is the one that the other values leave. ``option`` is the name of a choice's value. A parameter that is
    not ``active`` means nothing beside the other values, and is 1.
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

    @property
    def displayed_value(self) -> float:
        """The value in ``unit``: x times the base value, or x itself if there is none."""
        return self.value if self.base_value is None else self.value * self.base_value


@dataclass(frozen=True, eq=False)
class Stage:
    """The outcome of one of the four optimisations.

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
class Estimation:
    """Parameters, pose and mesh that rebuild a query, and how well they do.

    Args:
        layer: the layer whose result is the answer, by the thresholds.
        values: x of each parameter.
        parameters: the same with names and ranges.
        pose: model space to the query's own file coordinates.
        distances: of the answer.
        stages: every optimisation that was run, in order.
        mesh: the fitted mesh, in the query's own file coordinates.
        complete: False if the work was cancelled and this is the best so far.
    """

    layer: Layer
    values: Float[np.ndarray, " P"]
    parameters: tuple[ParameterEstimate, ...]
    pose: Pose
    distances: Distances
    stages: tuple[Stage, ...]
    mesh: TriangleMesh
    complete: bool = True

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON; all but the mesh."""
        return {
            "layer": self.layer,
            "complete": self.complete,
            "values": self.values.tolist(),
            "parameters": [asdict(parameter) for parameter in self.parameters],
            "pose": self.pose.to_dict(),
            "distances": self.distances.to_dict(),
            "stages": [stage.to_dict() for stage in self.stages],
        }


class EstimationCancelled(Cancelled):
    """An estimation was cancelled. ``best`` is its best result so far, None if there is none yet."""

    def __init__(self, best: Estimation | None) -> None:
        super().__init__("the estimation was cancelled")
        self.best = best
