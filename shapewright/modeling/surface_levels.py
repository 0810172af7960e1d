"""The surfaces of a control mesh after one, two, ... subdivisions: what is made once for all instances."""

import threading

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from shapewright.errors import ModelError
from shapewright.modeling.executable import multiply
from shapewright.modeling.part import ALWAYS
from shapewright.modeling.subdivision import Polygons, SubdivisionStep, subdivide

MAX_SUBDIVISION_STEPS = 4
MAX_SURFACE_VERTICES = 1_000_000
MAX_SURFACE_WEIGHTS = 10_000_000
"""Bound on the entries of a subdivision matrix; a face of n corners makes about n x n of them."""


class SurfaceLevels:
    """Topology, parts and matrices after any number of subdivisions, each made when it is first asked for.

    Several threads may ask at once. All methods raise ModelError if the number of steps is out of range, or if there
    would be too many vertices or weights.
    """

    def __init__(self, control: Polygons, part_of: Int[np.ndarray, " V"]) -> None:
        self._control = control
        self._levels: list[SubdivisionStep] = []
        self._parts = [part_of]
        self._triangles: dict[int, Int[np.ndarray, "F 3"]] = {}
        self._matrices = [sparse.eye_array(control.n_vertices, format="csr")]
        self._growing = threading.RLock()

    def polygons(self, steps: int) -> Polygons:
        """Return the topology after ``steps`` subdivisions."""
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

    def triangles(self, steps: int) -> Int[np.ndarray, "F 3"]:
        """Return the triangles after ``steps`` subdivisions."""
        with self._growing:
            if steps not in self._triangles:
                self._triangles[steps] = self.polygons(steps).triangles()
            return self._triangles[steps]

    def parts(self, steps: int) -> Int[np.ndarray, " V"]:
        """Return the part number of each vertex after ``steps`` subdivisions; ``ALWAYS`` belongs to no part."""
        with self._growing:
            self.polygons(steps)
            while len(self._parts) <= steps:
                level = self._levels[len(self._parts) - 1]
                refined = np.full(level.refined.n_vertices, ALWAYS)
                quads = np.array(level.refined.loops)  # each begins at a vertex of the level before
                refined[quads] = self._parts[-1][quads[:, :1]]
                self._parts.append(refined)
            return self._parts[steps]

    def matrix(self, steps: int) -> sparse.csr_array:
        """Return the matrix (V', V) that makes surface vertices of control vertices; every row sums to 1."""
        with self._growing:
            self.polygons(steps)
            while len(self._matrices) <= steps:
                self._matrices.append(_product(self._levels[len(self._matrices) - 1].matrix, self._matrices[-1]))
            return self._matrices[steps]

    def refine(
        self, points: Float[np.ndarray, "B V 3"], steps: int, surface: Float[np.ndarray, "B W 3"] | None = None
    ) -> Float[np.ndarray, "B W 3"]:
        """Return the surface vertices of a batch of control vertices, in ``surface`` if that is given."""
        n_vertices = self.polygons(steps).n_vertices
        surface = np.empty((len(points), n_vertices, 3)) if surface is None else surface
        for number, level in enumerate(self._levels[:steps], 1):
            refined = surface if number == steps else np.empty((len(points), level.refined.n_vertices, 3))
            multiply(level.matrix, points, refined)
            points = refined
        if steps == 0:
            surface[:] = points
        return surface


def _product(later: sparse.csr_array, earlier: sparse.csr_array) -> sparse.csr_array:
    n_weights = np.diff(earlier.indptr)[later.indices].sum()  # at most: entries at one place add up
    if n_weights > MAX_SURFACE_WEIGHTS:
        raise ModelError("the faces have too many corners for a matrix of all subdivisions")
    product = later @ earlier
    product.sort_indices()
    return product
