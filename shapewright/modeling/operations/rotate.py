"""Rotate elements by alpha (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.fields import NUMBER, OPTIONAL_ELEMENT, TARGETS, choice, field
from shapewright.modeling.frames import Positions
from shapewright.modeling.operations.operation import Mode, Operation, Quantities, Step, multiplies
from shapewright.modeling.operations.selection import MovedTargets, map_about_pivots, moved_targets


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
        return _Rotated(moved_targets(mesh, self.targets, self.pivot), "uvz".index(self.axis))


@dataclass(frozen=True)
class _Rotated:
    targets: MovedTargets
    axis: int

    def reads(self) -> set[int]:
        return self.targets.reads()

    def writes(self) -> set[int]:
        return self.targets.writes()

    def move(self, positions: Positions, quantities: Quantities) -> None:
        if (quantities["alpha_deg"] == 0.0).all():
            return
        angle_rad = np.radians(quantities["alpha_deg"])
        first, second = (self.axis + 1) % 3, (self.axis + 2) % 3
        turn = np.zeros((3, 3, positions.shape[2]))
        turn[self.axis, self.axis] = 1.0
        turn[first, first] = turn[second, second] = np.cos(angle_rad)
        turn[second, first] = np.sin(angle_rad)
        turn[first, second] = -turn[second, first]
        map_about_pivots(positions, self.targets, turn)
