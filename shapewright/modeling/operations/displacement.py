"""Cylindrical coordinates (rho, phi, z) in a local frame, which extrude and drag share (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from shapewright.modeling.elements import Target
from shapewright.modeling.fields import NUMBER, TARGETS, field
from shapewright.modeling.frames import Frames, Vectors
from shapewright.modeling.operations.operation import Amounts, Mode, Operation, Quantities, multiplies
from shapewright.modeling.operations.selection import refuse_pivots


def _turns_phi(quantities: Quantities, x: Amounts) -> Quantities:
    """Table 1: (rho, phi + 180 (x - 1), z)."""
    return {**quantities, "phi_deg": quantities["phi_deg"] + 180.0 * (x - 1.0)}


@dataclass(frozen=True)
class Displacement(Operation):
    """Moves each of its targets by (rho, phi, z) in the target's frame.

    Attributes:
        targets: what moves.
        z: distance along the normal.
        rho: distance across the normal.
        phi_deg: direction of that, from u towards v.
    """

    quantities: ClassVar[tuple[str, ...]] = ("rho", "phi_deg", "z")
    modes: ClassVar[Mapping[str, Mode]] = {
        "length": multiplies("rho", "z"),
        "angle": _turns_phi,
        "height": multiplies("z"),
        "sideways": multiplies("rho"),
    }

    targets: tuple[Target, ...] = field(TARGETS)
    z: float = field(NUMBER, 0.0)
    rho: float = field(NUMBER, 0.0)
    phi_deg: float = field(NUMBER, 0.0)

    def __post_init__(self) -> None:
        refuse_pivots(self.kind, self.targets)


def displacement(frames: Frames, quantities: Quantities) -> Vectors:
    """Return rho cos(phi) u + rho sin(phi) v + z n in model space, one vector for each target and instance."""
    angle_rad = np.radians(quantities["phi_deg"])
    rho = quantities["rho"]
    local = np.empty((3, len(rho)))
    local[0], local[1], local[2] = rho * np.cos(angle_rad), rho * np.sin(angle_rad), quantities["z"]
    return np.einsum("tijb,jb->tib", frames, local)
