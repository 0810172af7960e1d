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
from shapewright.modeling.frames import Centres, FrameSource, Positions, TargetFrames, frame_of_element
from shapewright.modeling.operations.operation import Mode, Operation, Quantities, Step, multiplies


@dataclass(frozen=True)
class RotationExtrude(Operation):
    """A face grows out and turns about the direction of one of its edges.

    The paper names (w, l) without defining them. Our reading (PAPER-NOTES, section 3): the new face is turned by a
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
        frame = TargetFrames([FrameSource(normal_source.loops, (start, end))])
        return _Turned(frame, Centres([list(old)]), old, mesh.lift_face(self.face.id), self.angle_deg)


@dataclass(frozen=True)
class _Turned:
    frame: TargetFrames
    centre: Centres
    old: Loop
    new: Loop
    angle_deg: float

    def reads(self) -> set[int]:
        return self.frame.vertices() | self.centre.vertices() | set(self.old)

    def writes(self) -> set[int]:
        return set(self.new)

    def move(self, positions: Positions, quantities: Quantities) -> None:
        frame = self.frame.evaluate(positions)[0]
        centre = self.centre.evaluate(positions)
        local = np.einsum("jib,njb->nib", frame, positions[list(self.old)] - centre)
        local[:, 1] *= quantities["width"]
        turn = Rotation.from_euler("x", self.angle_deg, degrees=True).as_matrix()
        normal = np.array([0.0, 0.0, 1.0])
        mean_normal = normal + turn @ normal
        mean_normal /= max(float(np.linalg.norm(mean_normal)), 1e-12)
        moved = np.einsum("ij,njb->nib", turn, local) + mean_normal[:, None] * quantities["length"]
        positions[list(self.new)] = centre + np.einsum("ijb,njb->nib", frame, moved)
