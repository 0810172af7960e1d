"""Where the classifier that ships lies; found without loading it.

Its files lie beside the models that it learned from, in a package above this one, so they are found by name.
"""

from importlib import resources
from pathlib import Path
from typing import Final

from shapewright.errors import ClassifierError

READY_FILE: Final = "classifier.onnx"
"""Name of the file in the folder of a ready classifier; see also
:func:`shapewright.classification.file_format.exemplars_file`."""
_PACKAGE: Final = "models_store.library"
_FOLDER: Final = "ready"


def ready_classifier_file() -> Path:
    """Return the file of the classifier that ships; its exemplars lie beside it.

    Raises:
        ClassifierError: it does not ship with this installation.
    """
    file = ready_classifier_place()
    if not file.is_file():
        raise ClassifierError(
            "this installation has no ready classifier; name one, or make it in the repository: "
            "bash scripts/ready_classifier",
            where=str(file),
        )
    return file


def ready_classifier_place() -> Path:
    """Return where the file of the classifier that ships belongs.

    Raises:
        ClassifierError: the package with the shipped models is not installed.
    """
    try:
        library = resources.files(_PACKAGE)
    except ModuleNotFoundError as error:
        raise ClassifierError(f"the package {_PACKAGE} is not installed; name a classifier") from error
    return Path(str(library / _FOLDER / READY_FILE))
