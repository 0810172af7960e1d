"""Rotation-extrude: one step of a curve that was sketched from a face (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.spatial.transform import Rotation

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Element
from shapewright.modeling.fields import ELEMENT, NUMBER, field
from shapewright.modeling.frames import FrameSource, frame_of_element, write_frame
from shapewright.modeling.opcodes import BEND
from shapewright.modeling.operations.operation import Mode, Operation, Step, multiplies
from shapewright.modeling.program import Changes, Program, SlottedQuantities


@dataclass(frozen=True)
class RotationExtrude(Operation):
    """A face grows out and turns about the direction of one of its edges.

    The paper names (w, l) without defining them. Our reading: the new face is turned by a
    fixed angle about the edge's direction, moved by ``length`` along the mean of the old and the new normal, and
    scaled by ``width`` across the turn, that is along the direction in the face that is perpendicular to the edge.

    Attributes:
        face: the face; it keeps its id at the new place.
        edge: one of the face's edges.
        angle_deg: the structural angle; no parameter changes it. Positive turns the normal away from the edge.
        width: relative size across the turn.
        length: distance between the old and the new face's centre.
    """

    kind: ClassVar[str] = "rotation_extrude"
    quantities: ClassVar[tuple[str, ...]] = ("width", "length")
    modes: ClassVar[Mapping[str, Mode]] = {"length": multiplies("length"), "width": multiplies("width")}

    face: Element = field(ELEMENT)
    edge: Element = field(ELEMENT)
    angle_deg: float = field(NUMBER)
    length: float = field(NUMBER)
    width: float = field(NUMBER, 1.0)

    def apply(self, mesh: ControlMesh) -> Step:
        """Add the sides and lift the face."""
        if self.face.kind != "face" or self.edge.kind != "edge":
            raise ModelError("rotation_extrude needs a face and one of its edges")
        old = mesh.face(self.face.id)
        start, end = mesh.edge(self.edge.id)
        if self.face.id not in mesh.faces_of_edge(self.edge.id):
            raise ModelError(f"edge {self.edge} is not an edge of face {self.face}")
        # Walk the edge as the face does, so that the sense of the turn does not depend on how the edge was made.
        if old[(old.index(start) + 1) % len(old)] != end:
            start, end = end, start
        normal_source = frame_of_element(mesh, self.face)
        assert isinstance(normal_source, FrameSource)
        return _Bent(self, FrameSource(normal_source.loops, (start, end)), old, mesh.lift_face(self.face.id))


@dataclass(frozen=True)
class _Bent:
    operation: RotationExtrude
    frame: FrameSource
    old: Loop
    new: Loop

    def write(self, program: Program, changes: Changes) -> None:
        quantities = SlottedQuantities(program, self.operation.amounts(), changes)
        turn = Rotation.from_euler("x", self.operation.angle_deg, degrees=True).as_matrix()
        mean_normal = np.array([0.0, 0.0, 1.0]) + turn[:, 2]
        mean_normal /= max(float(np.linalg.norm(mean_normal)), 1e-12)
        numbers = (program.keep([*turn.ravel().tolist(), *mean_normal.tolist()]),)
        sources = (*write_frame(program, self.frame), *program.mean(self.old), *self.old)
        program.add(BEND, sources, self.new, numbers, quantities=quantities, fresh=True)
