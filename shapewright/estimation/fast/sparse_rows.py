"""Points as weighted sums of control points, in the one form that the kernels are compiled for."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from shapewright.estimation.sampling_kernels import combine_rows, make_points


@dataclass(frozen=True, eq=False)
class SparseRows:
    """A sparse matrix (N, V) in CSR form that makes N points of V control points.

    Attributes:
        starts: (N + 1,) where each row begins.
        columns, entries: of the K entries.
        n_columns: V.
    """

    starts: Int[np.ndarray, " N1"]
    columns: Int[np.ndarray, " K"]
    entries: Float[np.ndarray, " K"]
    n_columns: int

    @classmethod
    def of(cls, matrix: sparse.csr_array) -> "SparseRows":
        """Take the rows of a matrix."""
        return cls(
            np.asarray(matrix.indptr, dtype=np.int64),
            np.asarray(matrix.indices, dtype=np.int64),
            np.asarray(matrix.data, dtype=np.float64),
            matrix.shape[1],
        )

    def __len__(self) -> int:
        return len(self.starts) - 1

    def first(self, count: int) -> "SparseRows":
        """Return the first rows alone."""
        end = self.starts[count]
        return SparseRows(self.starts[: count + 1], self.columns[:end], self.entries[:end], self.n_columns)

    def points(self, control: Float[np.ndarray, "V 3"]) -> Float[np.ndarray, "N 3"]:
        """Return the points."""
        points = np.empty((len(self), 3))
        make_points(self.starts, self.columns, self.entries, np.ascontiguousarray(control), points)
        return points

    def combined(
        self, faces: Int[np.ndarray, " M"], weights: Float[np.ndarray, "M 3"], triangles: Int[np.ndarray, "F 3"]
    ) -> "SparseRows":
        """Return the rows that make barycentric samples of the triangles between the points."""
        starts, columns, entries = combine_rows(
            faces, weights, triangles, self.starts, self.columns, self.entries, self.n_columns
        )
        return SparseRows(starts, columns, entries, self.n_columns)
