"""Making the index of a collection: every mesh is looked at once."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Final, Protocol, runtime_checkable

import numpy as np

from shapewright.classification.answer import Classification
from shapewright.classification.classifier import DEFAULT_VIEWS
from shapewright.distances.panorama import PanoramaDescriptor, panorama_descriptor
from shapewright.errors import MeshError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.retrieval.collection_index import CollectionIndex
from shapewright.retrieval.ranking import MeshQuery

SEED: Final = 0
"""Every mesh is seen from the same random sides, so that what is said of it depends on no other mesh."""
CHUNK: Final = 16
"""Meshes of a piece of :func:`index_chunks`."""


@runtime_checkable
class MeshClassifier(Protocol):
    """What is asked about a mesh; :class:`shapewright.classification.Classifier` is one."""

    class_names: tuple[str, ...]

    def classify(
        self, query: TriangleMesh | PointCloud, /, *, views: int = DEFAULT_VIEWS, rng: np.random.Generator | None = None
    ) -> Classification:
        """Tell what a mesh or a point cloud is."""


@dataclass(frozen=True, eq=False)
class MeshFacts:
    """What is known about one mesh; see :class:`CollectionIndex`."""

    probabilities: dict[str, float]
    picture_probabilities: dict[str, float]
    known: float
    descriptor: PanoramaDescriptor

    def as_query(self, class_names: Sequence[str]) -> MeshQuery:
        """The query for meshes like this one, in an index of these classes."""
        row = np.array([self.probabilities[name] for name in class_names])
        return MeshQuery(self.descriptor.to_array(), row, self.known)


@dataclass(frozen=True)
class SkippedMesh:
    """A mesh that was left out, and why."""

    name: str
    reason: str


@dataclass(frozen=True)
class Indexed:
    """An index, and which meshes are not in it."""

    index: CollectionIndex
    skipped: tuple[SkippedMesh, ...] = ()


def look_at(query: TriangleMesh | PointCloud, classifier: MeshClassifier, *, views: int = DEFAULT_VIEWS) -> MeshFacts:
    """Classify and describe a mesh or a point cloud.

    Raises:
        MeshError: it has no surface that can be described, or is a point cloud that the classifier does not describe.
        RenderingError: no headless OpenGL.
    """
    found = classifier.classify(query, views=views, rng=np.random.default_rng(SEED))
    descriptor = found.descriptor
    if descriptor is None:
        if isinstance(query, PointCloud):
            raise MeshError("a point cloud needs a classifier with exemplars, and this one has none", where="faces")
        descriptor = panorama_descriptor(query.vertices, query.faces)
    return MeshFacts(
        probabilities=found.probabilities,
        picture_probabilities=found.picture_probabilities,
        known=1.0 if found.known is None else found.known,
        descriptor=descriptor,
    )


def index_chunks(
    meshes: Iterable[tuple[str, TriangleMesh | PointCloud | str]],
    classifier: MeshClassifier,
    classifier_digest: str,
    *,
    total: int,
    views: int = DEFAULT_VIEWS,
    progress: Progress = NULL_PROGRESS,
) -> Iterator[Indexed]:
    """Index meshes a few at a time, so that a caller has what is finished if ``progress`` cancels.

    Args:
        meshes: name and mesh, or name and the reason why there is none; read one at a time.
        classifier: what is asked.
        classifier_digest: SHA-256 of its file.
        total: how many meshes there are, for the progress.
        views: pictures of each.
        progress: told before each mesh; may cancel.

    Raises:
        RenderingError: no headless OpenGL.
    """
    source = iter(meshes)
    for start in range(0, max(total, 1), CHUNK):
        found: dict[str, MeshFacts] = {}
        skipped: list[SkippedMesh] = []
        for number, (name, mesh) in enumerate(islice(source, CHUNK), start):
            progress.report(min(number / max(total, 1), 1.0), f"meshes: {number} of {total}")
            if isinstance(mesh, str):
                skipped.append(SkippedMesh(name, mesh))
                continue
            try:
                found[name] = look_at(mesh, classifier, views=views)
            except MeshError as error:
                skipped.append(SkippedMesh(name, str(error)))
        yield Indexed(_index(found, classifier.class_names, classifier_digest), tuple(skipped))
    progress.report(1.0, f"meshes: {total} of {total}")


def index_meshes(
    meshes: Iterable[tuple[str, TriangleMesh | PointCloud | str]],
    classifier: MeshClassifier,
    classifier_digest: str,
    *,
    total: int,
    views: int = DEFAULT_VIEWS,
    progress: Progress = NULL_PROGRESS,
) -> Indexed:
    """Index meshes in one go; as :func:`index_chunks`.

    A mesh without a usable surface is listed with the reason, never left out in silence.
    """
    chunks = index_chunks(meshes, classifier, classifier_digest, total=total, views=views, progress=progress)
    return joined(list(chunks))


def joined(chunks: Sequence[Indexed]) -> Indexed:
    """One index of several of the same classifier."""
    index = chunks[0].index
    for chunk in chunks[1:]:
        index = index.joined(chunk.index)
    return Indexed(index, tuple(skipped for chunk in chunks for skipped in chunk.skipped))


def _index(found: dict[str, MeshFacts], class_names: tuple[str, ...], classifier_digest: str) -> CollectionIndex:
    if not found:
        return CollectionIndex.empty(class_names, classifier_digest)

    def table(probabilities: Iterable[dict[str, float]]) -> np.ndarray:
        return np.array([[row[name] for name in class_names] for row in probabilities], dtype=np.float32)

    facts = found.values()
    return CollectionIndex(
        tuple(found),
        class_names,
        classifier_digest,
        table(one.probabilities for one in facts),
        table(one.picture_probabilities for one in facts),
        np.array([one.known for one in facts], dtype=np.float32),
        np.stack([one.descriptor.to_array() for one in facts]),
    )
