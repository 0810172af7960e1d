"""Turns between two poses of one model, up to its symmetry, and their names."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from shapewright.modeling.elements import AXES
from shapewright.modeling.symmetry import Symmetry

NAMED_WITHIN_DEG: Final = 15.0
"""A turn is called half or a quarter, and its axis x, y or z, if it is that near."""


@dataclass(frozen=True)
class PoseTurn:
    """A rotation of a model in its own coordinates.

    Attributes:
        angle_deg: 0 to 180.
        axis: unit vector; any if the angle is 0.
    """

    angle_deg: float
    axis: tuple[float, float, float]

    @property
    def axis_name(self) -> str | None:
        """x, y or z if the axis is near one of these."""
        i = int(np.abs(self.axis).argmax())
        return AXES[i] if abs(self.axis[i]) >= np.cos(np.deg2rad(NAMED_WITHIN_DEG)) else None

    def __str__(self) -> str:
        axis = self.axis_name or "({:.2g}, {:.2g}, {:.2g})".format(*self.axis)
        if abs(self.angle_deg - 180.0) <= NAMED_WITHIN_DEG:
            return f"turned half around {axis}"
        if abs(self.angle_deg - 90.0) <= NAMED_WITHIN_DEG:
            return f"turned a quarter around {axis}"
        return f"turned by {self.angle_deg:.0f}° around {axis}"


def find_turn(
    first: Float[np.ndarray, "3 3"], second: Float[np.ndarray, "3 3"], symmetry: Symmetry
) -> tuple[float, PoseTurn]:
    """Return how far apart two rotations of a model are.

    Args:
        first: model to query.
        second: model to query.
        symmetry: what leaves the model as it is.

    Returns:
        The smallest angle in degrees between the first and what looks like the second; and a turn that takes the first
        to something that looks like the second, about x, y or z if there is one.
    """
    alike = Rotation.from_matrix(first.T @ second @ symmetry.rotations())
    vectors = alike.as_rotvec()
    angles = np.linalg.norm(vectors, axis=1)
    axes = vectors / np.where(angles > 0, angles, 1.0)[:, None]
    turns = [
        PoseTurn(float(np.rad2deg(angle)), (float(axis[0]), float(axis[1]), float(axis[2])))
        for angle, axis in zip(angles, axes, strict=True)
    ]
    nearest = min(turns, key=lambda turn: turn.angle_deg)
    return nearest.angle_deg, min(turns, key=lambda turn: (turn.axis_name is None, turn.angle_deg))
