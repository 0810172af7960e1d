"""Scale elements by sigma (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.fields import NUMBER, OPTIONAL_ELEMENT, TARGETS, choice, field
from shapewright.modeling.frames import Positions
from shapewright.modeling.operations.operation import Mode, Operation, Quantities, Step, multiplies
from shapewright.modeling.operations.selection import MovedTargets, moved_targets, stretch_about_pivots

LOCAL_AXES = {"uvz": (0, 1, 2), "uv": (0, 1), "uz": (0, 2), "vz": (1, 2), "u": (0,), "v": (1,), "z": (2,)}


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
        return _Scaled(moved_targets(mesh, self.targets, self.pivot), LOCAL_AXES[self.axes])


@dataclass(frozen=True)
class _Scaled:
    targets: MovedTargets
    axes: tuple[int, ...]

    def reads(self) -> set[int]:
        return self.targets.reads()

    def writes(self) -> set[int]:
        return self.targets.writes()

    def move(self, positions: Positions, quantities: Quantities) -> None:
        if (quantities["sigma"] == 1.0).all():  # many proportions are inserted at 1 and stay there
            return
        factors = np.ones((3, positions.shape[2]))
        factors[list(self.axes)] = quantities["sigma"]
        stretch_about_pivots(positions, self.targets, factors)
