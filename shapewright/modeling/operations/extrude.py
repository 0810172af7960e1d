"""Extrude faces along (rho, phi, z), one face of a sketched path or a single one."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Target
from shapewright.modeling.fields import NUMBER, TARGETS, field
from shapewright.modeling.frames import FrameSource, ImageFrame, Positions, WorldFrame, frames_of_targets
from shapewright.modeling.operations.displacement import displacement
from shapewright.modeling.operations.operation import Mode, Operation, Quantities, Step, multiplies, turns_phi


@dataclass(frozen=True)
class Extrude(Operation):
    """Faces grow out of the mesh: each keeps its id at the new place, quads join it to its old outline.

    New vertices get ids in the order of the face's loop, new faces in the order of its edges.

    Attributes:
        targets: one face each.
        rho: distance across the normal.
        phi_deg: direction of that, from u towards v.
        z: distance along the normal.
    """

    kind: ClassVar[str] = "extrude"
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
        """Add the sides and lift the faces."""
        if not self.targets:
            raise ModelError("nothing is selected")
        frames = frames_of_targets(mesh, self.targets)
        loops = [single_face(mesh, target) for target in self.targets]
        lifted = [mesh.lift_face(target.elements[0].id) for target in self.targets]
        return _Extruded(tuple(zip(frames, loops, lifted, strict=True)))


@dataclass(frozen=True)
class _Extruded:
    faces: tuple[tuple[FrameSource | WorldFrame | ImageFrame, Loop, Loop], ...]

    def move(self, positions: Positions, quantities: Quantities) -> None:
        for frame, old, new in self.faces:
            positions[list(new)] = positions[list(old)] + displacement(frame.evaluate(positions), quantities)


def single_face(mesh: ControlMesh, target: Target) -> Loop:
    """Return the loop of the one face of a target; raises ModelError if it is anything else."""
    if len(target.elements) != 1 or target.elements[0].kind != "face":
        raise ModelError("each target must be exactly one face")
    return mesh.face(target.elements[0].id)
