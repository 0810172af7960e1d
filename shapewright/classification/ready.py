"""The shortest way to ask a classifier: the one that ships unless another is named."""

from functools import cache
from pathlib import Path

from shapewright.classification.answer import Classification
from shapewright.classification.classifier import DEFAULT_VIEWS, Classifier, load_classifier
from shapewright.classification.ready_files import ready_classifier_file
from shapewright.mesh import PointCloud, TriangleMesh


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
    query: TriangleMesh | PointCloud | str | Path,
    /,
    *,
    classifier: Classifier | str | Path | None = None,
    views: int = DEFAULT_VIEWS,
) -> Classification:
    """Tell what a mesh or a point cloud is.

    Args:
        query: a mesh, a point cloud, or a file of either that you trust.
        classifier: one that is loaded, or the ``.onnx`` file of a training; by default the one that ships.
        views: pictures to look at.

    Raises:
        ClassifierError: the classifier is missing or damaged; fewer than one view.
        MeshFileError: the file cannot be read.
        MeshError: the query has no area or no extent.
        RenderingError: no headless OpenGL, where pictures need it.
    """
    if not isinstance(query, TriangleMesh | PointCloud):
        from shapewright.mesh.file import load_query

        query = load_query(query)
    if classifier is None:
        classifier = load_ready_classifier()
    elif not isinstance(classifier, Classifier):
        classifier = load_classifier(classifier)
    return classifier.classify(query, views=views)
