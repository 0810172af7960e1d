"""Series of random variations of a procedural model, which can be drawn again from a seed, a digest and a number."""

from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.estimation.generator import InstanceGenerator

SERIES: Final = 64
"""Meshes that one random generator gives at most; the shorter series are beginnings of the longer ones."""


def series_generators(seed: int, digest: str, number: int) -> tuple[np.random.Generator, np.random.Generator]:
    """The random streams of the meshes and of the views of one series of a source."""
    first, second = np.random.default_rng([seed, int(digest[:16], 16), number]).spawn(2)
    return first, second


def series_values(generator: InstanceGenerator, rng: np.random.Generator, count: int) -> Float[np.ndarray, "B P"]:
    """The parameter values of the first ``count`` (at most :data:`SERIES`) variations of a series."""
    return generator.random_values(rng, SERIES)[:count]
