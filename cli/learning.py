"""Learning from the command line: what was drawn and described once is kept in the user's cache."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from cli.console import shown_progress
from cli.evaluation_options import cache_folder
from cli.sources import load_negatives, load_shipped_by_digest
from shapewright.progress import Progress
from shapewright.whole_file import write_whole

if TYPE_CHECKING:
    from shapewright.classification import Classifier
    from shapewright.modeling import CompiledModel
    from shapewright.training import TrainedClassifier, TrainingSettings

READY: Final = "ready"
"""What the classifier that ships is called where a file may be named."""

Classes = Mapping[str, "Sequence[CompiledModel]"]


def learn(
    classes: Classes,
    negatives: "Sequence[CompiledModel]",
    settings: "TrainingSettings",
    progress: Progress,
    cache: Path | None = None,
) -> "TrainedClassifier":
    """Train with the features that earlier trainings left in the cache."""
    from shapewright.training import FolderStore, train_classifier

    store = FolderStore(cache_folder(cache, "learning"))
    return train_classifier(classes, settings, progress, negatives=negatives, store=store)


def extend(base: str, classes: Classes, settings: Mapping[str, Any], cache: Path | None = None) -> "TrainedClassifier":
    """Add classes to a classifier, with the features that earlier extensions left in the cache.

    Args:
        base: a classifier's file, or :data:`READY`.
        classes: the new classes; models among them that the base has learned from stand for themselves.
        settings: fields of :class:`shapewright.training.ExtensionSettings` that differ from the default.
        cache: the user's cache, if not the usual one.

    Raises:
        ClassifierError: the base is missing or damaged, knows all of the classes already, or has learned from models
            that are neither shipped nor named.
    """
    from shapewright.classification import ready_classifier_file
    from shapewright.errors import ClassifierError
    from shapewright.training import ExtensionSettings, FolderStore, TrainedClassifier, extend_classifier

    chosen = ExtensionSettings.from_dict(settings)
    trained = TrainedClassifier.load(ready_classifier_file() if base == READY else base)
    names = {model["digest"]: model["name"] for model in trained.metadata["models"]}
    named = {model.model.digest: model for models in classes.values() for model in models}
    new = {
        name: rest for name, models in classes.items() if (rest := [m for m in models if m.model.digest not in names])
    }
    if again := [name for name in (new or classes) if name in trained.class_names]:
        raise ClassifierError(f"knows the class {again[0]!r} already", where=base)
    known = load_shipped_by_digest(set(names) - set(named))
    known |= {digest: model for digest, model in named.items() if digest in names}
    if missing := [name for digest, name in names.items() if digest not in known]:
        raise ClassifierError(
            f"has learned from models that do not ship in that version ({', '.join(missing)}); name their files, too",
            where=base,
        )
    store = FolderStore(cache_folder(cache, "learning"))
    with shown_progress("extending") as progress:
        return extend_classifier(
            trained,
            new,
            known=list(known.values()),
            negatives=load_negatives([*trained.class_names, *new]),
            settings=chosen,
            progress=progress,
            store=store,
        )


def save_classifier(trained: "TrainedClassifier", output: Path) -> None:
    """Write the ONNX file, and its exemplars beside it."""
    from shapewright.classification import exemplars_file

    output.parent.mkdir(parents=True, exist_ok=True)
    if trained.exemplars is not None:
        trained.exemplars.save(exemplars_file(output))
    else:
        exemplars_file(output).unlink(missing_ok=True)
    write_whole(output, trained.onnx)


def kept_classifier(
    classes: Classes,
    negatives: "Sequence[CompiledModel]",
    settings: "TrainingSettings",
    progress: Progress,
    cache: Path | None = None,
) -> "Classifier":
    """The classifier of these models and settings: of an earlier run, or trained now and kept."""
    from shapewright.classification import load_classifier

    return load_classifier(kept_classifier_file(classes, negatives, settings, progress, cache))


def kept_classifier_file(
    classes: Classes,
    negatives: "Sequence[CompiledModel]",
    settings: "TrainingSettings",
    progress: Progress,
    cache: Path | None = None,
) -> Path:
    """Return the file of :func:`kept_classifier`, for processes that each load it themselves."""
    from shapewright.classification import load_classifier
    from shapewright.errors import ClassifierError
    from shapewright.network import load_backbone
    from shapewright.training.versions import learning_versions

    digests = {name: [model.model.digest for model in models] for name, models in classes.items()}
    others = [model.model.digest for model in negatives]
    what = [learning_versions(), digests, others, settings.to_dict(), load_backbone(settings.backbone).key]
    name = hashlib.sha256(json.dumps(what).encode()).hexdigest()[:24]
    path = cache_folder(cache, "learning") / "classifiers" / f"{name}.onnx"
    if path.is_file():
        try:
            kept = load_classifier(path)
        except ClassifierError:
            kept = None  # damaged: made anew
        if kept is not None and (kept.exemplars is not None) == (settings.exemplars and settings.vary):
            return path
    save_classifier(learn(classes, negatives, settings, progress, cache), path)
    return path
