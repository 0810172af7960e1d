"""Better starts from near ones: random steps that shrink, measured by panorama distance, which needs no pose (ours).

Each round draws candidates around the best, evaluates them in one batch, and goes on from the best of all: a few rounds
of the cross-entropy method (Rubinstein 1999).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.distances.panorama import PanoramaDescriptor, panorama_descriptors, panorama_distances
from shapewright.estimation.generator import InstanceGenerator

CANDIDATES: Final = 48
"""Instances of each round."""
KEPT: Final = 3
"""What each round begins from."""
STEPS: Final = (0.15, 0.08)
"""Standard deviation of each round, in shares of a parameter's range."""
_MOVED: Final = 0.4
"""Share of the parameters that a candidate changes."""


@dataclass(frozen=True, eq=False)
class Start:
    """Values of a model and the panorama distance of their instance."""

    generator: InstanceGenerator
    values: Float[np.ndarray, " P"]
    distance: float


def improve_starts(
    descriptor: PanoramaDescriptor, starts: Sequence[Start], subdivision_steps: int, rng: np.random.Generator
) -> Start:
    """Return the best that is found from some starts, at least as near as the nearest of them.

    Args:
        descriptor: of the query.
        starts: at least one, of one model or several; the nearest :data:`KEPT` are gone on from.
        subdivision_steps: of the instances.
        rng: draws the candidates.
    """
    best = sorted(starts, key=lambda start: start.distance)[:KEPT]
    for step in STEPS:
        found = list(best)
        for start in best:
            candidates = _around(start, step, CANDIDATES // len(best), rng)
            points = start.generator.surface_points(candidates, subdivision_steps)
            triangles = start.generator.surface_triangles(subdivision_steps)
            near = panorama_distances(descriptor, panorama_descriptors(points, triangles))
            found += [
                Start(start.generator, row, float(distance)) for row, distance in zip(candidates, near, strict=True)
            ]
        best = sorted(found, key=lambda start: start.distance)[:KEPT]
    return best[0]


def _around(start: Start, step: float, count: int, rng: np.random.Generator) -> Float[np.ndarray, "B P"]:
    generator, values = start.generator, start.values
    moved = rng.random((count, len(values))) < _MOVED
    spread = step * (generator.maximum - generator.minimum)
    return generator.space.settle(values + moved * rng.normal(size=(count, len(values))) * spread)
