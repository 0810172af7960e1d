"""Finds the procedural models that ship. Reads package files only; loading a document imports the modelling kernel."""

import json
from importlib import resources
from importlib.resources.abc import Traversable
from typing import TYPE_CHECKING

from shapewright.errors import ModelError

if TYPE_CHECKING:
    from shapewright.modeling import ProceduralModel

DOCUMENT = "model.json"
ANNOTATIONS = "annotations.json"
THUMBNAIL = "thumbnail.png"


def list_shipped() -> dict[str, Traversable]:
    """Return the documents of the shipped models, by name, sorted by name."""
    found = {folder.name: folder / DOCUMENT for folder in _folder().iterdir() if folder.is_dir()}
    return {name: document for name, document in sorted(found.items()) if document.is_file()}


def list_classes() -> dict[str, list[str]]:
    """Return the names of the shipped models of each class, sorted; their documents are read, not checked."""
    by_class: dict[str, list[str]] = {}
    for name, document in list_shipped().items():
        by_class.setdefault(str(json.loads(document.read_bytes())["class"]), []).append(name)
    return by_class


def list_further_classes() -> list[str]:
    """Return the classes of the paper's eight further objects: those whose models have annotations."""
    return [
        class_name
        for class_name, names in list_classes().items()
        if any((_folder() / name / ANNOTATIONS).is_file() for name in names)
    ]


def load_shipped(name: str) -> "ProceduralModel":
    """Return a shipped procedural model.

    Raises:
        ModelError: no model of this name ships.
    """
    from shapewright.modeling import ProceduralModel

    return ProceduralModel.from_json(_checked(name).read_bytes())


def thumbnail_png(name: str) -> bytes:
    """Return the picture of a shipped model.

    Raises:
        ModelError: no model of this name ships.
    """
    _checked(name)
    return (_folder() / name / THUMBNAIL).read_bytes()


def _folder() -> Traversable:
    return resources.files("models_store.library")


def _checked(name: str) -> Traversable:
    shipped = list_shipped()
    if name not in shipped:
        names = ", ".join(shipped) or "none"
        raise ModelError(f"no such model ships (these do: {names})", where=repr(name))
    return shipped[name]
