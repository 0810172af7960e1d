"""Extrude faces along (rho, phi, z), one face of a sketched path or a single one."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Int

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.frames import Positions, TargetFrames, frames_of_targets
from shapewright.modeling.operations.displacement import Displacement, displacement
from shapewright.modeling.operations.operation import Quantities, Step


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
        return _Extruded(
            frames,
            old=np.array([v for loop in loops for v in loop]),
            new=np.array([v for loop in lifted for v in loop]),
            targets=np.array([i for i, loop in enumerate(loops) for _ in loop]),
        )


@dataclass(frozen=True, eq=False)
class _Extruded:
    frames: TargetFrames
    old: Int[np.ndarray, " N"]
    new: Int[np.ndarray, " N"]
    targets: Int[np.ndarray, " N"]

    def reads(self) -> set[int]:
        return self.frames.vertices() | set(self.old.tolist())

    def writes(self) -> set[int]:
        return set(self.new.tolist())

    def move(self, positions: Positions, quantities: Quantities) -> None:
        ways = displacement(self.frames.evaluate(positions), quantities)
        positions[self.new] = positions.take(self.old, axis=0) + (
            ways if len(ways) == 1 else ways.take(self.targets, axis=0)
        )


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
