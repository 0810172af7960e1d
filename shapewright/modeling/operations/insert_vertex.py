"""Insert a vertex on an edge at a barycentric coordinate (Table 1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Int

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element
from shapewright.modeling.fields import DIRECTED_EDGES, NUMBER, field
from shapewright.modeling.frames import TARGET_WORK, Positions
from shapewright.modeling.operations.operation import Amounts, Mode, Operation, Quantities, Step


def _slides(quantities: Quantities, x: Amounts) -> Quantities:
    """Table 1, with the case lambda >= 0.5 read as the mirror image of the other (PAPER-NOTES)."""
    position = quantities["lambda1"]
    return {"lambda1": np.where(position < 0.5, x * position, 1.0 - (2.0 - x) * (1.0 - position))}


@dataclass(frozen=True)
class InsertVertex(Operation):
    """New vertices on edges, at lambda1 * start + (1 - lambda1) * end.

    The first half of an edge keeps its id. ``-e3`` stands for the edge e3 walked backwards, so that symmetric edges
    can be split symmetrically.
    """

    kind: ClassVar[str] = "insert_vertex"
    quantities: ClassVar[tuple[str, ...]] = ("lambda1",)
    modes: ClassVar[Mapping[str, Mode]] = {"position": _slides}

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
        return _Inserted(_runs(rows))


@dataclass(frozen=True, eq=False)
class _Inserted:
    runs: tuple[Int[np.ndarray, "3 N"], ...]

    def reads(self) -> set[int]:
        return {int(v) for _, start, end in self.runs for v in (*start, *end)}

    def writes(self) -> set[int]:
        return {int(v) for middle, _, _ in self.runs for v in middle}

    def move(self, positions: Positions, quantities: Quantities) -> None:
        share = quantities["lambda1"]
        for middle, start, end in self.runs:
            positions[middle] = share * positions[start] + (1.0 - share) * positions[end]


def _runs(rows: list[tuple[int, int, int]]) -> tuple[Int[np.ndarray, "3 N"], ...]:
    """Put rows together that do not build on each other: an edge may be split twice in one operation."""
    runs: list[list[tuple[int, int, int]]] = [[]]
    fresh: set[int] = set()
    for middle, start, end in rows:
        if start in fresh or end in fresh:
            runs.append([])
            fresh = set()
        fresh.add(middle)
        runs[-1].append((middle, start, end))
    return tuple(np.array(run, dtype=np.int64).T for run in runs)
