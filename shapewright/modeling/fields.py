"""How the fields of an operation are written in a document: a reader, a writer and a JSON schema for each kind."""

import dataclasses
import math
import re
import reprlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from shapewright.errors import ModelError
from shapewright.modeling.elements import AXES, ELEMENT_PATTERN, Element, Image, Mirror, Target, Turn

MAX_ELEMENTS = 100_000
MAX_MAGNITUDE = 1e6

NUMBER_SCHEMA: dict[str, Any] = {"type": "number", "minimum": -MAX_MAGNITUDE, "maximum": MAX_MAGNITUDE}
"""What :func:`read_number` accepts."""


@dataclass(frozen=True)
class FieldKind:
    """One kind of value in a document.

    Attributes:
        schema: JSON schema of the value.
        read: makes the value from JSON; gets the place for messages; raises ModelError.
        write: makes JSON of the value.
    """

    schema: dict[str, Any]
    read: Callable[[Any, str], Any]
    write: Callable[[Any], Any]


def field(kind: FieldKind, default: Any = dataclasses.MISSING) -> Any:
    """Declare a dataclass field that is part of the document."""
    return dataclasses.field(default=default, metadata={"kind": kind})


def choice(*values: str) -> FieldKind:
    """Return the kind of one of a few words."""

    def read(value: Any, where: str) -> str:
        if value not in values:
            raise ModelError(f"{shown(value)} is none of {', '.join(values)}", where=where)
        return str(value)

    return FieldKind({"enum": list(values)}, read, str)


def integer(minimum: int, maximum: int) -> FieldKind:
    """Return the kind of a whole number within bounds."""

    def read(value: Any, where: str) -> int:
        whole = whole_number(value)
        if whole is None or not minimum <= whole <= maximum:
            raise ModelError(f"{shown(value)} is not a whole number from {minimum} to {maximum}", where=where)
        return whole

    return FieldKind({"type": "integer", "minimum": minimum, "maximum": maximum}, read, int)


def read_number(value: Any, where: str) -> float:
    """Return a finite number of sane size; raises ModelError."""
    if isinstance(value, bool) or not isinstance(value, int | float) or value != value or abs(value) == math.inf:
        raise ModelError(f"{shown(value)} is not a finite number", where=where)
    if abs(value) > MAX_MAGNITUDE:
        raise ModelError(f"{shown(value)} is beyond {MAX_MAGNITUDE:g}", where=where)
    return write_number(value)


def write_number(value: float) -> float:
    """Return the one form in which equal numbers are written: a float, and no negative zero."""
    return float(value) + 0.0


def whole_number(value: Any) -> int | None:
    """Return a whole number of a document, which JSON may write as 4 or 4.0; ``None`` if it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return int(value) if isinstance(value, int) or value.is_integer() else None


def shown(value: Any) -> str:
    """Return how a value of any size stands in a message."""
    return reprlib.repr(value)


def _read_vector(value: Any, where: str) -> tuple[float, float, float]:
    items = _read_list(value, where)
    if len(items) != 3:
        raise ModelError("three numbers are needed", where=where)
    x, y, z = (read_number(item, f"{where}[{i}]") for i, item in enumerate(items))
    return (x, y, z)


def _read_flag(value: Any, where: str) -> bool:
    if not isinstance(value, bool):
        raise ModelError(f"{shown(value)} is neither true nor false", where=where)
    return value


def _read_list(value: Any, where: str) -> list[Any]:
    if not isinstance(value, list):
        raise ModelError("a list is needed", where=where)
    if len(value) > MAX_ELEMENTS:
        raise ModelError(f"a list of more than {MAX_ELEMENTS} is refused", where=where)
    return value


def _read_element(value: Any, where: str) -> Element:
    if not isinstance(value, str):
        raise ModelError(f"{shown(value)} is not an element like 'f12'", where=where)
    try:
        return Element.parse(value)
    except ModelError as error:
        raise ModelError(error.message, where=where) from None


def _read_elements(value: Any, where: str) -> tuple[Element, ...]:
    return tuple(_read_element(item, f"{where}[{i}]") for i, item in enumerate(_read_list(value, where)))


def _read_directed(value: Any, where: str) -> tuple[tuple[Element, bool], ...]:
    pairs = []
    for i, item in enumerate(_read_list(value, where)):
        if not isinstance(item, str) or not re.fullmatch(_DIRECTED_PATTERN, item):
            raise ModelError(f"{shown(item)} is no edge like 'e12' or '-e12'", where=f"{where}[{i}]")
        backwards = item.startswith("-")
        pairs.append((Element.parse(item[backwards:]), backwards))
    return tuple(pairs)


def read_object(value: Any, where: str, allowed: set[str]) -> dict[str, Any]:
    """Return a JSON object that has no keys but the allowed ones; raises ModelError."""
    if not isinstance(value, dict):
        raise ModelError("an object is needed", where=where)
    unknown = sorted(set(value) - allowed)
    if unknown:
        raise ModelError(f"unknown field {shown(unknown[0])}", where=where)
    return value


def _read_image(value: Any, where: str) -> Image:
    transforms: list[Mirror | Turn] = []
    for i, item in enumerate(_read_list(value, where)):
        place = f"{where}[{i}]"
        item = read_object(item, place, {"mirror", "turn", "angle_deg"})
        if set(item) == {"mirror"}:
            transforms.append(Mirror(_AXIS.read(item["mirror"], f"{place}.mirror")))
        elif set(item) == {"turn", "angle_deg"}:
            axis = _AXIS.read(item["turn"], f"{place}.turn")
            transforms.append(Turn(axis, read_number(item["angle_deg"], f"{place}.angle_deg")))
        else:
            raise ModelError("an image is {'mirror': axis} or {'turn': axis, 'angle_deg': number}", where=place)
    return tuple(transforms)


def _write_image(image: Image) -> list[dict[str, Any]]:
    return [
        {"mirror": t.axis} if isinstance(t, Mirror) else {"turn": t.axis, "angle_deg": write_number(t.angle_deg)}
        for t in image
    ]


def _read_target(value: Any, where: str) -> Target:
    item = read_object(value, where, {"elements", "frame", "image", "pivot"})
    if "elements" not in item:
        raise ModelError("a target needs the field 'elements'", where=where)
    frame = item.get("frame", "own")
    return Target(
        elements=_read_elements(item["elements"], f"{where}.elements"),
        frame=frame if frame in ("own", "world") else _read_element(frame, f"{where}.frame"),
        image=_read_image(item.get("image", []), f"{where}.image"),
        pivot=_read_elements(item.get("pivot", []), f"{where}.pivot"),
    )


def _write_target(target: Target) -> dict[str, Any]:
    document: dict[str, Any] = {"elements": [str(element) for element in target.elements]}
    if target.frame != "own":
        document["frame"] = str(target.frame)
    if target.image:
        document["image"] = _write_image(target.image)
    if target.pivot:
        document["pivot"] = [str(element) for element in target.pivot]
    return document


def _read_targets(value: Any, where: str) -> tuple[Target, ...]:
    targets = tuple(_read_target(item, f"{where}[{i}]") for i, item in enumerate(_read_list(value, where)))
    if targets and targets[0].image:
        raise ModelError("the first target is the original and can have no image", where=f"{where}[0].image")
    return targets


_AXIS = choice(*AXES)
_ELEMENT_SCHEMA = {"type": "string", "pattern": ELEMENT_PATTERN}
_DIRECTED_PATTERN = "^-?e(0|[1-9][0-9]{0,8})$"


def _list_schema(items: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "maxItems": MAX_ELEMENTS, "items": items}


_IMAGE_SCHEMA = _list_schema(
    {
        "oneOf": [
            {
                "type": "object",
                "properties": {"mirror": _AXIS.schema},
                "required": ["mirror"],
                "additionalProperties": False,
            },
            {
                "type": "object",
                "properties": {"turn": _AXIS.schema, "angle_deg": NUMBER_SCHEMA},
                "required": ["turn", "angle_deg"],
                "additionalProperties": False,
            },
        ]
    }
)
_TARGET_SCHEMA: dict[str, Any] = {
    "type": "object",
    "properties": {
        "elements": _list_schema(_ELEMENT_SCHEMA),
        "frame": {"anyOf": [{"enum": ["own", "world"]}, _ELEMENT_SCHEMA]},
        "image": _IMAGE_SCHEMA,
        "pivot": _list_schema(_ELEMENT_SCHEMA),
    },
    "required": ["elements"],
    "additionalProperties": False,
}
_ORIGINAL_SCHEMA = {"properties": {"image": {"maxItems": 0}}}
"""The first target: the images of the others are images of its frame."""

NUMBER = FieldKind(NUMBER_SCHEMA, read_number, write_number)
FLAG = FieldKind({"type": "boolean"}, _read_flag, bool)
VECTOR = FieldKind(
    {"type": "array", "items": NUMBER_SCHEMA, "minItems": 3, "maxItems": 3},
    _read_vector,
    lambda vector: [write_number(item) for item in vector],
)
ELEMENT = FieldKind(_ELEMENT_SCHEMA, _read_element, str)
ELEMENTS = FieldKind(_list_schema(_ELEMENT_SCHEMA), _read_elements, lambda elements: [str(e) for e in elements])
OPTIONAL_ELEMENT = FieldKind(
    {"anyOf": [_ELEMENT_SCHEMA, {"type": "null"}]},
    lambda value, where: None if value is None else _read_element(value, where),
    lambda element: None if element is None else str(element),
)
DIRECTED_EDGES = FieldKind(
    _list_schema({"type": "string", "pattern": _DIRECTED_PATTERN}),
    _read_directed,
    lambda edges: [f"-{e}" if backwards else str(e) for e, backwards in edges],
)
TARGETS = FieldKind(
    {**_list_schema(_TARGET_SCHEMA), "prefixItems": [{"allOf": [_TARGET_SCHEMA, _ORIGINAL_SCHEMA]}]},
    _read_targets,
    lambda ts: [_write_target(t) for t in ts],
)
