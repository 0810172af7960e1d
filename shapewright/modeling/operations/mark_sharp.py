"""Mark edges as creases and vertices as corners, or smooth them again."""

from dataclasses import dataclass
from typing import ClassVar

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element
from shapewright.modeling.fields import ELEMENTS, FLAG, field
from shapewright.modeling.operations.operation import NO_MOVE, Operation, Step


@dataclass(frozen=True)
class MarkSharp(Operation):
    """Edges become creases (a face: all its edges) and vertices corners; with ``sharp`` false, smooth."""

    kind: ClassVar[str] = "mark_sharp"

    elements: tuple[Element, ...] = field(ELEMENTS)
    sharp: bool = field(FLAG, True)

    def apply(self, mesh: ControlMesh) -> Step:
        """Mark the elements."""
        if not self.elements:
            raise ModelError("nothing is selected")
        for element in self.elements:
            if element.kind == "vertex":
                mesh.vertices_of([element])
                _mark(mesh.sharp_vertices, element.id, self.sharp)
            elif element.kind == "edge":
                mesh.edge(element.id)
                _mark(mesh.sharp_edges, element.id, self.sharp)
            elif element.kind == "face":
                loop = mesh.face(element.id)
                for first, second in zip(loop, (*loop[1:], loop[0]), strict=True):
                    _mark(mesh.sharp_edges, mesh.edge_between(first, second), self.sharp)
            else:
                raise ModelError("mark the edges, faces or vertices of a component, not the component")
        return NO_MOVE


def _mark(marked: set[int], element_id: int, sharp: bool) -> None:
    (marked.add if sharp else marked.discard)(element_id)
