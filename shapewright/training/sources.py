"""Where learning pictures come from: variations of procedural models, and objects that are of no class.

A source gives the same meshes for the same generator, so its pictures and descriptors can be stored under its
digest.
"""

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from shapewright.classification.series import series_values
from shapewright.estimation.generator import InstanceGenerator
from shapewright.mesh import TriangleMesh
from shapewright.training import negatives

MESHES_VERSION: Final = 1
"""Raise it when the same model gives other variations for the same generator, or they have other surfaces."""


@runtime_checkable
class Source(Protocol):
    """Gives random meshes to learn from: the same for the same generator, and the first ones of a longer series."""

    @property
    def name(self) -> str:
        """For people and for progress."""
        ...

    @property
    def digest(self) -> str:
        """Changes with whatever changes the meshes; at least 16 hexadecimal digits."""
        ...

    def meshes(self, rng: np.random.Generator, count: int, steps: int) -> Iterator[TriangleMesh]:
        """The first ``count`` random meshes of a series, subdivided ``steps`` times if they can be."""
        ...


@dataclass(frozen=True)
class ModelSource:
    """Random variations of a procedural model, or its base again and again.

    Args:
        generator: the compiled model.
        varied: whether parameters are drawn at random; the paper's baseline learns without (section 4.2).
    """

    generator: InstanceGenerator
    varied: bool = True

    @property
    def name(self) -> str:
        """The model's name."""
        return self.generator.model.name

    @property
    def digest(self) -> str:
        """The digest of the model's document, another one without variation."""
        digest = self.generator.model.digest
        return digest if self.varied else hashlib.sha256(f"{digest} unvaried".encode()).hexdigest()

    def values(self, rng: np.random.Generator, count: int) -> Float[np.ndarray, "B P"]:
        """The parameter values of the meshes that the same generator gives."""
        values = series_values(self.generator, rng, count)
        return values if self.varied else np.ones_like(values)

    def meshes(self, rng: np.random.Generator, count: int, steps: int) -> Iterator[TriangleMesh]:
        """The variations, without the parts that they lack: a picture is normalised by the vertices that are there."""
        return self.generator.instances(self.values(rng, count), steps)


@dataclass(frozen=True)
class AssemblySource:
    """Random assemblies of primitives."""

    name: str = "assemblies"

    @property
    def digest(self) -> str:
        """Changes with the version of the generator."""
        return hashlib.sha256(f"{self.name} {negatives.VERSION}".encode()).hexdigest()

    def meshes(self, rng: np.random.Generator, count: int, steps: int) -> Iterator[TriangleMesh]:
        """Assemblies; ``steps`` means nothing to them."""
        return (negatives.random_assembly(rng) for _ in range(count))


@dataclass(frozen=True)
class DistortedSource:
    """Variations of some models, distorted beyond recognition."""

    generators: Sequence[InstanceGenerator]
    name: str = "distorted"

    @property
    def digest(self) -> str:
        """Changes with the models and the version of the distortion."""
        return _digest_of(self.name, self.generators)

    def meshes(self, rng: np.random.Generator, count: int, steps: int) -> Iterator[TriangleMesh]:
        """One distorted variation of a random model each."""
        return (negatives.distorted(_any_instance(self.generators, rng, steps), rng) for _ in range(count))


@dataclass(frozen=True)
class MixedSource:
    """A half of a variation of a model of each of two classes."""

    first: Sequence[InstanceGenerator]
    second: Sequence[InstanceGenerator]
    name: str = "mixed"

    @property
    def digest(self) -> str:
        """Changes with the models and the version of the mixing."""
        return _digest_of(f"{self.name} {negatives.MIXED_VERSION}", [*self.first, *self.second])

    def meshes(self, rng: np.random.Generator, count: int, steps: int) -> Iterator[TriangleMesh]:
        """Two halves each, of a random model of either class."""

        def halves() -> tuple[TriangleMesh, TriangleMesh]:
            return _any_instance(self.first, rng, steps), _any_instance(self.second, rng, steps)

        return (negatives.mixed(*halves(), rng) for _ in range(count))


def _digest_of(name: str, generators: Sequence[InstanceGenerator]) -> str:
    digests = " ".join(generator.model.digest for generator in generators)
    return hashlib.sha256(f"{name} {negatives.VERSION} {digests}".encode()).hexdigest()


def _any_instance(generators: Sequence[InstanceGenerator], rng: np.random.Generator, steps: int) -> TriangleMesh:
    generator = generators[int(rng.integers(len(generators)))]
    return next(iter(generator.instances(generator.random_values(rng, 1), steps)))
