"""How a parameter depends on others: when it is active, and how its range follows another value."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from shapewright.errors import ModelError
from shapewright.modeling.fields import (
    MAX_MAGNITUDE,
    NUMBER_SCHEMA,
    choice,
    read_number,
    read_object,
    shown,
    write_number,
)

MAX_CONDITIONS = 20
MAX_LIMITS = 20
_BOUND = choice("minimum", "maximum")


@dataclass(frozen=True)
class Condition:
    """Holds where an active parameter's value x lies in [minimum, maximum]."""

    parameter: str
    minimum: float
    maximum: float

    def __post_init__(self) -> None:
        if not -MAX_MAGNITUDE <= self.minimum <= self.maximum <= MAX_MAGNITUDE:
            raise ModelError(f"the condition on {shown(self.parameter)} has an empty or endless range")

    @classmethod
    def from_document(cls, document: Any, where: str) -> "Condition":
        """Make the condition from its JSON object; raises ModelError."""
        item = read_object(document, where, {"parameter", "range"})
        bounds = item.get("range")
        if not isinstance(bounds, list) or len(bounds) != 2:
            raise ModelError("a range is a list of two numbers", where=f"{where}.range")
        low, high = (read_number(bound, f"{where}.range[{i}]") for i, bound in enumerate(bounds))
        parameter = _read_reference(item, where)
        try:
            return cls(parameter, low, high)
        except ModelError as error:
            raise ModelError(error.message, where=f"{where}.range") from None

    def to_document(self) -> dict[str, Any]:
        """Return the JSON object."""
        return {"parameter": self.parameter, "range": [write_number(self.minimum), write_number(self.maximum)]}

    @staticmethod
    def schema() -> Mapping[str, Any]:
        """Return the JSON schema of the object."""
        return {
            "type": "object",
            "properties": {
                "parameter": {"type": "string"},
                "range": {"type": "array", "items": NUMBER_SCHEMA, "minItems": 2, "maxItems": 2},
            },
            "required": ["parameter", "range"],
            "additionalProperties": False,
        }


@dataclass(frozen=True)
class Limit:
    """Narrows a range by another value: the bound is at ``offset + factor * x`` of another parameter.

    A minimum raises the smallest x, a maximum lowers the largest; a range is never widened.
    """

    bound: Literal["minimum", "maximum"]
    parameter: str
    offset: float
    factor: float

    def __post_init__(self) -> None:
        if not all(math.isfinite(n) and abs(n) <= MAX_MAGNITUDE for n in (self.offset, self.factor)):
            raise ModelError(f"the limit by {shown(self.parameter)} is not finite or too large")

    @classmethod
    def from_document(cls, document: Any, where: str) -> "Limit":
        """Make the limit from its JSON object; raises ModelError."""
        item = read_object(document, where, {"bound", "parameter", "offset", "factor"})
        return cls(
            bound=_BOUND.read(item.get("bound"), f"{where}.bound"),
            parameter=_read_reference(item, where),
            offset=read_number(item.get("offset"), f"{where}.offset"),
            factor=read_number(item.get("factor"), f"{where}.factor"),
        )

    def to_document(self) -> dict[str, Any]:
        """Return the JSON object."""
        numbers = {"offset": write_number(self.offset), "factor": write_number(self.factor)}
        return {"bound": self.bound, "parameter": self.parameter, **numbers}

    @staticmethod
    def schema() -> Mapping[str, Any]:
        """Return the JSON schema of the object."""
        return {
            "type": "object",
            "properties": {
                "bound": _BOUND.schema,
                "parameter": {"type": "string"},
                "offset": NUMBER_SCHEMA,
                "factor": NUMBER_SCHEMA,
            },
            "required": ["bound", "parameter", "offset", "factor"],
            "additionalProperties": False,
        }


def when(parameter: str, low: float, high: float | None = None) -> Condition:
    """Return the condition that x lies in [low, high], or is ``low``."""
    return Condition(parameter, low, low if high is None else high)


def read_conditions(value: Any, where: str) -> tuple[Condition, ...]:
    """Read a list of conditions, all of which must hold; raises ModelError."""
    if not isinstance(value, list) or len(value) > MAX_CONDITIONS:
        raise ModelError(f"a list of at most {MAX_CONDITIONS} conditions is needed", where=where)
    return tuple(Condition.from_document(item, f"{where}[{i}]") for i, item in enumerate(value))


def read_limits(value: Any, where: str) -> tuple[Limit, ...]:
    """Read a list of limits; raises ModelError."""
    if not isinstance(value, list) or len(value) > MAX_LIMITS:
        raise ModelError(f"a list of at most {MAX_LIMITS} limits is needed", where=where)
    return tuple(Limit.from_document(item, f"{where}[{i}]") for i, item in enumerate(value))


CONDITIONS_SCHEMA: dict[str, Any] = {"type": "array", "maxItems": MAX_CONDITIONS, "items": Condition.schema()}
LIMITS_SCHEMA: dict[str, Any] = {"type": "array", "maxItems": MAX_LIMITS, "items": Limit.schema()}


def _read_reference(item: Mapping[str, Any], where: str) -> str:
    name = item.get("parameter")
    if not isinstance(name, str):
        raise ModelError("the name of a parameter is needed", where=f"{where}.parameter")
    return name
