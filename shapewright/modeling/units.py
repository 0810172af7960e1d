"""Units that parameters are shown in, and what they tell about the kind of a parameter."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final, Literal, get_args

ParameterKind = Literal["length", "angle", "ratio"]
"""What a measure is: a length, which grows with the model; an angle; or a ratio of lengths, or another plain number."""

KINDS: Final[tuple[ParameterKind, ...]] = get_args(ParameterKind)
LENGTH_UNITS_M: Final[Mapping[str, float]] = MappingProxyType(
    {"mm": 0.001, "cm": 0.01, "dm": 0.1, "m": 1.0, "km": 1000.0, "in": 0.0254, "ft": 0.3048}
)
"""Meters in each unit of length."""
ANGLE_UNITS: Final = frozenset({"deg", "rad"})


def kind_of_unit(unit: str | None) -> ParameterKind | None:
    """Return the kind of parameter that is shown in a unit, ``None`` if the unit does not tell."""
    if unit in LENGTH_UNITS_M:
        return "length"
    return "angle" if unit in ANGLE_UNITS else None
