"""Noise: points of the surface that were measured wrongly, each alone or together with its neighbors."""

from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.ndimage import map_coordinates

from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.training.broken.dense_points import dense_points

DEVIATIONS: Final = (0.002, 0.012)
"""Smallest and largest standard deviation along each axis, as shares of the diagonal; drawn on a logarithmic scale."""
_WIDTHS: Final = (0.005, 0.04)
"""Distance, in diagonals, over which errors are alike."""


def shake_surface(mesh: TriangleMesh | PointCloud, rng: np.random.Generator) -> PointCloud:
    """Move points of the surface by a random field: Gaussian, and alike over a random distance."""
    points = dense_points(mesh)
    low, high = points.min(axis=0), points.max(axis=0)
    diagonal = float(np.linalg.norm(high - low))
    deviation = float(np.exp(rng.uniform(*np.log(DEVIATIONS)))) * diagonal
    width = float(np.exp(rng.uniform(*np.log(_WIDTHS)))) * diagonal
    return PointCloud(points + deviation * _field((points - low) / width, rng))


def _field(places: Float[np.ndarray, "N 3"], rng: np.random.Generator) -> Float[np.ndarray, "N 3"]:
    """Return random vectors of unit variance along each axis, interpolated between the points of a lattice.

    The lattice repeats after 32 cells, far enough away for nobody to notice.
    """
    lattice = rng.normal(size=(3, 32, 32, 32))
    at = places.T
    values = np.stack([map_coordinates(axis, at, order=1, mode="grid-wrap") for axis in lattice], axis=1)
    return np.asarray(values / max(float(values.std()), 1e-12))
