"""The procedural model: a blueprint of a class as data, read and written as JSON."""

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from shapewright.errors import ModelError
from shapewright.modeling.fields import MAX_MAGNITUDE, read_number, read_object, shown, write_number
from shapewright.modeling.operations import OPERATIONS, Base, Operation
from shapewright.modeling.parameter import NAME_PATTERN, Parameter
from shapewright.modeling.parameter_space import ParameterSpace
from shapewright.modeling.part import MAX_PARTS, Part
from shapewright.modeling.symmetry import NO_SYMMETRY, Symmetry
from shapewright.modeling.upgrade import FORMAT, VERSION, upgrade_document
from shapewright.whole_file import write_whole

MAX_OPERATIONS = 5_000
MAX_PARAMETERS = 200
MAX_DOCUMENT_BYTES = 16 * 2**20
MAX_DESCRIPTION = 5_000
_MAX_ITEMS = {"operations": MAX_OPERATIONS, "parameters": MAX_PARAMETERS, "parts": MAX_PARTS}


@dataclass(frozen=True)
class ProceduralModel:
    """A base mesh, an ordered list of modelling operations, and named parameters (paper section 3).

    Attributes:
        name: identifier of the model.
        class_name: the class whose blueprint it is; several models may share one.
        operations: at least one; the first is a base.
        parameters: what can be varied.
        description: for people.
        closed: whether every instance is meant to be a closed surface; checked against the topology.
        parts: optional parts; a component is in one at most.
        symmetry: what leaves every instance as it is; a declaration that a validation checks against meshes.
        unit_m: meters that one unit of the coordinates stands for in objects of the class as they are in the world;
            ``None`` if the author does not say. A query whose own unit is known has a known scale with it.
    """

    name: str
    class_name: str
    operations: tuple[Operation, ...]
    parameters: tuple[Parameter, ...] = ()
    description: str = ""
    closed: bool = True
    parts: tuple[Part, ...] = ()
    symmetry: Symmetry = NO_SYMMETRY
    unit_m: float | None = None

    def __post_init__(self) -> None:
        _check_name(self.name, "name")
        _check_name(self.class_name, "class")
        if len(self.description) > MAX_DESCRIPTION:
            raise ModelError(f"a text of at most {MAX_DESCRIPTION} characters is needed", where="description")
        if self.unit_m is not None and not 0 < self.unit_m <= MAX_MAGNITUDE:
            raise ModelError(f"expected a positive number of meters, got {self.unit_m:g}", where="unit_m")
        if not self.operations or not isinstance(self.operations[0], Base):
            raise ModelError("the first operation must be a base", where="operations")
        for name, most in _MAX_ITEMS.items():
            if len(getattr(self, name)) > most:
                raise ModelError(f"more than {most} {name}", where=name)
        seen: set[str] = set()
        for i, parameter in enumerate(self.parameters):
            if parameter.name in seen:
                raise ModelError(f"a second parameter {parameter.name!r}", where=f"parameters[{i}].name")
            seen.add(parameter.name)
            for j, target in enumerate(parameter.targets):
                place = f"parameters[{i}].targets[{j}]"
                if target.operation >= len(self.operations):
                    raise ModelError(f"there is no operation {shown(target.operation)}", where=f"{place}.operation")
                operation = self.operations[target.operation]
                if target.mode not in operation.modes:
                    known = ", ".join(operation.modes) or "none"
                    raise ModelError(
                        f"{operation.kind} has no mode {shown(target.mode)}; it has: {known}",
                        where=f"{place}.mode",
                    )
        space = ParameterSpace(self.parameters)
        for number, part in enumerate(self.parts):
            space.check_conditions(part.present_when, f"parts[{number}].present_when")

    # ------------------------------------------------------------------ document

    @classmethod
    def from_json(cls, text: str | bytes) -> "ProceduralModel":
        """Read a document of any version up to this one.

        Raises:
            ModelError: broken JSON, or a document that does not fit the format; ``where`` says the place.
        """
        if len(text) > MAX_DOCUMENT_BYTES:
            raise ModelError(f"a model of more than {MAX_DOCUMENT_BYTES} bytes is refused")
        try:
            document = json.loads(text, parse_constant=_refuse_constant)
            json.dumps(document, ensure_ascii=False).encode()  # JSON can escape half characters, UTF-8 cannot
        except json.JSONDecodeError as error:
            raise ModelError(f"broken JSON: {error.msg}", where=f"line {error.lineno} column {error.colno}") from None
        except (UnicodeError, RecursionError, ValueError) as error:
            raise ModelError(f"not a JSON text: {error}") from None
        return cls.from_document(document)

    @classmethod
    def from_document(cls, document: Any) -> "ProceduralModel":
        """Make the model from a JSON object.

        Raises:
            ModelError: the object does not fit the format; ``where`` says the place.
        """
        item = read_object(upgrade_document(document), "document", set(_PROPERTIES))
        for needed in ("name", "class", "operations"):
            if needed not in item:
                raise ModelError(f"the field {needed!r} is missing", where="document")
        for text in ("name", "class"):
            _check_name(item[text], text)
        description, closed = item.get("description", ""), item.get("closed", True)
        if not isinstance(description, str) or len(description) > MAX_DESCRIPTION:
            raise ModelError(f"a text of at most {MAX_DESCRIPTION} characters is needed", where="description")
        if not isinstance(closed, bool):
            raise ModelError("true or false is needed", where="closed")
        unit_m = item.get("unit_m")
        for name, most in _MAX_ITEMS.items():
            if not isinstance(item.get(name, []), list):
                raise ModelError("a list is needed", where=name)
            if len(item.get(name, [])) > most:
                raise ModelError(f"more than {most} {name}", where=name)
        return cls(
            name=item["name"],
            class_name=item["class"],
            operations=tuple(_read_operation(op, f"operations[{i}]") for i, op in enumerate(item["operations"])),
            parameters=tuple(
                Parameter.from_document(p, f"parameters[{i}]") for i, p in enumerate(item.get("parameters", []))
            ),
            description=description,
            closed=closed,
            parts=tuple(Part.from_document(p, f"parts[{i}]") for i, p in enumerate(item.get("parts", []))),
            symmetry=Symmetry.from_document(item.get("symmetry", {}), "symmetry"),
            unit_m=None if unit_m is None else read_number(unit_m, "unit_m"),
        )

    @classmethod
    def load(cls, path: Path | str) -> "ProceduralModel":
        """Read a file.

        Raises:
            ModelError: the file cannot be read or does not fit the format.
        """
        try:
            text = Path(path).read_bytes()
        except OSError as error:
            raise ModelError(f"cannot be read: {error.strerror}", where=str(path)) from None
        try:
            return cls.from_json(text)
        except ModelError as error:
            place = f"{path}: {error.where}" if error.where else str(path)
            raise ModelError(error.message, where=place) from None

    def to_document(self) -> dict[str, Any]:
        """Return the JSON object of the model."""
        return {
            "format": FORMAT,
            "version": VERSION,
            "name": self.name,
            "class": self.class_name,
            "description": self.description,
            "closed": self.closed,
            "unit_m": None if self.unit_m is None else write_number(self.unit_m),
            "symmetry": self.symmetry.to_document(),
            "operations": [operation.to_document() for operation in self.operations],
            "parameters": [parameter.to_document() for parameter in self.parameters],
            "parts": [part.to_document() for part in self.parts],
        }

    def to_json(self) -> str:
        """Return the canonical text: equal models have equal texts, with one operation or parameter a line."""
        document = self.to_document()
        lines = []
        for key, value in document.items():
            if isinstance(value, list):
                items = ",\n".join(f"    {json.dumps(item, ensure_ascii=False)}" for item in value)
                lines.append(f"  {json.dumps(key)}: [\n{items}\n  ]" if value else f"  {json.dumps(key)}: []")
            else:
                lines.append(f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}")
        return "{\n" + ",\n".join(lines) + "\n}\n"

    def save(self, path: Path | str) -> None:
        """Write the canonical text to a file.

        Raises:
            OSError: the file cannot be written.
        """
        write_whole(path, self.to_json().encode())

    @cached_property
    def digest(self) -> str:
        """The content address: SHA-256 of the canonical text, in hexadecimal."""
        return hashlib.sha256(self.to_json().encode()).hexdigest()


def json_schema() -> Mapping[str, Any]:
    """Return the JSON schema of a document (published as ``openapi/procedural-model.schema.json``)."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Shapewright procedural model",
        "type": "object",
        "properties": _PROPERTIES,
        "required": ["format", "version", "name", "class", "operations"],
        "additionalProperties": False,
    }


_PROPERTIES: dict[str, Any] = {
    "format": {"const": FORMAT},
    "version": {"const": VERSION},
    "name": {"type": "string", "pattern": NAME_PATTERN},
    "class": {"type": "string", "pattern": NAME_PATTERN},
    "description": {"type": "string", "maxLength": MAX_DESCRIPTION},
    "closed": {"type": "boolean"},
    "unit_m": {"type": ["number", "null"], "exclusiveMinimum": 0, "maximum": MAX_MAGNITUDE},
    "symmetry": Symmetry.schema(),
    "operations": {
        "type": "array",
        "minItems": 1,
        "maxItems": MAX_OPERATIONS,
        "prefixItems": [Base.schema()],
        "items": {"oneOf": [operation.schema() for operation in OPERATIONS.values()]},
    },
    "parameters": {"type": "array", "maxItems": MAX_PARAMETERS, "items": Parameter.schema()},
    "parts": {"type": "array", "maxItems": MAX_PARTS, "items": Part.schema()},
}


def _read_operation(value: Any, where: str) -> Operation:
    if not isinstance(value, dict):
        raise ModelError("an object is needed", where=where)
    kind = value.get("op")
    if not isinstance(kind, str) or kind not in OPERATIONS:
        raise ModelError(f"unknown operation {shown(kind)}; there are: {', '.join(OPERATIONS)}", where=f"{where}.op")
    return OPERATIONS[kind].from_document({k: v for k, v in value.items() if k != "op"}, where)


def _check_name(value: Any, where: str) -> None:
    if not isinstance(value, str) or not re.fullmatch(NAME_PATTERN, value):
        raise ModelError(f"{shown(value)} is no name: small letters, digits and _ only, a letter first", where=where)


def _refuse_constant(text: str) -> Any:
    raise ValueError(f"{text} is not allowed")
