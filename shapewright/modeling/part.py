"""Optional parts: components that are there under conditions, and leave nothing behind where they are not."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Int

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.dependence import CONDITIONS_SCHEMA, Condition, read_conditions
from shapewright.modeling.elements import Element
from shapewright.modeling.fields import ELEMENTS, read_object
from shapewright.modeling.opcodes import COLLAPSE
from shapewright.modeling.program import Program

MAX_PARTS = 200
MAX_PART_NAME = 200
ALWAYS = -1
"""The part number of what belongs to no part."""


@dataclass(frozen=True)
class Part:
    """Whole components that are present where all conditions hold.

    Attributes:
        name: what people read.
        components: at least one.
        present_when: at least one condition.
    """

    name: str
    components: tuple[Element, ...]
    present_when: tuple[Condition, ...]

    def __post_init__(self) -> None:
        if not self.name.strip() or len(self.name) > MAX_PART_NAME:
            raise ModelError(f"a part needs a name of at most {MAX_PART_NAME} characters")
        if not self.components or any(element.kind != "component" for element in self.components):
            raise ModelError(f"the part {self.name!r} must consist of components, like 'c1'")
        if not self.present_when:
            raise ModelError(f"the part {self.name!r} has no condition")

    @classmethod
    def from_document(cls, document: Any, where: str) -> "Part":
        """Make the part from its JSON object; raises ModelError."""
        item = read_object(document, where, {"name", "components", "present_when"})
        if not isinstance(item.get("name"), str):
            raise ModelError("a text is needed", where=f"{where}.name")
        try:
            return cls(
                name=item["name"],
                components=ELEMENTS.read(item.get("components"), f"{where}.components"),
                present_when=read_conditions(item.get("present_when"), f"{where}.present_when"),
            )
        except ModelError as error:
            raise ModelError(error.message, where=error.where or where) from None

    def to_document(self) -> dict[str, Any]:
        """Return the JSON object."""
        return {
            "name": self.name,
            "components": [str(component) for component in self.components],
            "present_when": [condition.to_document() for condition in self.present_when],
        }

    @staticmethod
    def schema() -> Mapping[str, Any]:
        """Return the JSON schema of the object."""
        return {
            "type": "object",
            "properties": {
                "name": {"type": "string", "pattern": "\\S", "maxLength": MAX_PART_NAME},
                "components": {**ELEMENTS.schema, "minItems": 1},
                "present_when": {**CONDITIONS_SCHEMA, "minItems": 1},
            },
            "required": ["name", "components", "present_when"],
            "additionalProperties": False,
        }


class PartVertices:
    """The parts of a model bound to its topology.

    Attributes:
        part_of: the part number of every vertex ever created, or ``ALWAYS``.
    """

    def __init__(self, mesh: ControlMesh, parts: Sequence[Part]) -> None:
        """Bind the parts.

        Raises:
            ModelError: no such component, one in two parts, none that is always present, or a face that
                connects a part with something else; ``where`` says which part.
        """
        component_parts = [ALWAYS] * mesh.n_components
        for number, part in enumerate(parts):
            for component in part.components:
                try:
                    mesh.check_component(component.id)
                except ModelError as error:
                    raise ModelError(error.message, where=f"parts[{number}].components") from None
                if component_parts[component.id] != ALWAYS:
                    raise ModelError(f"component {component} is in two parts", where=f"parts[{number}].components")
                component_parts[component.id] = number
        of_vertex = [component_parts[mesh.component_of(v)] for v in range(mesh.n_vertices)]
        for loop in mesh.faces.values():
            mixed = {of_vertex[v] for v in loop}
            if len(mixed) > 1:
                raise ModelError("a face connects it with what is not part of it", where=f"parts[{max(mixed)}]")
        self.part_of: Int[np.ndarray, " N"] = np.array(of_vertex, dtype=np.int64)
        self._vertices = [np.flatnonzero(self.part_of == number) for number in range(len(parts))]
        self._home: list[int] = []
        if parts:
            homes = [c for c in range(mesh.n_components) if component_parts[c] == ALWAYS]
            home = next((vertices for c in homes if (vertices := mesh.vertices_of_component(c))), None)
            if home is None:
                raise ModelError("at least one component must belong to no part", where="parts")
            self._home = home

    def write(self, program: Program) -> None:
        """Write instructions that draw absent parts together in the middle of a component that is always present.

        There they have no area and change no extent, so that all instances of a batch can share one topology.
        """
        if self._vertices:
            middle = program.mean(self._home)
            for number, vertices in enumerate(self._vertices):
                program.add(COLLAPSE, middle, vertices.tolist(), (number,), part=number)
