"""Learning from the command line: what was drawn and described once is kept in the user's cache."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cli.evaluation_options import cache_folder
from shapewright.progress import Progress
from shapewright.whole_file import write_whole

if TYPE_CHECKING:
    from shapewright.classification import Classifier
    from shapewright.modeling import CompiledModel
    from shapewright.training import TrainedClassifier, TrainingSettings

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
