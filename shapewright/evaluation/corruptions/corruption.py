"""What a corruption is: a function of a mesh, a strength and a random generator, with the strengths it is used at."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shapewright.errors import EvaluationError
from shapewright.mesh import PointCloud, TriangleMesh

Corrupt = Callable[[TriangleMesh, float, np.random.Generator], TriangleMesh | PointCloud]
"""Takes a mesh, a strength and a source of all choices; returns the damaged mesh or points in the same coordinates."""


@dataclass(frozen=True)
class Corruption:
    """A named corruption.

    Attributes:
        name: what evaluations call it.
        meaning: what the strength says, for people.
        strengths: three, the mildest first.
        default: the strength that is used unless another is given.
        least, most: range of the strength.
        corrupt: what does it.
        has_faces: whether it returns a mesh; otherwise it returns a point cloud.
    """

    name: str
    meaning: str
    strengths: tuple[float, float, float]
    default: float
    least: float
    most: float
    corrupt: Corrupt
    has_faces: bool = True

    def checked(self, strength: float | None) -> float:
        """Return the strength, the default for ``None``.

        Raises:
            EvaluationError: the strength is out of range.
        """
        chosen = self.default if strength is None else strength
        if not self.least <= chosen <= self.most:
            limits = f"from {self.least:g} to {self.most:g}"
            raise EvaluationError(f"expected a strength of {self.name!r} {limits}, got {chosen:g}", where="strength")
        return chosen

    def __call__(
        self, mesh: TriangleMesh, strength: float | None, rng: np.random.Generator
    ) -> TriangleMesh | PointCloud:
        """Return a corrupted mesh, or a point cloud, in the same coordinates.

        Raises:
            EvaluationError: the strength is out of range.
            MeshError: the mesh has no extent or no area, or nothing of it is left.
        """
        return self.corrupt(mesh, self.checked(strength), rng)

    @property
    def summary(self) -> str:
        """Name, meaning of the strength, and the three strengths, as one line of a list."""
        return f"{self.name}: {self.meaning} ({', '.join(f'{strength:g}' for strength in self.strengths)})"


def diagonal(mesh: TriangleMesh) -> float:
    """Return the length of the bounding box's diagonal."""
    low, high = mesh.bounds
    return float(np.linalg.norm(high - low))
