"""What an estimator asks of a model: :class:`shapewright.modeling.CompiledModel` has it, a test's box too."""

from collections.abc import Iterator
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.mesh import TriangleMesh
from shapewright.modeling.units import ParameterKind


@runtime_checkable
class ParameterInfo(Protocol):
    """What people are told about a parameter."""

    @property
    def name(self) -> str:
        """Identifier."""

    @property
    def label(self) -> str:
        """What people read."""

    @property
    def unit(self) -> str | None:
        """Unit of the displayed value."""

    @property
    def base_value(self) -> float | None:
        """What x is multiplied by for people."""

    @property
    def minimum(self) -> float:
        """Smallest x."""

    @property
    def maximum(self) -> float:
        """Largest x."""

    @property
    def kind(self) -> ParameterKind | None:
        """What x times the base value is, if the author says it."""

    def named_options(self) -> list[tuple[float, str]]:
        """Values and names of the options; none of a measure."""


@runtime_checkable
class ModelInfo(Protocol):
    """What tells one model from another."""

    @property
    def name(self) -> str:
        """What people call it."""

    @property
    def digest(self) -> str:
        """Changes with every change of the model."""

    @property
    def unit_m(self) -> float | None:
        """Meters that a unit of the coordinates stands for, if the author says it."""

    @property
    def parameters(self) -> "tuple[ParameterInfo, ...]":
        """In the order of the columns of values."""


@runtime_checkable
class ValueSpace(Protocol):
    """What values mean together."""

    def settle(self, values: Float[np.ndarray, "B P"]) -> Float[np.ndarray, "B P"]:
        """Move rows into their ranges, options to whole numbers, what is not active to 1."""

    def active(self, values: Float[np.ndarray, "B P"]) -> Bool[np.ndarray, "B P"]:
        """Tell which parameters are active in settled rows."""

    def ranges(self, values: Float[np.ndarray, "B P"]) -> tuple[Float[np.ndarray, "B P"], Float[np.ndarray, "B P"]]:
        """Return the smallest and largest x of each parameter in settled rows."""


@runtime_checkable
class InstanceGenerator(Protocol):
    """Generates instances: in batches that share one topology, and alone without the parts that they lack."""

    @property
    def model(self) -> ModelInfo:
        """What is generated."""

    @property
    def space(self) -> ValueSpace:
        """What depends on what."""

    @property
    def minimum(self) -> Float[np.ndarray, " P"]:
        """Smallest values."""

    @property
    def maximum(self) -> Float[np.ndarray, " P"]:
        """Largest values."""

    def random_values(self, rng: np.random.Generator, count: int) -> Float[np.ndarray, "B P"]:
        """Settled rows of values, uniform in their ranges."""

    def surface_points(self, values: Float[np.ndarray, "B P"], steps: int) -> Float[np.ndarray, "B V 3"]:
        """Vertices of each row's instance after subdivision; parts that it lacks have no area."""

    def surface_triangles(self, steps: int) -> Int[np.ndarray, "F 3"]:
        """Triangles of a batch."""

    def surface_parts(self, steps: int) -> Int[np.ndarray, " V"]:
        """Part number of each vertex of :meth:`surface_points`; -1 belongs to no part, and is always there."""

    def parts_present(self, values: Float[np.ndarray, "B P"]) -> Bool[np.ndarray, "B N"]:
        """Tell which parts each row's instance has."""

    def instance(self, values: Float[np.ndarray, " P"], steps: int) -> TriangleMesh:
        """One instance, without the parts that it lacks; what is left keeps its order."""

    def instances(self, values: Float[np.ndarray, "B P"], steps: int) -> Iterator[TriangleMesh]:
        """The instance of each row."""
