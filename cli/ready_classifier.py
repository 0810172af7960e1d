"""The classifier that ships: ``python -m cli.ready_classifier`` makes it, ``--check`` tells whether it is up to date.

It learns every class that ships, except the further objects: these teach it what is unknown.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

from cli.console import shown_progress
from cli.learning import learn, save_classifier
from cli.sources import load_classes, load_negatives
from models_store.library.shipped import list_classes, list_further_classes, load_shipped
from shapewright.classification import exemplars_file, load_classifier
from shapewright.classification.ready_files import ready_classifier_place
from shapewright.errors import ClassifierError, ShapewrightError

if TYPE_CHECKING:
    from shapewright.training import TrainedClassifier, TrainingSettings

LARGEST_BYTES: Final = 12 * 10**6
"""Of both files together: the repository keeps every version of them."""
MAKE: Final = "bash scripts/ready_classifier"


def ready_settings() -> "TrainingSettings":
    """Return the settings that the classifier is trained with."""
    from shapewright.training import TrainingSettings

    return TrainingSettings(exemplars_per_class=220)


def make(output: Path, settings: "TrainingSettings", cache: Path | None = None) -> "TrainedClassifier":
    """Train the classifier and write its files.

    Raises:
        ClassifierError: they are larger than the repository should keep.
    """
    classes = load_classes(None)
    with shown_progress("training") as progress:
        trained = learn(classes, load_negatives(classes), settings, progress, cache)
    save_classifier(trained, output)
    size = _size(output)
    if size > LARGEST_BYTES:
        raise ClassifierError(f"{size} bytes are more than {LARGEST_BYTES}; keep fewer exemplars", where=str(output))
    return trained


def faults(file: Path, settings: "TrainingSettings") -> list[str]:
    """Return the reasons why a classifier should not ship as it is; an empty list if it is up to date."""
    try:
        classifier = load_classifier(file)
    except ClassifierError as error:
        return [str(error)]
    found = []
    shipped = {name: load_shipped(name).digest for names in _classes().values() for name in names}
    learned = {model["name"]: model["digest"] for model in classifier.metadata["models"]}
    for what, names in (
        ("has not learned", shipped.keys() - learned.keys()),
        ("has learned, though it does not ship,", learned.keys() - shipped.keys()),
        ("has learned another version of", {n for n in shipped.keys() & learned.keys() if shipped[n] != learned[n]}),
    ):
        if names:
            found.append(f"it {what} {', '.join(sorted(names))}")
    if classifier.exemplars is None:
        found.append("it has no exemplars")
    used = type(settings).from_dict(classifier.metadata["settings"]).to_dict()
    if other := {name for name, value in settings.to_dict().items() if used[name] != value}:
        found.append(f"it was trained with other settings: {', '.join(sorted(other))}")
    if _size(file) > LARGEST_BYTES:
        found.append(f"its files have {_size(file)} bytes, more than {LARGEST_BYTES}")
    return found


def main() -> int:
    """Make or check the classifier. Returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m cli.ready_classifier", description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 if it is not of the shipped models")
    parser.add_argument("--cache", type=Path, help="folder for what later trainings can use again")
    options = parser.parse_args()
    try:
        output = ready_classifier_place()
        if options.check:
            for fault in (found := faults(output, ready_settings())):
                print(f"the ready classifier is out of date: {fault}", file=sys.stderr)
            if found:
                print(f"make it again: {MAKE}", file=sys.stderr)
            return 1 if found else 0
        started_s = time.monotonic()
        trained = make(output, ready_settings(), options.cache)
    except ShapewrightError as error:
        print(f"ready-classifier: {error}", file=sys.stderr)
        return 2
    print(f"{output.parent}: {_size(output) / 1e6:.1f} MB, {time.monotonic() - started_s:.0f} s")
    for name, value in trained.metrics.items():
        if isinstance(value, float):
            print(f"  {name}: {value:.4g}")
    return 0


def _classes() -> dict[str, list[str]]:
    further = list_further_classes()
    return {name: models for name, models in list_classes().items() if name not in further}


def _size(file: Path) -> int:
    return sum(part.stat().st_size for part in (file, exemplars_file(file)) if part.is_file())


if __name__ == "__main__":
    sys.exit(main())
