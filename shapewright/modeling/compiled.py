"""A compiled model: the topology once, then positions for batches of parameters (DESIGN.md, section 2)."""

import math
import threading
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from shapewright.errors import ModelError, ParameterError
from shapewright.mesh import TriangleMesh
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.fields import shown
from shapewright.modeling.frames import Positions
from shapewright.modeling.operations import Operation
from shapewright.modeling.operations.operation import Quantities, Step
from shapewright.modeling.subdivision import Polygons, SubdivisionStep, subdivide

if TYPE_CHECKING:
    from shapewright.modeling.procedural_model import ProceduralModel

SUBDIVISION_STEPS = 2
"""Surface sampling uses two steps (PAPER-NOTES, section 3)."""
MAX_SUBDIVISION_STEPS = 4
MAX_SURFACE_VERTICES = 1_000_000
MAX_SURFACE_WEIGHTS = 10_000_000
"""Bound on the entries of a subdivision matrix; a face of n corners makes about n x n of them."""
_CHUNK_BYTES = 64 * 2**20

Values = Float[np.ndarray, "B P"]


@dataclass(frozen=True)
class _BoundStep:
    """The step of one operation and the parameters (column, mode) that change its quantities."""

    step: Step
    operation: Operation
    bindings: tuple[tuple[int, str], ...]

    def quantities(self, values: Values) -> Quantities:
        count = len(values)
        amounts: Quantities = {
            name: np.full(count, float(getattr(self.operation, name))) for name in self.operation.quantities
        }
        for column, mode in self.bindings:
            amounts = self.operation.modes[mode](amounts, values[:, column])
        return amounts


class CompiledModel:
    """Evaluates a procedural model. Make it with :meth:`ProceduralModel.compile`.

    Parameter values x are arrays (B, P), in the order of ``model.parameters``; a row is one instance, and the row
    of ones is the base model. All instances share one topology.
    """

    def __init__(self, model: "ProceduralModel") -> None:
        self.model = model
        mesh = ControlMesh()
        steps = []
        bindings: dict[int, list[tuple[int, str]]] = defaultdict(list)
        for column, parameter in enumerate(model.parameters):
            for target in parameter.targets:
                bindings[target.operation].append((column, target.mode))
        most_work = 0
        for index, operation in enumerate(model.operations):
            work_before = mesh.work
            try:
                steps.append(_BoundStep(operation.apply(mesh), operation, tuple(bindings[index])))
            except ModelError as error:
                raise ModelError(error.message, where=f"operations[{index}]") from None
            most_work = max(most_work, mesh.work - work_before)
        self._steps = tuple(steps)
        self._n_created = mesh.n_vertices
        self._row_bytes = 24 * max(mesh.n_vertices, most_work)  # of one instance, while a step is at work
        self._live = np.array(mesh.live_vertices(), dtype=np.int64)
        self._control = _compact(mesh, self._live)
        self.is_closed = mesh.is_closed()
        self.minimum: Float[np.ndarray, " P"] = np.array([p.minimum for p in model.parameters], dtype=np.float64)
        self.maximum: Float[np.ndarray, " P"] = np.array([p.maximum for p in model.parameters], dtype=np.float64)
        self._levels: list[SubdivisionStep] = []
        self._growing = threading.Lock()  # several threads may ask for the same new level

    # ------------------------------------------------------------------ parameters

    @property
    def n_parameters(self) -> int:
        """P, the number of parameters."""
        return len(self.model.parameters)

    def base_values(self) -> Float[np.ndarray, " P"]:
        """Return the values of the base model: ones."""
        return np.ones(self.n_parameters)

    def random_values(self, rng: np.random.Generator, count: int) -> Float[np.ndarray, "B P"]:
        """Return ``count`` rows, every parameter uniform in its range (paper section 3.2)."""
        return rng.uniform(self.minimum, self.maximum, size=(count, self.n_parameters))

    def values_from_mapping(self, named: Mapping[str, float]) -> Float[np.ndarray, " P"]:
        """Return one row from names; what is not named stays 1.

        Raises:
            ParameterError: an unknown name, a value that is not finite or out of its range.
        """
        columns = {parameter.name: i for i, parameter in enumerate(self.model.parameters)}
        values = self.base_values()
        for name, value in named.items():
            if name not in columns:
                known = ", ".join(columns) or "none"
                raise ParameterError(f"the model has no parameter {name!r}; it has: {known}", where=f"values.{name}")
            parameter = self.model.parameters[columns[name]]
            if value != value or abs(value) == math.inf:  # math.isfinite overflows on very long whole numbers
                raise ParameterError("the value is not finite", where=f"values.{name}")
            if not parameter.minimum <= value <= parameter.maximum:
                raise ParameterError(
                    f"{shown(value)} is outside of [{parameter.minimum:g}, {parameter.maximum:g}]",
                    where=f"values.{name}",
                )
            values[columns[name]] = value
        return values

    # ------------------------------------------------------------------ geometry

    @property
    def control_faces(self) -> tuple[tuple[int, ...], ...]:
        """The polygons of the control mesh, as rows of :meth:`control_points`."""
        return self._control.loops

    @property
    def control_vertex_ids(self) -> Int[np.ndarray, " V"]:
        """The stable vertex id of each row of :meth:`control_points`."""
        return self._live

    def control_points(self, values: Float[np.ndarray, "B P"]) -> Float[np.ndarray, "B V 3"]:
        """Return the control mesh's vertices for each row of values.

        Raises:
            ParameterError: the array has not P columns or holds NaN.
        """
        values = self._checked(values)
        points = np.empty((len(values), len(self._live), 3))
        for rows in self._batches(len(values), self._row_bytes):
            points[rows] = self._control_rows(values[rows]).transpose(2, 0, 1)
        return points

    def surface_points(
        self, values: Float[np.ndarray, "B P"], steps: int = SUBDIVISION_STEPS
    ) -> Float[np.ndarray, "B V 3"]:
        """Return the vertices after ``steps`` subdivisions for each row of values.

        Work memory is bounded; the answer itself takes B x V x 24 bytes (see :meth:`surface_chunks`).

        Raises:
            ParameterError: the array has not P columns or holds NaN.
            ModelError: ``steps`` is out of range.
        """
        values = self._checked(values)
        points = np.empty((len(values), self.surface_polygons(steps).n_vertices, 3))
        for start, chunk in self.surface_chunks(values, steps):
            points[start : start + len(chunk)] = chunk
        return points

    def surface_chunks(
        self, values: Float[np.ndarray, "B P"], steps: int = SUBDIVISION_STEPS
    ) -> Iterator[tuple[int, Float[np.ndarray, "C V 3"]]]:
        """Yield (first row, vertices (C, V, 3)) for chunks of a batch of any size, in bounded memory.

        Raises:
            ParameterError: the array has not P columns or holds NaN.
            ModelError: ``steps`` is out of range.
        """
        values = self._checked(values)
        n_vertices = self.surface_polygons(steps).n_vertices
        for rows in self._batches(len(values), max(24 * n_vertices, self._row_bytes)):
            controls = self._control_rows(values[rows])
            count = controls.shape[2]
            flat = controls.reshape(-1, 3 * count)
            for level in self._levels[:steps]:
                flat = level.matrix @ flat
            yield rows.start, np.ascontiguousarray(flat.reshape(-1, 3, count).transpose(2, 0, 1))

    def surface_polygons(self, steps: int = SUBDIVISION_STEPS) -> Polygons:
        """Return the topology after ``steps`` subdivisions; raises ModelError if that is out of range."""
        if not 0 <= steps <= MAX_SUBDIVISION_STEPS:
            raise ModelError(f"subdivision steps must be 0 to {MAX_SUBDIVISION_STEPS}")
        with self._growing:
            while len(self._levels) < steps:
                polygons = self._levels[-1].refined if self._levels else self._control
                if sum(map(len, polygons.loops)) > MAX_SURFACE_VERTICES:
                    raise ModelError(f"more than {MAX_SURFACE_VERTICES} vertices after {steps} subdivisions")
                if sum(len(loop) ** 2 for loop in polygons.loops) > MAX_SURFACE_WEIGHTS:
                    raise ModelError("the faces have too many corners to be subdivided")
                self._levels.append(subdivide(polygons))
        return self._levels[steps - 1].refined if steps else self._control

    def surface_triangles(self, steps: int = SUBDIVISION_STEPS) -> Int[np.ndarray, "F 3"]:
        """Return the triangles after ``steps`` subdivisions, the same for every instance."""
        if steps == SUBDIVISION_STEPS:
            return self._default_triangles
        return self.surface_polygons(steps).triangles()

    def instance(self, values: Float[np.ndarray, " P"], steps: int = SUBDIVISION_STEPS) -> TriangleMesh:
        """Return one instance as a mesh.

        Raises:
            ParameterError: not P values, or NaN.
            ModelError: ``steps`` is out of range.
        """
        points = self.surface_points(np.asarray(values, dtype=np.float64)[None], steps)[0]
        return TriangleMesh(points, self.surface_triangles(steps))

    @cached_property
    def _default_triangles(self) -> Int[np.ndarray, "F 3"]:
        return self.surface_polygons(SUBDIVISION_STEPS).triangles()

    def _batches(self, count: int, row_bytes: int) -> Iterator[slice]:
        size = max(1, _CHUNK_BYTES // row_bytes)
        return (slice(start, start + size) for start in range(0, count, size))

    def _control_rows(self, values: Values) -> Positions:
        positions = np.zeros((self._n_created, 3, len(values)))
        for bound in self._steps:
            bound.step.move(positions, bound.quantities(values))
        return positions[self._live]

    def _checked(self, values: Float[np.ndarray, "B P"]) -> Values:
        if values.ndim != 2 or values.shape[1] != self.n_parameters:
            raise ParameterError(f"values of shape {values.shape} are no batch of {self.n_parameters} parameters")
        if not np.isfinite(values).all():
            raise ParameterError("a value is not finite")
        return np.asarray(values, dtype=np.float64)


def _compact(mesh: ControlMesh, live: Int[np.ndarray, " V"]) -> Polygons:
    row = {int(vertex): i for i, vertex in enumerate(live)}
    return Polygons(
        n_vertices=len(live),
        loops=tuple(tuple(row[v] for v in mesh.faces[f]) for f in sorted(mesh.faces)),
        sharp_edges=frozenset(
            (min(row[a], row[b]), max(row[a], row[b])) for a, b in (mesh.edges[e] for e in mesh.sharp_edges)
        ),
        sharp_vertices=frozenset(row[v] for v in mesh.sharp_vertices if v in row),
    )
