"""Orientations of the grids that positions are rounded to."""

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation


def grid_turn(rng: np.random.Generator) -> Float[np.ndarray, "3 3"]:
    """Return the rotation from an object to a grid: half of the time the identity, otherwise random.

    Most objects and the grids of exporters are aligned with the axes, so a thin part falls into one layer.
    """
    return np.asarray(Rotation.random(rng=rng).as_matrix() if rng.random() < 0.5 else np.eye(3))
