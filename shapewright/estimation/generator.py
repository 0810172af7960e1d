"""What an estimator asks of a model: :class:`shapewright.modeling.CompiledModel` has it, a test's box too."""

from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int


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


@runtime_checkable
class ModelInfo(Protocol):
    """What tells one model from another."""

    @property
    def digest(self) -> str:
        """Changes with every change of the model."""

    @property
    def parameters(self) -> "tuple[ParameterInfo, ...]":
        """In the order of the columns of values."""


@runtime_checkable
class InstanceGenerator(Protocol):
    """Generates instances that all share one topology."""

    @property
    def model(self) -> ModelInfo:
        """What is generated."""

    @property
    def minimum(self) -> Float[np.ndarray, " P"]:
        """Smallest values."""

    @property
    def maximum(self) -> Float[np.ndarray, " P"]:
        """Largest values."""

    def random_values(self, rng: np.random.Generator, count: int) -> Float[np.ndarray, "B P"]:
        """Rows of values, uniform in their ranges."""

    def surface_points(self, values: Float[np.ndarray, "B P"], steps: int) -> Float[np.ndarray, "B V 3"]:
        """Vertices of each row's instance after subdivision."""

    def surface_triangles(self, steps: int) -> Int[np.ndarray, "F 3"]:
        """Triangles of every instance."""
