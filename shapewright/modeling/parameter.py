"""Named parameters of a procedural model."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from shapewright.errors import ModelError
from shapewright.modeling.dependence import (
    CONDITIONS_SCHEMA,
    LIMITS_SCHEMA,
    Condition,
    Limit,
    read_conditions,
    read_limits,
)
from shapewright.modeling.fields import (
    MAX_MAGNITUDE,
    NUMBER_SCHEMA,
    read_number,
    read_object,
    shown,
    whole_number,
    write_number,
)
from shapewright.modeling.units import KINDS, ParameterKind, kind_of_unit

NAME_PATTERN = "^[a-z][a-z0-9_]{0,63}$"
MAX_LABEL = 200
MAX_UNIT = 20
MAX_TARGETS = 20_000
MAX_OPTIONS = 100


@dataclass(frozen=True)
class ParameterTarget:
    """An operation that a parameter changes, and the way in which it does (a mode of that operation)."""

    operation: int
    mode: str


@dataclass(frozen=True)
class Parameter:
    """A number x that a user varies; x = 1 is the base model (Table 1; a group has several targets).

    Attributes:
        name: identifier.
        label: what people read.
        minimum: smallest x, at most 1.
        maximum: largest x, at least 1.
        targets: what x acts on; a choice that only conditions look at may have none.
        unit: unit of ``base_value``, if it has one.
        base_value: what x = 1 means to people; x times it is shown beside x. ``None``: x is shown alone.
        options: if there are any, x is a whole number, and these are the names of ``minimum``, ``minimum`` + 1, ...
            A switch has the options of 0 and 1, any other choice those of 1, 2, ...
        active_when: conditions on parameters before it; where one does not hold the parameter is not active, and 1.
        limits: how its range follows values of parameters before it.
        kind: what x times ``base_value`` is: a length, an angle or a ratio; ``None`` if the author does not say,
            and of a choice. If all lengths of a model grow alike the instance grows, and nothing else changes.
    """

    name: str
    label: str
    minimum: float
    maximum: float
    targets: tuple[ParameterTarget, ...]
    unit: str | None = None
    base_value: float | None = None
    options: tuple[str, ...] = ()
    active_when: tuple[Condition, ...] = ()
    limits: tuple[Limit, ...] = ()
    kind: ParameterKind | None = None

    def __post_init__(self) -> None:
        if not re.fullmatch(NAME_PATTERN, self.name):
            raise ModelError(f"{shown(self.name)} is no parameter name: small letters, digits and _ only")
        if not self.label.strip() or len(self.label) > MAX_LABEL:
            raise ModelError(f"parameter {self.name!r} needs a label of at most {MAX_LABEL} characters")
        if not (math.isfinite(self.minimum) and math.isfinite(self.maximum)):
            raise ModelError(f"the range of {self.name!r} is not finite")
        if not self.minimum < self.maximum or not self.minimum <= 1.0 <= self.maximum:
            bounds = f"[{self.minimum:g}, {self.maximum:g}]"
            raise ModelError(f"the range {bounds} of {self.name!r} excludes 1, the base model, or is empty")
        if max(abs(self.minimum), abs(self.maximum)) > MAX_MAGNITUDE:
            raise ModelError(f"the range of {self.name!r} is beyond {MAX_MAGNITUDE:g}")
        if not self.targets and not self.options:
            raise ModelError(f"parameter {self.name!r} changes no operation")
        if self.options and len(self.options) != self.maximum - self.minimum + 1:
            raise ModelError(f"the range of {self.name!r} must hold one whole number for each of its options")
        if any(not option.strip() or len(option) > MAX_LABEL for option in self.options):
            raise ModelError(f"an option of {self.name!r} is empty or longer than {MAX_LABEL} characters")
        if len(set(self.options)) < len(self.options):
            raise ModelError(f"{self.name!r} has two options of one name")
        if self.options and self.minimum != int(self.minimum):
            raise ModelError(f"the options of {self.name!r} must begin at a whole number")
        if self.options and (self.limits or self.base_value is not None):
            raise ModelError(f"{self.name!r} has options, and therefore neither limits nor a base value")
        if self.unit is not None and len(self.unit) > MAX_UNIT:
            raise ModelError(f"the unit of {self.name!r} is longer than {MAX_UNIT} characters")
        if self.kind is not None and self.options:
            raise ModelError(f"{self.name!r} has options, and therefore no kind")
        if self.kind is not None and kind_of_unit(self.unit) not in (None, self.kind):
            raise ModelError(f"{self.name!r} is shown in {self.unit!r}, and is therefore not of kind {self.kind!r}")
        if self.base_value is not None and not abs(self.base_value) <= MAX_MAGNITUDE:
            raise ModelError(f"the base value of {self.name!r} is beyond {MAX_MAGNITUDE:g} or no number")

    def named_options(self) -> list[tuple[float, str]]:
        """Return the options with their values."""
        return [(self.minimum + i, option) for i, option in enumerate(self.options)]

    @classmethod
    def from_document(cls, document: Any, where: str) -> "Parameter":
        """Make the parameter from its JSON object.

        Raises:
            ModelError: a field is missing, unknown or wrong; ``where`` says which.
        """
        item = read_object(document, where, _FIELDS)
        for needed in ("name", "label", "range", "targets"):
            if needed not in item:
                raise ModelError(f"a parameter needs the field {needed!r}", where=where)
        for text in ("name", "label"):
            if not isinstance(item[text], str):
                raise ModelError("a text is needed", where=f"{where}.{text}")
        unit, base_value = item.get("unit"), item.get("base_value")
        if unit is not None and (not isinstance(unit, str) or len(unit) > MAX_UNIT):
            raise ModelError(f"a text of at most {MAX_UNIT} characters is needed", where=f"{where}.unit")
        options = item.get("options", [])
        if not isinstance(options, list) or len(options) > MAX_OPTIONS or not all(isinstance(o, str) for o in options):
            raise ModelError(f"a list of at most {MAX_OPTIONS} texts is needed", where=f"{where}.options")
        bounds = item["range"]
        if not isinstance(bounds, list) or len(bounds) != 2:
            raise ModelError("a range is a list of two numbers", where=f"{where}.range")
        if not isinstance(item["targets"], list) or len(item["targets"]) > MAX_TARGETS:
            raise ModelError(f"a list of at most {MAX_TARGETS} is needed", where=f"{where}.targets")
        minimum, maximum = (read_number(bound, f"{where}.range[{i}]") for i, bound in enumerate(bounds))
        kind = item.get("kind")
        if kind is not None and kind not in KINDS:
            raise ModelError(f"{shown(kind)} is none of {', '.join(KINDS)}", where=f"{where}.kind")
        try:
            return cls(
                name=item["name"],
                label=item["label"],
                minimum=minimum,
                maximum=maximum,
                targets=tuple(_read_target(t, f"{where}.targets[{i}]") for i, t in enumerate(item["targets"])),
                unit=unit,
                base_value=None if base_value is None else read_number(base_value, f"{where}.base_value"),
                options=tuple(options),
                active_when=read_conditions(item.get("active_when", []), f"{where}.active_when"),
                limits=read_limits(item.get("limits", []), f"{where}.limits"),
                kind=kind,
            )
        except ModelError as error:
            raise ModelError(error.message, where=error.where or where) from None

    def to_document(self) -> dict[str, Any]:
        """Return the JSON object; what most parameters lack is written only where it is."""
        document: dict[str, Any] = {
            "name": self.name,
            "label": self.label,
            "unit": self.unit,
            "base_value": None if self.base_value is None else write_number(self.base_value),
            "range": [write_number(self.minimum), write_number(self.maximum)],
            "targets": [{"operation": t.operation, "mode": t.mode} for t in self.targets],
        }
        if self.kind is not None:
            document["kind"] = self.kind
        if self.options:
            document["options"] = list(self.options)
        if self.active_when:
            document["active_when"] = [condition.to_document() for condition in self.active_when]
        if self.limits:
            document["limits"] = [limit.to_document() for limit in self.limits]
        return document

    @staticmethod
    def schema() -> Mapping[str, Any]:
        """Return the JSON schema of the object."""
        return {
            "type": "object",
            "properties": {
                "name": {"type": "string", "pattern": NAME_PATTERN},
                "label": {"type": "string", "pattern": "\\S", "maxLength": MAX_LABEL},
                "unit": {"type": ["string", "null"], "maxLength": MAX_UNIT},
                "kind": {"enum": [*KINDS, None]},
                "base_value": {**NUMBER_SCHEMA, "type": ["number", "null"]},
                "range": {
                    "type": "array",
                    "prefixItems": [{**NUMBER_SCHEMA, "maximum": 1}, {**NUMBER_SCHEMA, "minimum": 1}],
                    "minItems": 2,
                    "maxItems": 2,
                },
                "targets": {
                    "type": "array",
                    "maxItems": MAX_TARGETS,
                    "items": {
                        "type": "object",
                        "properties": {
                            "operation": {"type": "integer", "minimum": 0},
                            "mode": {"type": "string"},
                        },
                        "required": ["operation", "mode"],
                        "additionalProperties": False,
                    },
                },
                "options": {
                    "type": "array",
                    "maxItems": MAX_OPTIONS,
                    "uniqueItems": True,
                    "items": {"type": "string", "pattern": "\\S", "maxLength": MAX_LABEL},
                },
                "active_when": CONDITIONS_SCHEMA,
                "limits": LIMITS_SCHEMA,
            },
            "anyOf": [
                {"properties": {"targets": {"minItems": 1}}},
                {"properties": {"options": {"minItems": 1}}, "required": ["options"]},
            ],
            "required": ["name", "label", "range", "targets"],
            "additionalProperties": False,
        }


_FIELDS = {"name", "label", "range", "targets", "unit", "kind", "base_value", "options", "active_when", "limits"}


def _read_target(value: Any, where: str) -> ParameterTarget:
    item = read_object(value, where, {"operation", "mode"})
    operation, mode = whole_number(item.get("operation")), item.get("mode")
    if operation is None or operation < 0:
        raise ModelError("the index of an operation is needed", where=f"{where}.operation")
    if not isinstance(mode, str):
        raise ModelError("a mode of the operation is needed", where=f"{where}.mode")
    return ParameterTarget(operation, mode)
