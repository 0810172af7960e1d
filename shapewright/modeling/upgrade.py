"""Versions of the document format and the way up from old ones."""

from collections.abc import Callable, Mapping
from typing import Any

from shapewright.errors import ModelError
from shapewright.modeling.fields import shown, whole_number
from shapewright.modeling.units import kind_of_unit

FORMAT = "shapewright-procedural-model"
VERSION = 3

Upgrade = Callable[[dict[str, Any]], dict[str, Any]]


def _with_kinds(document: dict[str, Any]) -> dict[str, Any]:
    """Give each parameter the kind that its unit tells; what a unit of the coordinates stands for stays unknown."""
    parameters = document.get("parameters")
    if not isinstance(parameters, list):  # refused when it is read
        return document
    return {**document, "parameters": [_with_kind(parameter) for parameter in parameters]}


def _with_kind(parameter: Any) -> Any:
    if not isinstance(parameter, dict):
        return parameter
    unit = parameter.get("unit")
    kind = kind_of_unit(unit) if isinstance(unit, str) and not parameter.get("options") else None
    return parameter if kind is None else {**parameter, "kind": kind}


UPGRADES: Mapping[int, Upgrade] = {
    1: lambda document: document,  # version 2 only adds optional fields
    2: _with_kinds,
}
"""``UPGRADES[n]`` turns a document of version n into one of version n + 1. A new version adds one line here."""


def upgrade_document(
    document: Any, *, upgrades: Mapping[int, Upgrade] = UPGRADES, version: int = VERSION
) -> dict[str, Any]:
    """Return the document as the current version writes it; the argument stays as it is.

    Args:
        document: a parsed JSON document.
        upgrades: the steps, by the version that they start from.
        version: the version to arrive at.

    Raises:
        ModelError: not our format, no version, or one from the future.
    """
    if not isinstance(document, dict):
        raise ModelError("a JSON object is needed", where="document")
    if document.get("format") != FORMAT:
        raise ModelError(f"this is no procedural model: its format must be {FORMAT!r}", where="format")
    found = whole_number(document.get("version"))
    if found is None or found < 1:
        raise ModelError(f"{shown(document.get('version'))} is no version", where="version")
    if found > version:
        raise ModelError(
            f"version {shown(found)} is newer than this program, which knows up to {version}", where="version"
        )
    current = dict(document)
    for step in range(found, version):
        current = {**upgrades[step](current), "version": step + 1}
    return current
