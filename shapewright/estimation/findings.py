"""What an estimation finds out beside its values: how well they are known, and what else would fit."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.estimation.generator import ModelInfo
from shapewright.estimation.result import Distances, ParameterEstimate

ParameterStatus = Literal["determined", "determined_up_to_scale", "not_determined", "inactive", "at_range_end"]


@dataclass(frozen=True)
class Ratio:
    """The ratio of two lengths, as displayed; scale-free."""

    numerator: str
    denominator: str
    label: str
    value: float
    interval: tuple[float, float] | None
    status: ParameterStatus


@dataclass(frozen=True)
class Combination:
    """A weighted sum of displayed values that is determined although its members are not."""

    label: str
    weights: Mapping[str, float]
    interval_share: float


@dataclass(frozen=True, eq=False)
class Alternative:
    """Another answer that fits about as well."""

    kind: Literal["pose", "option", "model"]
    model: ModelInfo
    values: Float[np.ndarray, " P"]
    parameters: tuple[ParameterEstimate, ...]
    pose: Pose
    distances: Distances
    label: str

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {"kind": self.kind, "label": self.label}
