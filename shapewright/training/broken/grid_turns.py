"""How the grids lie that positions are rounded to."""

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation


def grid_turn(rng: np.random.Generator) -> Float[np.ndarray, "3 3"]:
    """Return the turn from an object to a grid: half of the time none, else a random one.

    Most objects lie along the axes, and so do the grids of exports: a thin part then falls into one layer.
    """
    return np.asarray(Rotation.random(rng=rng).as_matrix() if rng.random() < 0.5 else np.eye(3))
