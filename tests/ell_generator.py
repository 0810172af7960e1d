"""A tiny model for tests of the estimation: two boxes that form an uneven L, no two axes or ends alike."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import trimesh

from shapewright.distances.alignment import Pose
from shapewright.mesh import TriangleMesh
from shapewright.modeling.parameter import Parameter, ParameterTarget
from shapewright.modeling.parameter_space import ParameterSpace


@dataclass(frozen=True)
class EllModel:
    parameters: tuple[Parameter, ...]
    name: str = "ell"
    digest: str = "an uneven L"
    unit_m: float | None = 0.001


class EllGenerator:
    """Closed boxes of 98 vertices each; ``parameters`` of length, width and height vary, the others stay 1."""

    def __init__(self, *parameters: str) -> None:
        self.model = EllModel(
            tuple(
                Parameter(name, name.title(), 0.5, 2.0, (ParameterTarget(0, "size"),), "mm", 10.0, kind="length")
                for name in parameters
            )
        )
        self.space = ParameterSpace(self.model.parameters)
        self.minimum = np.array([parameter.minimum for parameter in self.model.parameters])
        self.maximum = np.array([parameter.maximum for parameter in self.model.parameters])
        box = trimesh.creation.box().subdivide().subdivide()
        self._corner_box = np.array(box.vertices) + 0.5
        self._faces = np.array(box.faces, dtype=np.int64)
        self.generated = 0

    def random_values(self, rng: np.random.Generator, count: int) -> np.ndarray:
        return rng.uniform(self.minimum, self.maximum, size=(count, len(self.minimum)))

    def surface_triangles(self, steps: int = 2) -> np.ndarray:
        return np.concatenate([self._faces, self._faces + len(self._corner_box)])

    def surface_points(self, values: np.ndarray, steps: int = 2) -> np.ndarray:
        self.generated += len(values)
        by_name = {parameter.name: values[:, k] for k, parameter in enumerate(self.model.parameters)}
        one = np.ones(len(values))
        length, width, height = (by_name.get(name, one) for name in ("length", "width", "height"))
        foot = self._corner_box * np.stack([3.0 * length, 1.2 * width, 0.5 * one], axis=1)[:, None]
        tower = self._corner_box * np.stack([0.7 * one, 0.5 * one, 1.6 * height], axis=1)[:, None]
        return np.concatenate([foot, tower + np.array([0.0, 0.1, 0.4])], axis=1)

    def surface_parts(self, steps: int = 2) -> np.ndarray:
        return np.full(2 * len(self._corner_box), -1)

    def parts_present(self, values: np.ndarray) -> np.ndarray:
        return np.ones((len(values), 0), dtype=bool)

    def instances(self, values: np.ndarray, steps: int = 2) -> Iterator[TriangleMesh]:
        return (self.instance(row, steps) for row in values)

    def instance(self, values: np.ndarray, steps: int = 2) -> TriangleMesh:
        return TriangleMesh(self.surface_points(values[None], steps)[0], self.surface_triangles(steps))

    def mesh(self, values: np.ndarray, pose: Pose | None = None) -> TriangleMesh:
        points = self.surface_points(np.asarray(values, dtype=np.float64)[None])[0]
        return TriangleMesh((pose or Pose()).apply(points), self.surface_triangles())
