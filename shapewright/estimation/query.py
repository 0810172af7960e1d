"""What is asked: a mesh, and whatever is known about how it lies in its file."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal, get_args

import numpy as np
from jaxtyping import Float

from shapewright.errors import EstimationError
from shapewright.mesh import TriangleMesh

Unit = Literal["mm", "cm", "m", "in"]
Axis = Literal["+x", "-x", "+y", "-y", "+z", "-z"]

UNITS: Final[Mapping[Unit, float]] = MappingProxyType({"mm": 1000.0, "cm": 100.0, "m": 1.0, "in": 1000.0 / 25.4})
"""How many of each unit make a meter."""
AXES: Final[tuple[Axis, ...]] = get_args(Axis)


@dataclass(frozen=True, eq=False)
class Query:
    """A mesh of unknown parameters and pose.

    What is known narrows the search; all of it may be left out.

    Args:
        mesh: the unknown mesh, in any units; soup is fine.
        units: unit of the mesh's coordinates. The scale of the pose is known with it, for models that say what a
            unit of their own coordinates stands for, and lengths are answered in this unit.
        up: the axis of the file that points up; models stand with +z up.
        rotation: the rotation that takes the axes of a model to those of the file.

    Raises:
        EstimationError: an unknown unit or axis, a matrix that is not a proper rotation, or ``up`` and ``rotation``
            that contradict each other.
    """

    mesh: TriangleMesh
    units: Unit | None = None
    up: Axis | None = None
    rotation: Float[np.ndarray, "3 3"] | None = None

    def __post_init__(self) -> None:
        if self.units is not None and self.units not in UNITS:
            raise EstimationError(f"expected one of {', '.join(UNITS)}, got {self.units!r}", where="units")
        if self.up is not None and self.up not in AXES:
            raise EstimationError(f"expected one of {', '.join(AXES)}, got {self.up!r}", where="up")
        if self.rotation is None:
            return
        rotation = np.ascontiguousarray(self.rotation, dtype=np.float64)
        orthonormal = np.isfinite(rotation).all() and np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-6
        if not orthonormal or np.linalg.det(rotation) < 0:
            raise EstimationError("the matrix is not a proper rotation", where="rotation")
        object.__setattr__(self, "rotation", rotation)
        up = self.up_vector()
        if up is not None and not np.allclose(rotation[:, 2], up, atol=1e-6):
            raise EstimationError(f"the rotation does not take +z to {self.up}", where="rotation")

    def up_vector(self) -> Float[np.ndarray, " 3"] | None:
        """Return the unit vector of the file that points up, if it is known."""
        return None if self.up is None else axis_vector(self.up)

    def allows(self, rotation: Float[np.ndarray, "3 3"], tolerance_rad: float = 0.1) -> bool:
        """Tell whether a rotation from a model to the file agrees with what is known."""
        if self.rotation is not None:
            cosine = (np.trace(self.rotation.T @ rotation) - 1.0) / 2.0
        elif (up := self.up_vector()) is not None:
            cosine = float(rotation[:, 2] @ up)
        else:
            return True
        return bool(np.arccos(np.clip(cosine, -1.0, 1.0)) <= tolerance_rad)

    def scale_of(self, unit_m: float | None) -> float | None:
        """Return the scale of the pose, file units for each unit of a model; ``None`` if it is not known.

        Args:
            unit_m: meters that a unit of the model's coordinates stands for, ``None`` if its author does not say.
        """
        return None if self.units is None or unit_m is None else unit_m * UNITS[self.units]


def axis_vector(axis: Axis) -> Float[np.ndarray, " 3"]:
    """Return the unit vector of an axis, e.g. of ``-y``."""
    vector = np.zeros(3)
    vector["xyz".index(axis[1])] = -1.0 if axis[0] == "-" else 1.0
    return vector
