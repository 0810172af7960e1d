"""What a model declares about its symmetry: mirror planes and rotational order."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from shapewright.errors import ModelError
from shapewright.modeling.elements import AXES, Axis, Element, Mirror, Turn
from shapewright.modeling.fields import ELEMENTS, choice, integer, read_object

MAX_ORDER = 1024
_AXIS = choice(*AXES)
_ORDER = integer(1, MAX_ORDER)


@dataclass(frozen=True)
class Symmetry:
    """Maps that leave every instance as it is.

    Attributes:
        mirrors: normals of mirror planes through the origin.
        axis: the axis through the origin about which it can be turned; ``None`` if there is none.
        order: of the rotation: a turn by 360 / order degrees changes nothing; 1 without an axis.
        apart: components that are left out (a tail rotor on one side).
    """

    mirrors: tuple[Axis, ...] = ()
    axis: Axis | None = None
    order: int = 1
    apart: tuple[Element, ...] = ()

    def __post_init__(self) -> None:
        if len(set(self.mirrors)) != len(self.mirrors):
            raise ModelError("a mirror plane is declared twice", where="symmetry.mirrors")
        if (self.axis is None) != (self.order == 1):
            raise ModelError("an axis needs an order above 1, and an order above 1 an axis", where="symmetry.order")
        if any(element.kind != "component" for element in self.apart):
            raise ModelError("only components can be apart, like 'c1'", where="symmetry.apart")

    def maps(self) -> dict[str, Float[np.ndarray, "3 3"]]:
        """Return the generating maps by what people call them, such as ``mirror y`` and ``turn 45 deg about z``."""
        found = {f"mirror {axis}": Mirror(axis).matrix() for axis in self.mirrors}
        if self.axis is not None:
            angle_deg = 360.0 / self.order
            found[f"turn {angle_deg:g} deg about {self.axis}"] = Turn(self.axis, angle_deg).matrix()
        return found

    def rotations(self) -> Float[np.ndarray, "G 3 3"]:
        """Return all turns that the maps make together, the identity first: two mirrors are half a turn."""
        mirrors = [np.eye(3)]
        for axis in self.mirrors:
            mirrors += [Mirror(axis).matrix() @ other for other in mirrors]
        turns = [np.eye(3)]
        if self.axis is not None:
            turns = [Turn(self.axis, 360.0 * step / self.order).matrix() for step in range(self.order)]
        maps = np.array([mirror @ turn for mirror in mirrors for turn in turns])
        proper = maps[np.linalg.det(maps) > 0]
        _, first = np.unique(proper.round(6) + 0.0, axis=0, return_index=True)
        return np.asarray(proper[np.sort(first)])

    @classmethod
    def from_document(cls, document: Any, where: str) -> "Symmetry":
        """Make it from its JSON object; raises ModelError."""
        item = read_object(document, where, {"mirrors", "axis", "order", "apart"})
        mirrors = item.get("mirrors", [])
        if not isinstance(mirrors, list):
            raise ModelError("a list is needed", where=f"{where}.mirrors")
        axis = item.get("axis")
        return cls(
            mirrors=tuple(_AXIS.read(mirror, f"{where}.mirrors[{i}]") for i, mirror in enumerate(mirrors)),
            axis=None if axis is None else _AXIS.read(axis, f"{where}.axis"),
            order=_ORDER.read(item.get("order", 1), f"{where}.order"),
            apart=ELEMENTS.read(item.get("apart", []), f"{where}.apart"),
        )

    def to_document(self) -> dict[str, Any]:
        """Return the JSON object."""
        return {
            "mirrors": list(self.mirrors),
            "axis": self.axis,
            "order": self.order,
            "apart": [str(component) for component in self.apart],
        }

    @staticmethod
    def schema() -> Mapping[str, Any]:
        """Return the JSON schema of the object."""
        return {
            "type": "object",
            "properties": {
                "mirrors": {"type": "array", "items": _AXIS.schema, "uniqueItems": True, "maxItems": 3},
                "axis": {"anyOf": [_AXIS.schema, {"type": "null"}]},
                "order": _ORDER.schema,
                "apart": ELEMENTS.schema,
            },
            "additionalProperties": False,
        }


NO_SYMMETRY = Symmetry()
