"""Drag elements along (rho, phi, z) (Table 1)."""

from dataclasses import dataclass
from typing import ClassVar

from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.frames import Positions
from shapewright.modeling.operations.displacement import Displacement, displacement
from shapewright.modeling.operations.operation import Quantities, Step
from shapewright.modeling.operations.selection import MovedTargets, moved_targets


@dataclass(frozen=True)
class Drag(Displacement):
    """Every target moves as one, in its own frame (all frames are taken before anything moves)."""

    kind: ClassVar[str] = "drag"

    def apply(self, mesh: ControlMesh) -> Step:
        """Change no topology; return the motion."""
        return _Dragged(moved_targets(mesh, self.targets))


@dataclass(frozen=True)
class _Dragged:
    targets: MovedTargets

    def reads(self) -> set[int]:
        return self.targets.reads()

    def writes(self) -> set[int]:
        return self.targets.writes()

    def move(self, positions: Positions, quantities: Quantities) -> None:
        ways = displacement(self.targets.frames.evaluate(positions), quantities)
        for run in self.targets.runs:
            positions[run.vertices] += ways if len(ways) == 1 else ways[run.targets]
