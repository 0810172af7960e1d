"""A candidate of the search: values of one model and the pose at which they stand."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from shapewright.distances.alignment import Pose
from shapewright.estimation.fast.fitted_model import FittedModel


@dataclass(frozen=True, eq=False)
class Curvature:
    """How the mean squared distance of the surface grows with the free parameters and the pose.

    Attributes:
        columns: of the free parameters, D of them.
        matrix: (D + 7, D + 7) for steps in shares of a parameter's range, then rotation vector, translation, and
            logarithm of the scale about the query's center.
    """

    columns: np.ndarray
    matrix: Float[np.ndarray, "N N"]


@dataclass(frozen=True, eq=False)
class Candidate:
    """Settled values of a model at a pose in the normalized space of the query.

    Attributes:
        model: what it is an instance of.
        values: (P,) settled.
        rotation: (3, 3).
        translation: (3,).
        scale: positive.
        misfit: mean distance of closest points, both ways; infinite if not measured.
        zbuffer: z-buffer distance; infinite if not measured.
        curvature: of the last least squares, if there was one.
    """

    model: FittedModel
    values: Float[np.ndarray, " P"]
    rotation: Float[np.ndarray, "3 3"]
    translation: Float[np.ndarray, " 3"]
    scale: float
    misfit: float = np.inf
    zbuffer: float = np.inf
    curvature: Curvature | None = None

    @property
    def pose(self) -> Pose:
        """The pose, model space to normalized query space."""
        return Pose(self.rotation, self.translation, self.scale)

    def placed(self, points: Float[np.ndarray, "V 3"]) -> Float[np.ndarray, "V 3"]:
        """Return points of model space in the space of the query."""
        return points @ (self.scale * self.rotation.T) + self.translation

    def with_values(self, values: Float[np.ndarray, " P"]) -> "Candidate":
        """Return the candidate with other values, settled, not measured yet."""
        return replace(self, values=self.model.settle(values), misfit=np.inf, zbuffer=np.inf)

    def moved(self, columns: np.ndarray, step: Float[np.ndarray, " N"], center: Float[np.ndarray, " 3"]) -> "Candidate":
        """Return the candidate after a step of D parameters and the pose; see :class:`Curvature` for its units."""
        count = len(columns)
        values = self.values.copy()
        values[columns] += step[:count] * self.model.widths[columns]
        turn = Rotation.from_rotvec(step[count : count + 3]).as_matrix()
        growth = float(np.exp(step[count + 6]))
        return replace(
            self,
            values=self.model.settle(values),
            rotation=turn @ self.rotation,
            translation=center + growth * (turn @ (self.translation - center)) + step[count + 3 : count + 6],
            scale=self.scale * growth,
            misfit=np.inf,
            zbuffer=np.inf,
        )
