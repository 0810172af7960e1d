"""Cylindrical coordinates (rho, phi, z) in a local frame, which extrude and drag share (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from shapewright.modeling.elements import Target
from shapewright.modeling.fields import NUMBER, TARGETS, field
from shapewright.modeling.opcodes import HALF_TURNS
from shapewright.modeling.operations.operation import Mode, Operation, multiplies
from shapewright.modeling.operations.selection import refuse_pivots
from shapewright.modeling.program import Change, Changes, Program, SlottedQuantities


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
        "angle": (Change("phi_deg", HALF_TURNS),),
        "height": multiplies("z"),
        "sideways": multiplies("rho"),
    }

    targets: tuple[Target, ...] = field(TARGETS)
    z: float = field(NUMBER, 0.0)
    rho: float = field(NUMBER, 0.0)
    phi_deg: float = field(NUMBER, 0.0)

    def __post_init__(self) -> None:
        refuse_pivots(self.kind, self.targets)

    def displaced(self, program: Program, changes: Changes) -> SlottedQuantities:
        """Lay down what DRAG and EXTRUDE look at."""
        return SlottedQuantities(program, self.amounts(), changes, angle="phi_deg")
