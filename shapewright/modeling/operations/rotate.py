"""Rotate elements by alpha (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.fields import NUMBER, OPTIONAL_ELEMENT, TARGETS, choice, field
from shapewright.modeling.opcodes import ROTATE
from shapewright.modeling.operations.operation import Mode, Operation, Step, multiplies
from shapewright.modeling.operations.selection import MovedTargets, moved_targets
from shapewright.modeling.program import Changes, Program, SlottedQuantities


@dataclass(frozen=True)
class Rotate(Operation):
    """Every target turns about an axis of its frame through its centre, or through that of one pivot element.

    Attributes:
        targets: what turns, each in its own frame.
        alpha_deg: the angle; a parameter x makes it x alpha.
        axis: the local axis; z is the normal.
        pivot: an element whose centre lies on the axis.
    """

    kind: ClassVar[str] = "rotate"
    quantities: ClassVar[tuple[str, ...]] = ("alpha_deg",)
    modes: ClassVar[Mapping[str, Mode]] = {"angle": multiplies("alpha_deg")}

    targets: tuple[Target, ...] = field(TARGETS)
    alpha_deg: float = field(NUMBER)
    axis: str = field(choice("u", "v", "z"), "z")
    pivot: Element | None = field(OPTIONAL_ELEMENT, None)

    def apply(self, mesh: ControlMesh) -> Step:
        """Change no topology; return the motion."""
        return _Rotated(self, moved_targets(mesh, self.targets, self.pivot))


@dataclass(frozen=True)
class _Rotated:
    operation: Rotate
    targets: MovedTargets

    def write(self, program: Program, changes: Changes) -> None:
        quantities = SlottedQuantities(program, self.operation.amounts(), changes, angle="alpha_deg")
        if quantities.always("alpha_deg", 0.0):
            return
        axis = "uvz".index(self.operation.axis)
        frames, pivots = self.targets.frames.write(program), self.targets.write_pivots(program)
        for frame, pivot, vertices in zip(frames, pivots, self.targets.moved, strict=True):
            program.add(ROTATE, (*pivot, *frame), vertices, (axis,), quantities=quantities)
