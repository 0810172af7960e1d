"""Drag elements along (rho, phi, z) (Table 1)."""

from dataclasses import dataclass
from typing import ClassVar

from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.opcodes import DRAG
from shapewright.modeling.operations.displacement import Displacement
from shapewright.modeling.operations.operation import Step
from shapewright.modeling.operations.selection import MovedTargets, moved_targets
from shapewright.modeling.program import Changes, Program


@dataclass(frozen=True)
class Drag(Displacement):
    """Every target moves as one, in its own frame (all frames are taken before anything moves)."""

    kind: ClassVar[str] = "drag"

    def apply(self, mesh: ControlMesh) -> Step:
        """Change no topology; return the motion."""
        return _Dragged(self, moved_targets(mesh, self.targets))


@dataclass(frozen=True)
class _Dragged:
    operation: Drag
    targets: MovedTargets

    def write(self, program: Program, changes: Changes) -> None:
        quantities = self.operation.displaced(program, changes)
        if quantities.always("rho", 0.0) and quantities.always("z", 0.0):
            return
        frames = self.targets.frames.write(program)
        for frame, vertices in zip(frames, self.targets.moved, strict=True):
            program.add(DRAG, frame, vertices, quantities=quantities)
