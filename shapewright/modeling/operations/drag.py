"""Drag elements along (rho, phi, z) (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Target
from shapewright.modeling.fields import NUMBER, TARGETS, field
from shapewright.modeling.frames import Positions
from shapewright.modeling.operations.displacement import displacement
from shapewright.modeling.operations.operation import Mode, Operation, Quantities, Step, multiplies, turns_phi
from shapewright.modeling.operations.selection import MovedTargets, moved_targets


@dataclass(frozen=True)
class Drag(Operation):
    """Every target moves as one, in its own frame (all frames are taken before anything moves)."""

    kind: ClassVar[str] = "drag"
    quantities: ClassVar[tuple[str, ...]] = ("rho", "phi_deg", "z")
    modes: ClassVar[Mapping[str, Mode]] = {
        "length": multiplies("rho", "z"),
        "angle": turns_phi,
        "height": multiplies("z"),
        "sideways": multiplies("rho"),
    }

    targets: tuple[Target, ...] = field(TARGETS)
    z: float = field(NUMBER, 0.0)
    rho: float = field(NUMBER, 0.0)
    phi_deg: float = field(NUMBER, 0.0)

    def apply(self, mesh: ControlMesh) -> Step:
        """Change no topology; return the motion."""
        return _Dragged(moved_targets(mesh, self.targets))


@dataclass(frozen=True)
class _Dragged:
    targets: MovedTargets

    def move(self, positions: Positions, quantities: Quantities) -> None:
        ways = displacement(self.targets.frames.evaluate(positions), quantities)
        for run in self.targets.runs:
            positions[run.vertices] += ways if len(ways) == 1 else ways[run.targets]
