"""A compiled model: the topology once, then positions for batches of parameters."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse

from shapewright.errors import ModelError, ParameterError
from shapewright.mesh import TriangleMesh
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.executable import link, multiply
from shapewright.modeling.parameter_space import ParameterSpace, Values
from shapewright.modeling.part import PartVertices
from shapewright.modeling.procedural_model import ProceduralModel
from shapewright.modeling.program import Change, Program
from shapewright.modeling.subdivision import Polygons
from shapewright.modeling.surface_levels import SurfaceLevels

SUBDIVISION_STEPS = 2
"""Surface sampling uses two steps."""
_CHUNK_BYTES = 64 * 2**20

Present = Bool[np.ndarray, "B N"]


class CompiledModel:
    """Evaluates a procedural model. Make it with :func:`compile_model`.

    Parameter values x are arrays (B, P), in the order of ``model.parameters``; a row is one instance, and the row
    of ones is the base model. All instances of a batch share one topology; a part that a row lacks is drawn together to
    a point inside the object. :meth:`instance` leaves it out.
    """

    def __init__(self, model: ProceduralModel) -> None:
        self.model = model
        self.space = ParameterSpace(model.parameters)
        self._presence = self.space.flat([part.present_when for part in model.parts])
        mesh = ControlMesh()
        program = Program()
        changes = changes_of(model)
        for index, operation in enumerate(model.operations):
            try:
                step = operation.apply(mesh)
            except ModelError as error:
                raise ModelError(error.message, where=f"operations[{index}]") from None
            program.begin_operation()
            step.write(program, changes.get(index, ()))
        self._parts = PartVertices(mesh, model.parts)
        for component in model.symmetry.apart:
            if component.id >= mesh.n_components:
                raise ModelError(f"component {component} does not exist", where="symmetry.apart")
        program.begin_operation()
        self._parts.write(program)
        self._live = np.array(mesh.live_vertices(), dtype=np.int64)
        self._executable = link(program, self._parts.part_of, self._live)
        self._surface = SurfaceLevels(_compact(mesh, self._live), self._parts.part_of[self._live])
        self.is_closed = mesh.is_closed()
        self.control_components: Int[np.ndarray, " V"] = np.array([mesh.component_of(int(v)) for v in self._live])
        """The component of each row of :meth:`control_points`."""
        self.minimum = self.space.minimum
        self.maximum = self.space.maximum

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
        return self._settled(values)[0]

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
        return self._settled(values)[1]

    # ------------------------------------------------------------------ geometry

    @property
    def control_faces(self) -> tuple[tuple[int, ...], ...]:
        """The polygons of the control mesh, as rows of :meth:`control_points`."""
        return self._surface.polygons(0).loops

    @property
    def control_vertex_ids(self) -> Int[np.ndarray, " V"]:
        """The stable vertex id of each row of :meth:`control_points`."""
        return self._live

    def control_points(self, values: Float[np.ndarray, "B P"]) -> Float[np.ndarray, "B V 3"]:
        """Return the control mesh's vertices for each row of values.

        Raises:
            ParameterError: the array has not P columns or holds NaN.
        """
        return self._executable.run(*self._settled(values))

    def surface_points(
        self, values: Float[np.ndarray, "B P"], steps: int = SUBDIVISION_STEPS
    ) -> Float[np.ndarray, "B V 3"]:
        """Return the vertices after ``steps`` subdivisions for each row of values.

        Work memory is bounded; the answer itself takes B x V x 24 bytes (see :meth:`surface_chunks`).

        Raises:
            ParameterError: the array has not P columns or holds NaN.
            ModelError: ``steps`` is out of range.
        """
        settled, present = self._settled(values)
        points = np.empty((len(values), self.surface_polygons(steps).n_vertices, 3))
        for rows in _chunks(points.shape):
            self._surface.refine(self._executable.run(settled[rows], present[rows]), steps, points[rows])
        return points

    def combined_points(self, values: Float[np.ndarray, "B P"], matrix: sparse.csr_array) -> Float[np.ndarray, "B W 3"]:
        """Return ``matrix @ control_points`` for each row of values: points at fixed places of the surface, say.

        Args:
            values: a batch.
            matrix: (W, V), such as barycentric weights (W, V') times :meth:`surface_matrix` (V', V).

        Raises:
            ParameterError: the array has not P columns or holds NaN.
            ModelError: the matrix has not V columns.
        """
        if matrix.shape[1] != len(self._live):
            raise ModelError(f"expected a matrix of {len(self._live)} columns, got {matrix.shape[1]}")
        settled, present = self._settled(values)
        points = np.empty((len(values), matrix.shape[0], 3))
        for rows in _chunks((len(values), max(matrix.shape), 3)):
            multiply(matrix, self._executable.run(settled[rows], present[rows]), points[rows])
        return points

    def surface_chunks(
        self, values: Float[np.ndarray, "B P"], steps: int = SUBDIVISION_STEPS
    ) -> Iterator[tuple[int, Float[np.ndarray, "C V 3"]]]:
        """Yield (first row, vertices (C, V, 3)) for chunks of a batch of any size, in bounded memory.

        Raises:
            ParameterError: the array has not P columns or holds NaN.
            ModelError: ``steps`` is out of range.
        """
        return self._surface_chunks(*self._settled(values), steps)

    def _surface_chunks(
        self, settled: Values, present: Present, steps: int
    ) -> Iterator[tuple[int, Float[np.ndarray, "C V 3"]]]:
        for rows in _chunks((len(settled), self.surface_polygons(steps).n_vertices, 3)):
            yield rows.start, self._surface.refine(self._executable.run(settled[rows], present[rows]), steps)

    def surface_matrix(self, steps: int = SUBDIVISION_STEPS) -> sparse.csr_array:
        """Return the matrix (V', V) that makes vertices after ``steps`` subdivisions of :meth:`control_points`.

        Raises:
            ModelError: ``steps`` is out of range, or the matrix would have too many entries.
        """
        return self._surface.matrix(steps)

    def surface_polygons(self, steps: int = SUBDIVISION_STEPS) -> Polygons:
        """Return the topology after ``steps`` subdivisions; raises ModelError if that is out of range."""
        return self._surface.polygons(steps)

    def surface_triangles(self, steps: int = SUBDIVISION_STEPS) -> Int[np.ndarray, "F 3"]:
        """Return the triangles after ``steps`` subdivisions, the same for every instance."""
        return self._surface.triangles(steps)

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
        settled, present = self._settled(values)
        triangles = self.surface_triangles(steps)
        for start, chunk in self._surface_chunks(settled, present, steps):
            for row, points in enumerate(chunk, start):
                if present[row].all():
                    yield TriangleMesh(points, triangles)
                else:
                    kept = np.append(present[row], True)[self.surface_parts(steps)]  # ALWAYS is the last one
                    new_row = np.cumsum(kept) - 1
                    yield TriangleMesh(points[kept], new_row[triangles[kept[triangles[:, 0]]]])

    def surface_parts(self, steps: int = SUBDIVISION_STEPS) -> Int[np.ndarray, " V"]:
        """Return the part number of each vertex after ``steps`` subdivisions; -1 belongs to no part."""
        return self._surface.parts(steps)

    def _settled(self, values: Float[np.ndarray, "B P"]) -> tuple[Values, Present]:
        if values.ndim != 2 or values.shape[1] != self.n_parameters:
            raise ParameterError(f"values of shape {values.shape} are no batch of {self.n_parameters} parameters")
        if not np.isfinite(values).all():
            raise ParameterError("a value is not finite")
        return self.space.settle_and_hold(self._presence, values)


def changes_of(model: ProceduralModel) -> Mapping[int, Sequence[tuple[Change, int]]]:
    """Return what the parameters change of each operation, by its index: the changes and the parameter's column."""
    changes: dict[int, list[tuple[Change, int]]] = defaultdict(list)
    for column, parameter in enumerate(model.parameters):
        for target in parameter.targets:
            mode = model.operations[target.operation].modes[target.mode]
            changes[target.operation] += [(change, column) for change in mode]
    return changes


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


def _chunks(shape: tuple[int, int, int]) -> Iterator[slice]:
    """Yield the rows of a batch of points in pieces of bounded size."""
    count, n_points, _ = shape
    size = max(1, _CHUNK_BYTES // (24 * max(1, n_points)))
    return (slice(start, start + size) for start in range(0, count, size))


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
