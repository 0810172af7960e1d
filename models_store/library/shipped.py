"""The procedural models that ship, each in the folder ``<class>/<name>``.

Names and classes come from the folders alone; only loading a document imports the modelling kernel.
"""

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
    return {name: folder / DOCUMENT for name, (_, folder) in _model_folders().items()}


def list_classes() -> dict[str, list[str]]:
    """Return the names of the shipped models of each class, sorted."""
    by_class: dict[str, list[str]] = {}
    for name, (class_name, _) in _model_folders().items():
        by_class.setdefault(class_name, []).append(name)
    return by_class


def list_further_classes() -> list[str]:
    """Return the classes of the paper's eight further objects: those whose models have annotations."""
    annotated = [class_name for class_name, folder in _model_folders().values() if (folder / ANNOTATIONS).is_file()]
    return list(dict.fromkeys(annotated))


def load_shipped(name: str) -> "ProceduralModel":
    """Return a shipped procedural model.

    Raises:
        ModelError: no model of this name ships.
    """
    from shapewright.modeling import ProceduralModel

    return ProceduralModel.from_json((_checked(name) / DOCUMENT).read_bytes())


def thumbnail_png(name: str) -> bytes:
    """Return the picture of a shipped model.

    Raises:
        ModelError: no model of this name ships.
    """
    return (_checked(name) / THUMBNAIL).read_bytes()


def _model_folders() -> dict[str, tuple[str, Traversable]]:
    """Return the class and the folder of each shipped model, by name, sorted by name."""
    classes = [entry for entry in _library().iterdir() if entry.is_dir()]
    found = {
        folder.name: (entry.name, folder)
        for entry in classes
        for folder in entry.iterdir()
        if (folder / DOCUMENT).is_file()
    }
    return dict(sorted(found.items()))


def _library() -> Traversable:
    return resources.files("models_store.library")


def _checked(name: str) -> Traversable:
    """Return the folder of a shipped model."""
    folders = _model_folders()
    if name not in folders:
        names = ", ".join(folders) or "none"
        raise ModelError(f"no such model ships (these do: {names})", where=repr(name))
    return folders[name][1]
