"""Points spread evenly over the surface of a model, at the same places of every instance (ours).

The paper measures an instance at its vertices, which say little about its surface: a flat face with creases keeps few
of them however large it is. Samples are fixed barycentric places on the triangles of a model, so they are linear in its
vertices and do not jump when a parameter changes. They lie evenly where parameters are as in an average instance.
"""

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.distances.even_places import even_places
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.sampling_kernels import face_areas

LEAST_SAMPLES: Final = 2000
"""On each of the instances that the samples are spread by, the base among them."""
_INSTANCES: Final = 8
_DRAWN: Final = 256


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Places on the surface of a model.

    Attributes:
        corners: vertices of each sample's triangle, among those of a batch (``surface_points``).
        weights: barycentric coordinates.
        parts: part number of each vertex of a batch, -1 for what is always there.
    """

    corners: Int[np.ndarray, "N 3"]
    weights: Float[np.ndarray, "N 3"]
    parts: Int[np.ndarray, " V"]
    _of_instances: dict[bytes, "InstanceSamples"] = field(default_factory=dict, init=False, repr=False)

    def of_instance(self, present: Bool[np.ndarray, " N"]) -> "InstanceSamples":
        """Return the samples of instances that have these parts and lack the others."""
        key = present.tobytes()
        if key not in self._of_instances:
            kept = np.append(present, True)[self.parts]  # -1 is the last one
            new_row = np.cumsum(kept) - 1
            there = kept[self.corners[:, 0]]
            self._of_instances[key] = InstanceSamples(new_row[self.corners[there]], self.weights[there])
        return self._of_instances[key]


@dataclass(frozen=True, eq=False)
class InstanceSamples:
    """Places on the surface of an instance without the parts that it lacks.

    Attributes:
        corners: vertices of each sample's triangle, among those of the instance.
        weights: barycentric coordinates.
    """

    corners: Int[np.ndarray, "N 3"]
    weights: Float[np.ndarray, "N 3"]

    def points(self, vertices: Float[np.ndarray, "V 3"]) -> Float[np.ndarray, "N 3"]:
        """Return the samples for the vertices of an instance."""
        return np.asarray(np.einsum("nk,nkd->nd", self.weights, vertices[self.corners]))


def spread_samples(generator: InstanceGenerator, steps: int, least: int = LEAST_SAMPLES) -> SurfaceSamples:
    """Spread samples over the surface of a model; the same ones each time.

    Args:
        generator: the compiled model.
        steps: subdivision steps of the instances.
        least: samples that instances have at least.
    """
    triangles = generator.surface_triangles(steps)
    parts = generator.surface_parts(steps)
    values = _typical_values(generator)
    kept = np.concatenate([generator.parts_present(values), np.ones((len(values), 1), dtype=bool)], axis=1)
    part_of_face = parts[triangles[:, 0]]
    there = kept[:, part_of_face]
    areas = _face_areas(generator.surface_points(values, steps), triangles) * there
    shares = areas / areas.sum(axis=1, keepdims=True)
    # of the instances that have a part alone: one of several options is sampled as densely as what is always there
    density = shares.sum(axis=0) / np.maximum(there.sum(axis=0), 1)
    density /= density.sum()
    count = int(np.ceil(least / (there @ density).min())) + 1
    faces, weights = even_places(density, count)
    return SurfaceSamples(triangles[faces], weights, parts)


def _typical_values(generator: InstanceGenerator) -> Float[np.ndarray, "B P"]:
    """The base and some random instances, so many that each part is there in one of them, if it is not very rare."""
    rng = np.random.default_rng(0)
    base = np.ones((1, len(generator.minimum)))
    drawn = np.concatenate([base, generator.random_values(rng, _DRAWN)])
    present = generator.parts_present(drawn)
    rows = list(range(_INSTANCES))
    for part in range(present.shape[1]):
        having = np.flatnonzero(present[:, part])
        if len(having) and not present[rows, part].any():
            rows.append(int(having[0]))
    return np.asarray(drawn[rows])


def _face_areas(points: Float[np.ndarray, "B V 3"], triangles: Int[np.ndarray, "F 3"]) -> Float[np.ndarray, "B F"]:
    areas = np.empty((len(points), len(triangles)))
    face_areas(points, triangles, areas)
    return areas
