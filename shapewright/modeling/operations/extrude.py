"""Extrude faces along (rho, phi, z), one face of a sketched path or a single one."""

from dataclasses import dataclass
from typing import ClassVar

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.frames import TargetFrames, frames_of_targets
from shapewright.modeling.opcodes import EXTRUDE
from shapewright.modeling.operations.displacement import Displacement
from shapewright.modeling.operations.operation import Step
from shapewright.modeling.program import Changes, Program


@dataclass(frozen=True)
class Extrude(Displacement):
    """Faces grow out of the mesh: each keeps its id at the new place, quads join it to its old outline.

    New vertices get ids in the order of the face's loop, new faces in the order of its edges.

    Each target is one face.
    """

    kind: ClassVar[str] = "extrude"

    def apply(self, mesh: ControlMesh) -> Step:
        """Add the sides and lift the faces."""
        if not self.targets:
            raise ModelError("nothing is selected")
        frames = frames_of_targets(mesh, self.targets)
        check_each_once(self.targets)
        loops = [single_face(mesh, target) for target in self.targets]
        lifted = [mesh.lift_face(target.elements[0].id) for target in self.targets]
        return _Extruded(self, frames, tuple(loops), tuple(lifted))


@dataclass(frozen=True)
class _Extruded:
    operation: Extrude
    frames: TargetFrames
    old: tuple[Loop, ...]
    new: tuple[Loop, ...]

    def write(self, program: Program, changes: Changes) -> None:
        quantities = self.operation.displaced(program, changes)
        for frame, old, new in zip(self.frames.write(program), self.old, self.new, strict=True):
            program.add(EXTRUDE, (*frame, *old), new, quantities=quantities, fresh=True)


def check_each_once(targets: tuple[Target, ...]) -> None:
    """Raise ModelError if an element is in two targets."""
    seen: set[Element] = set()
    for target in targets:
        for element in target.elements:
            if element in seen:
                raise ModelError(f"{element} is selected twice")
            seen.add(element)


def single_face(mesh: ControlMesh, target: Target) -> Loop:
    """Return the loop of the one face of a target; raises ModelError if it is anything else."""
    if len(target.elements) != 1 or target.elements[0].kind != "face":
        raise ModelError("each target must be exactly one face")
    return mesh.face(target.elements[0].id)
