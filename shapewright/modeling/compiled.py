"""A compiled model: the topology once, then positions for batches of parameters (DESIGN.md, section 2)."""

import threading
from collections import defaultdict
from collections.abc import Iterator, Mapping

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.errors import ModelError, ParameterError
from shapewright.mesh import TriangleMesh
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.executable import link
from shapewright.modeling.parameter_space import ParameterSpace, Values
from shapewright.modeling.part import ALWAYS, PartVertices
from shapewright.modeling.procedural_model import ProceduralModel
from shapewright.modeling.program import Change, Program
from shapewright.modeling.subdivision import Polygons, SubdivisionStep, subdivide

SUBDIVISION_STEPS = 2
"""Surface sampling uses two steps (PAPER-NOTES, section 3)."""
MAX_SUBDIVISION_STEPS = 4
MAX_SURFACE_VERTICES = 1_000_000
MAX_SURFACE_WEIGHTS = 10_000_000
"""Bound on the entries of a subdivision matrix; a face of n corners makes about n x n of them."""
_CHUNK_BYTES = 64 * 2**20


class CompiledModel:
    """Evaluates a procedural model. Make it with :func:`compile_model`.

    Parameter values x are arrays (B, P), in the order of ``model.parameters``; a row is one instance, and the row
    of ones is the base model. All instances of a batch share one topology; a part that a row lacks is drawn together to
    a point inside the object. :meth:`instance` leaves it out.
    """

    def __init__(self, model: ProceduralModel) -> None:
        self.model = model
        self.space = ParameterSpace(model.parameters)
        mesh = ControlMesh()
        program = Program()
        changes: dict[int, list[tuple[Change, int]]] = defaultdict(list)
        for column, parameter in enumerate(model.parameters):
            for target in parameter.targets:
                mode = model.operations[target.operation].modes[target.mode]
                changes[target.operation] += [(change, column) for change in mode]
        for index, operation in enumerate(model.operations):
            try:
                step = operation.apply(mesh)
            except ModelError as error:
                raise ModelError(error.message, where=f"operations[{index}]") from None
            program.begin_operation()
            step.write(program, changes[index])
        self._parts = PartVertices(mesh, model.parts)
        for component in model.symmetry.apart:
            if component.id >= mesh.n_components:
                raise ModelError(f"component {component} does not exist", where="symmetry.apart")
        program.begin_operation()
        self._parts.write(program)
        self._live = np.array(mesh.live_vertices(), dtype=np.int64)
        self._executable = link(program, self._parts.part_of, self._live)
        self._control = _compact(mesh, self._live)
        self.is_closed = mesh.is_closed()
        self.control_components: Int[np.ndarray, " V"] = np.array([mesh.component_of(int(v)) for v in self._live])
        """The component of each row of :meth:`control_points`."""
        self.minimum = self.space.minimum
        self.maximum = self.space.maximum
        self._levels: list[SubdivisionStep] = []
        self._level_parts = [self._parts.part_of[self._live]]
        self._level_triangles: dict[int, Int[np.ndarray, "F 3"]] = {}
        self._growing = threading.RLock()  # several threads may ask for the same new level

    # ------------------------------------------------------------------ parameters

    @property
    def n_parameters(self) -> int:
        """P, the number of parameters."""
        return len(self.model.parameters)

    def base_values(self) -> Float[np.ndarray, " P"]:
        """Return the values of the base model: ones."""
        return self.space.base_values()

    def random_values(self, rng: np.random.Generator, count: int, fixed: Mapping[str, float] | None = None) -> Values:
        """Return ``count`` settled rows, every active parameter that is not fixed uniform in its range (section 3.2).

        Raises:
            ParameterError: a fixed value that the model cannot have; see :meth:`ParameterSpace.random_values`.
        """
        return self.space.random_values(rng, count, fixed)

    def settle(self, values: Values) -> Values:
        """Return the rows as they are meant: in their ranges, options whole, 1 where not active.

        Raises:
            ParameterError: the array has not P columns or holds NaN.
        """
        return self._settled(values)

    def values_from_mapping(self, named: Mapping[str, float]) -> Float[np.ndarray, " P"]:
        """Return one settled row from names; see :meth:`ParameterSpace.values_from_mapping`.

        Raises:
            ParameterError: an unknown name, a value that is not finite, out of its range or no option.
        """
        return self.space.values_from_mapping(named)

    def parts_present(self, values: Values) -> Bool[np.ndarray, "B N"]:
        """Tell which of ``model.parts`` each row's instance has.

        Raises:
            ParameterError: the array has not P columns or holds NaN.
        """
        return self._present(self._settled(values))

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
        return self._control_rows(self._settled(values))

    def surface_points(
        self, values: Float[np.ndarray, "B P"], steps: int = SUBDIVISION_STEPS
    ) -> Float[np.ndarray, "B V 3"]:
        """Return the vertices after ``steps`` subdivisions for each row of values.

        Work memory is bounded; the answer itself takes B x V x 24 bytes (see :meth:`surface_chunks`).

        Raises:
            ParameterError: the array has not P columns or holds NaN.
            ModelError: ``steps`` is out of range.
        """
        values = self._settled(values)
        points = np.empty((len(values), self.surface_polygons(steps).n_vertices, 3))
        for start, chunk in self._surface_chunks(values, steps):
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
        return self._surface_chunks(self._settled(values), steps)

    def _surface_chunks(self, values: Values, steps: int) -> Iterator[tuple[int, Float[np.ndarray, "C V 3"]]]:
        n_vertices = self.surface_polygons(steps).n_vertices
        for rows in self._batches(len(values), 24 * n_vertices):
            controls = self._control_rows(values[rows])
            count = len(controls)
            flat = controls.transpose(1, 2, 0).reshape(-1, 3 * count)
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
        with self._growing:
            if steps not in self._level_triangles:
                self._level_triangles[steps] = self.surface_polygons(steps).triangles()
            return self._level_triangles[steps]

    def instance(self, values: Float[np.ndarray, " P"], steps: int = SUBDIVISION_STEPS) -> TriangleMesh:
        """Return one instance as a mesh, without the parts that it lacks.

        Raises:
            ParameterError: not P values, or NaN.
            ModelError: ``steps`` is out of range.
        """
        return next(self.instances(np.asarray(values, dtype=np.float64)[None], steps))

    def instances(self, values: Float[np.ndarray, "B P"], steps: int = SUBDIVISION_STEPS) -> Iterator[TriangleMesh]:
        """Yield the instance of each row as :meth:`instance` does; evaluated in chunks, in bounded memory.

        Raises:
            ParameterError: the array has not P columns or holds NaN.
            ModelError: ``steps`` is out of range.
        """
        values = self._settled(values)
        triangles = self.surface_triangles(steps)
        present = self._present(values)
        for start, chunk in self._surface_chunks(values, steps):
            for row, points in enumerate(chunk, start):
                if present[row].all():
                    yield TriangleMesh(points, triangles)
                else:
                    kept = np.append(present[row], True)[self.surface_parts(steps)]  # ALWAYS is the last one
                    new_row = np.cumsum(kept) - 1
                    yield TriangleMesh(points[kept], new_row[triangles[kept[triangles[:, 0]]]])

    def surface_parts(self, steps: int = SUBDIVISION_STEPS) -> Int[np.ndarray, " V"]:
        """Return the part number of each vertex after ``steps`` subdivisions; -1 belongs to no part."""
        with self._growing:
            self.surface_polygons(steps)
            while len(self._level_parts) <= steps:
                level = self._levels[len(self._level_parts) - 1]
                refined = np.full(level.refined.n_vertices, ALWAYS)
                quads = np.array(level.refined.loops)  # each begins at a vertex of the level before
                refined[quads] = self._level_parts[-1][quads[:, :1]]
                self._level_parts.append(refined)
            return self._level_parts[steps]

    def _batches(self, count: int, row_bytes: int) -> Iterator[slice]:
        size = max(1, _CHUNK_BYTES // row_bytes)
        return (slice(start, start + size) for start in range(0, count, size))

    def _control_rows(self, settled: Values) -> Float[np.ndarray, "B V 3"]:
        return self._executable.run(settled, self._present(settled))

    def _present(self, settled: Values) -> Bool[np.ndarray, "B N"]:
        return self.space.holds_each([part.present_when for part in self.model.parts], settled)

    def _settled(self, values: Float[np.ndarray, "B P"]) -> Values:
        if values.ndim != 2 or values.shape[1] != self.n_parameters:
            raise ParameterError(f"values of shape {values.shape} are no batch of {self.n_parameters} parameters")
        if not np.isfinite(values).all():
            raise ParameterError("a value is not finite")
        return self.space.settle(values)


def compile_model(model: ProceduralModel) -> CompiledModel:
    """Build the topology of a model once; the result evaluates batches of parameters.

    Raises:
        ModelError: an operation names an element that does not exist yet, or is impossible there; or the mesh is open
            though ``closed`` says that it is not.
    """
    compiled = CompiledModel(model)
    if model.closed and not compiled.is_closed:
        raise ModelError("the model says that it is closed, but its mesh has open edges", where="closed")
    return compiled


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
