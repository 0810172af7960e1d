"""Where the verbs get procedural models and parameter values from: the shipped library, files, options."""

import json
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from models_store.library.shipped import list_classes, list_further_classes, list_shipped, load_shipped
from shapewright.errors import MeshFileError, ModelError, ParameterError

if TYPE_CHECKING:
    from shapewright.modeling import CompiledModel, ProceduralModel


def load_model(source: str) -> "ProceduralModel":
    """Load a procedural model by the name of a shipped one or from a JSON file.

    Raises:
        ModelError: neither a shipped name nor a file, or a document that is not valid.
    """
    from shapewright.modeling import ProceduralModel

    shipped = list_shipped()
    if source in shipped:
        return load_shipped(source)
    if Path(source).is_file():
        return ProceduralModel.load(source)
    names = ", ".join(shipped) or "none"
    raise ModelError(f"neither a file nor a shipped model (these ship: {names})", where=repr(source))


def load_compiled(source: str) -> "CompiledModel":
    """Load a procedural model and build its topology.

    Raises:
        ModelError: as :func:`load_model`, or an operation that cannot be done.
    """
    from shapewright.modeling import compile_model

    model = load_model(source)
    try:
        return compile_model(model)
    except ModelError as error:
        place = f"{source}: {error.where}" if error.where else source
        raise ModelError(error.message, where=place) from None


def load_all_compiled(sources: list[str] | None) -> "list[CompiledModel]":
    """Load the named models, or every shipped one when none is named."""
    return [load_compiled(source) for source in (sources or list_shipped())]


def load_class(class_name: str) -> "list[CompiledModel]":
    """Load all shipped models of a class.

    Raises:
        ModelError: no model of the class ships.
    """
    classes = list_classes()
    if class_name not in classes:
        raise ModelError(f"no such class ships (these do: {', '.join(classes) or 'none'})", where=repr(class_name))
    return [load_compiled(name) for name in classes[class_name]]


def by_digest(groups: "Iterable[Iterable[CompiledModel]]") -> "dict[str, CompiledModel]":
    """Compiled models by the digests of their models, as fits ask for them."""
    return {compiled.model.digest: compiled for group in groups for compiled in group}


def load_classes(sources: list[str] | None) -> "dict[str, list[CompiledModel]]":
    """Load models by class: of every class named, and each model or file named.

    When none is named, of every shipped class but the further objects, which :func:`load_negatives` gives.
    """
    classes = list_classes()
    further = list_further_classes()
    named = sources or [name for name in classes if name not in further]
    names = [name for source in named for name in classes.get(source, [source])]
    by_class: dict[str, list[CompiledModel]] = {}
    for compiled in load_all_compiled(list(dict.fromkeys(names))):
        by_class.setdefault(compiled.model.class_name, []).append(compiled)
    return by_class


def load_negatives(class_names: Iterable[str]) -> "list[CompiledModel]":
    """Load the shipped models of the further objects that are none of these classes."""
    classes, known = list_classes(), set(class_names)
    return [load_compiled(name) for other in list_further_classes() if other not in known for name in classes[other]]


def load_shipped_by_digest(digests: Iterable[str]) -> "dict[str, CompiledModel]":
    """Load the shipped models that have these digests; a digest that no shipped model has is left out."""
    wanted = set(digests)
    found = [name for name, document in list_shipped().items() if sha256(document.read_bytes()).hexdigest() in wanted]
    return by_digest([load_all_compiled(found)] if found else [])


def chosen_classifier(named: Path | None) -> Path:
    """Return the file of the classifier that was named, or of the one that ships.

    Raises:
        ClassifierError: none was named, and none ships with this installation.
    """
    if named is not None:
        return named
    from shapewright.classification import ready_classifier_file

    return ready_classifier_file()


def classifier_name(named: Path | None) -> str:
    """Return what a classifier is called in JSON documents: its file, or ``ready`` for the one that ships."""
    return "ready" if named is None else str(named)


def classifier_line(named: Path | None) -> str:
    """Return the line that tells people which classifier has answered."""
    return "classifier: the one that ships" if named is None else f"classifier: {named}"


def find_meshes(sources: Iterable[Path], *, with_clouds: bool = False) -> list[Path]:
    """Find mesh files: those named, and below a folder those whose endings say so, in the order of names; once each.

    Args:
        sources: files and folders.
        with_clouds: whether endings of point clouds count below a folder, except those that other files share.

    Raises:
        MeshFileError: a source is not there, or a folder holds none.
    """
    from shapewright.mesh.sniff import COMMON_TYPES, MESH_TYPES, QUERY_TYPES

    wanted = [one for one in QUERY_TYPES if one not in COMMON_TYPES] if with_clouds else MESH_TYPES
    found: dict[Path, None] = {}
    for source in sources:
        if not source.is_dir():
            if not source.exists():
                raise MeshFileError("there is no such file or folder", where=ascii(str(source)))
            found[source] = None
            continue
        below = [p for p in sorted(source.rglob("*")) if p.suffix.lower().lstrip(".") in wanted and p.is_file()]
        if not below:
            raise MeshFileError(f"no mesh below this folder ({', '.join(wanted)})", where=ascii(str(source)))
        found.update(dict.fromkeys(below))
    return list(found)


def read_object(file: Path) -> dict[str, Any]:
    """Read a JSON file that holds one object.

    Raises:
        ParameterError: it does not.
    """
    try:
        loaded = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ParameterError(f"not JSON: {error}", where=str(file)) from None
    if not isinstance(loaded, dict):
        raise ParameterError("expected a JSON object", where=str(file))
    return loaded


def read_assignments(
    model: "ProceduralModel", assignments: list[str] | None, values_file: Path | None
) -> dict[str, float]:
    """Read ``name=value`` options on top of a JSON file ``{"name": value}``; values are relative, 1 is the base.

    The value of a choice may be the name of an option.

    Raises:
        ParameterError: not of that form.
    """
    options = {parameter.name: {option: x for x, option in parameter.named_options()} for parameter in model.parameters}
    values: dict[str, float] = {}
    if values_file is not None:
        for name, value in read_object(values_file).items():
            value = options.get(name, {}).get(value, value) if isinstance(value, str) else value
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise ParameterError(f"not a number: {value!r}", where=f"{values_file}: {name}")
            values[name] = float(value)
    for assignment in assignments or []:
        name, equals, text = (part.strip() for part in assignment.partition("="))
        known = options.get(name, {})
        try:
            values[name] = known[text] if text in known else float(text)
        except ValueError:
            equals = ""
        if not equals:
            named = f" or one of: {', '.join(known)}" if known else ""
            raise ParameterError(f"expected name=number{named}", where=f"--set {assignment}")
    return values
