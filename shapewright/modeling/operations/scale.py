"""Scale elements by sigma (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.fields import NUMBER, OPTIONAL_ELEMENT, TARGETS, choice, field
from shapewright.modeling.opcodes import SCALE, STRETCH
from shapewright.modeling.operations.operation import Mode, Operation, Step, multiplies
from shapewright.modeling.operations.selection import MovedTargets, moved_targets
from shapewright.modeling.program import Changes, Program, SlottedQuantities

LOCAL_AXES = ("uvz", "uv", "uz", "vz", "u", "v", "z")


@dataclass(frozen=True)
class Scale(Operation):
    """Every target grows or shrinks about its centre, or about the centre of one pivot element.

    Attributes:
        targets: what is scaled, each in its own frame.
        sigma: relative size; a parameter x makes it x sigma.
        axes: the local axes along which it acts.
        pivot: an element whose centre stays where it is.
    """

    kind: ClassVar[str] = "scale"
    quantities: ClassVar[tuple[str, ...]] = ("sigma",)
    modes: ClassVar[Mapping[str, Mode]] = {"size": multiplies("sigma")}

    targets: tuple[Target, ...] = field(TARGETS)
    sigma: float = field(NUMBER)
    axes: str = field(choice(*LOCAL_AXES), "uvz")
    pivot: Element | None = field(OPTIONAL_ELEMENT, None)

    def apply(self, mesh: ControlMesh) -> Step:
        """Change no topology; return the motion."""
        return _Scaled(self, moved_targets(mesh, self.targets, self.pivot))


@dataclass(frozen=True)
class _Scaled:
    operation: Scale
    targets: MovedTargets

    def write(self, program: Program, changes: Changes) -> None:
        quantities = SlottedQuantities(program, self.operation.amounts(), changes)
        if quantities.always("sigma", 1.0):
            return
        pivots, axes = self.targets.write_pivots(program), [int(axis in self.operation.axes) for axis in "uvz"]
        if all(axes) or self.targets.frames.along_axes:  # it is the same in any frame, or the frame is known
            for pivot, vertices in zip(pivots, self.targets.moved, strict=True):
                program.add(STRETCH, pivot, vertices, axes, quantities=quantities)
            return
        for frame, pivot, vertices in zip(self.targets.frames.write(program), pivots, self.targets.moved, strict=True):
            program.add(SCALE, (*pivot, *frame), vertices, axes, quantities=quantities)
