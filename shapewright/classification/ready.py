"""The classifier that ships, and the shortest way to ask it.

Its files lie beside the models that it learned from, in a package above this one, so they are found by name.
"""

from functools import cache
from importlib import resources
from pathlib import Path
from typing import Final

from shapewright.classification.classifier import DEFAULT_VIEWS, Classification, Classifier, load_classifier
from shapewright.errors import ClassifierError
from shapewright.mesh import TriangleMesh

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
    return Path(str(library / _FOLDER / "classifier.onnx"))


@cache
def load_ready_classifier(threads: int = 2) -> Classifier:
    """Return the classifier that ships; the same one for the same number of threads.

    Args:
        threads: threads of ONNX Runtime.

    Raises:
        ClassifierError: it does not ship with this installation, or its files are damaged.
    """
    return load_classifier(ready_classifier_file(), threads=threads)


def classify(
    mesh: TriangleMesh | str | Path,
    *,
    classifier: Classifier | str | Path | None = None,
    views: int = DEFAULT_VIEWS,
) -> Classification:
    """Tell what a mesh is.

    Args:
        mesh: a mesh, or a file that you trust.
        classifier: one that is loaded, or the ``.onnx`` file of a training; by default the one that ships.
        views: pictures to look at.

    Raises:
        ClassifierError: the classifier is missing or damaged; fewer than one view.
        MeshFileError: the file cannot be read.
        MeshError: the mesh has no area.
        RenderingError: no headless OpenGL.
    """
    if not isinstance(mesh, TriangleMesh):
        from shapewright.mesh.file import load_mesh

        mesh = load_mesh(mesh)
    if classifier is None:
        classifier = load_ready_classifier()
    elif not isinstance(classifier, Classifier):
        classifier = load_classifier(classifier)
    return classifier.classify(mesh, views=views)
