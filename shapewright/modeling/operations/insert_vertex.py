"""Insert a vertex on an edge at a barycentric coordinate (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element
from shapewright.modeling.fields import DIRECTED_EDGES, NUMBER, field
from shapewright.modeling.frames import TARGET_WORK
from shapewright.modeling.opcodes import INSERT, SLIDE
from shapewright.modeling.operations.operation import Mode, Operation, Step
from shapewright.modeling.program import Change, Changes, Program, SlottedQuantities


@dataclass(frozen=True)
class InsertVertex(Operation):
    """New vertices on edges, at lambda1 * start + (1 - lambda1) * end.

    The first half of an edge keeps its id. ``-e3`` stands for the edge e3 walked backwards, so that symmetric edges
    can be split symmetrically. Table 1 says how a position slides; we read the case lambda1 >= 0.5 as the mirror image
    of the other one.
    """

    kind: ClassVar[str] = "insert_vertex"
    quantities: ClassVar[tuple[str, ...]] = ("lambda1",)
    modes: ClassVar[Mapping[str, Mode]] = {"position": (Change("lambda1", SLIDE),)}

    edges: tuple[tuple[Element, bool], ...] = field(DIRECTED_EDGES)
    lambda1: float = field(NUMBER, 0.5)

    def __post_init__(self) -> None:
        if not 0.0 < self.lambda1 < 1.0:
            raise ModelError("lambda1 must lie between 0 and 1, without its ends")

    def apply(self, mesh: ControlMesh) -> Step:
        """Split the edges."""
        if not self.edges:
            raise ModelError("nothing is selected")
        rows = []
        for edge, backwards in self.edges:
            if edge.kind != "edge":
                raise ModelError(f"{edge} is not an edge")
            start, end = mesh.edge(edge.id)
            middle, _ = mesh.split_edge(edge.id)
            rows.append((middle, end, start) if backwards else (middle, start, end))
        mesh.spend(TARGET_WORK * len(rows))
        return _Inserted(self, tuple(rows))


@dataclass(frozen=True)
class _Inserted:
    operation: InsertVertex
    rows: tuple[tuple[int, int, int], ...]

    def write(self, program: Program, changes: Changes) -> None:
        quantities = SlottedQuantities(program, self.operation.amounts(), changes)
        for middle, start, end in self.rows:
            program.add(INSERT, (start, end), (middle,), quantities=quantities, fresh=True)
