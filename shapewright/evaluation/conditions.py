"""Conditions of a robustness evaluation: a corruption at one strength, which does the same to a mesh every time."""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from shapewright.evaluation.corruptions import CORRUPTIONS, Corruption
from shapewright.mesh import PointCloud, TriangleMesh


@dataclass(frozen=True)
class Condition:
    """A corruption at one strength.

    Attributes:
        name: name of the corruption.
        strength: its strength; see :attr:`shapewright.evaluation.corruptions.Corruption.meaning`.
    """

    name: str
    strength: float

    @property
    def corruption(self) -> Corruption:
        """The corruption itself."""
        return CORRUPTIONS[self.name]

    def corrupted(self, mesh: TriangleMesh, *, seed: int, file: str) -> TriangleMesh | PointCloud:
        """Corrupt the mesh of a file.

        Every random choice follows from the seed, the corruption, the strength and the name of the file; which other
        meshes and conditions are evaluated, in which order and in how many processes, makes no difference.

        Raises:
            MeshError: the mesh has no extent or no area, or nothing of it is left.
        """
        return self.corruption(mesh, self.strength, self.generator(seed, file))

    def generator(self, seed: int, file: str) -> np.random.Generator:
        """Return the source of all random choices for the mesh of this file."""
        text = json.dumps([seed, self.name, self.strength, file])
        return np.random.default_rng(int.from_bytes(hashlib.sha256(text.encode()).digest(), "big"))


def conditions_of(names: Iterable[str], *, middle_only: bool = False) -> tuple[Condition, ...]:
    """Return the conditions of these corruptions, the mildest strength first: all three, or the middle one."""
    return tuple(
        Condition(name, strength)
        for name in names
        for strength in (CORRUPTIONS[name].strengths[1:2] if middle_only else CORRUPTIONS[name].strengths)
    )
