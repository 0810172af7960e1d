"""The Fisher information of a fit: how the surface answers to every parameter, and to the pose."""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from jaxtyping import Float, Int

from shapewright.errors import EstimationError

RIDGE: Final = 1e-8
"""Added to the diagonal of the information, in squared half extents for a whole range: a direction that nothing
determines gets a large variance instead of none. The limit of what counts as determined is 2.5e-5."""
N_POSE: Final = 7


@dataclass(frozen=True, eq=False)
class Information:
    """How far the surface moves along its normals when parameters and pose change, in units of the half extent.

    Columns are the active continuous parameters in their order, then the pose as in :func:`pose_columns`. What is known
    of the pose may have columns of zeros.

    Args:
        jacobian: of points of the surface that stand for equal areas.
        ranges: length of each parameter's range at the fitted values.
        scale_known: whether the last column, of the scale, is left out of what is refitted.

    Raises:
        EstimationError: not as many columns as parameters and pose have, no points, NaN, or a range that is not
            positive.
    """

    jacobian: Float[np.ndarray, "N C"]
    ranges: Float[np.ndarray, " A"]
    scale_known: bool = False

    def __post_init__(self) -> None:
        n_points, n_columns = self.jacobian.shape
        if n_columns != len(self.ranges) + N_POSE:
            expected = f"{len(self.ranges)} + {N_POSE} columns"
            raise EstimationError(f"expected {expected}, got {n_columns}", where="jacobian")
        if n_points == 0 or not np.isfinite(self.jacobian).all():
            raise EstimationError("expected at least one point and finite numbers", where="jacobian")
        if not (self.ranges > 0).all():
            raise EstimationError("expected positive ranges", where="ranges")

    @property
    def n_parameters(self) -> int:
        """A, the number of active continuous parameters."""
        return len(self.ranges)

    def with_known_scale(self) -> "Information":
        """Return what is known if the scale of the fit is taken for granted."""
        return self if self.scale_known else Information(self.jacobian, self.ranges, scale_known=True)

    @cached_property
    def matrix(self) -> Float[np.ndarray, "C C"]:
        """Fisher matrix F = J^T J / N with the ridge; a parameter is measured in shares of its range."""
        factors = np.ones(self.jacobian.shape[1])
        factors[: self.n_parameters] = self.ranges
        scaled = self.jacobian * factors
        return np.asarray(scaled.T @ scaled / len(scaled) + RIDGE * np.eye(scaled.shape[1]))

    @cached_property
    def covariance(self) -> Float[np.ndarray, "A A"]:
        """The block of F^-1 that belongs to the parameters, all else refitted; in shares of the ranges."""
        refitted = self.matrix[:-1, :-1] if self.scale_known else self.matrix
        inverse = np.linalg.inv(refitted)[: self.n_parameters, : self.n_parameters]
        return np.asarray((inverse + inverse.T) / 2)

    @cached_property
    def effects(self) -> Float[np.ndarray, " A"]:
        """Root mean square movement of the surface a whole range of each parameter, all else refitted.

        The square root of the Schur complement of the parameter in F.
        """
        return np.asarray(1.0 / np.sqrt(np.diagonal(self.covariance)))

    @cached_property
    def growth(self) -> Float[np.ndarray, " A"]:
        """Change of each parameter, in shares of its range, that does most nearly what growing everything does.

        For a model that can grow by its lengths, a length changes by its own value a unit of the scale's logarithm, and
        an angle not at all.
        """
        others, scale = self.matrix[:-1, :-1], self.matrix[:-1, -1]
        return np.asarray(np.linalg.solve(others, scale)[: self.n_parameters])

    def schur_complement(self, columns: Int[np.ndarray, " K"]) -> Float[np.ndarray, "K K"]:
        """Return the information about some parameters with all else refitted."""
        block = self.covariance[np.ix_(columns, columns)]
        inverse = np.linalg.inv(block)
        return np.asarray((inverse + inverse.T) / 2)


def pose_columns(points: Float[np.ndarray, "N 3"], normals: Float[np.ndarray, "N 3"]) -> Float[np.ndarray, "N 7"]:
    """Return the movement along the normals a radian, a unit and a unit of the scale's logarithm.

    The columns are three rotations about the axes, three translations, and the scale; about the mean of the points.

    Args:
        points: posed points of the surface, in units of the half extent.
        normals: their unit normals; of either side, if it is the one that the other columns were made with.
    """
    centred = points - points.mean(axis=0)
    growth = np.einsum("nd,nd->n", centred, normals)[:, None]
    return np.concatenate([np.cross(centred, normals), normals, growth], axis=1)
