"""The index of a user's meshes, kept in a file between queries and found by the content of the meshes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cli.evaluation_options import cache_folder
from shapewright.errors import ClassifierError, MeshFileError
from shapewright.progress import Progress

if TYPE_CHECKING:
    from shapewright.mesh import PointCloud, TriangleMesh
    from shapewright.retrieval import CollectionIndex, SkippedMesh
    from shapewright.retrieval.indexing import MeshClassifier


@dataclass(frozen=True)
class IndexedFiles:
    """Meshes by the names of their files, those that could not be used, and where the index is kept."""

    index: "CollectionIndex"
    skipped: "tuple[SkippedMesh, ...]"
    kept_in: Path


def index_files(
    files: Sequence[Path],
    classifier: "MeshClassifier",
    classifier_digest: str,
    *,
    kept_in: Path | None,
    jobs: int,
    progress: Progress,
) -> IndexedFiles:
    """Index files that are not in the kept index yet; what is done when somebody stops it is kept.

    Args:
        files: all different.
        classifier: what is asked about each.
        classifier_digest: SHA-256 of its file.
        kept_in: file of the index; by default one for this classifier in the user's cache.
        jobs: files that are read at once.
        progress: told of each mesh that is new.

    Raises:
        ClassifierError: the named file is no index, or of another classifier.
    """
    from shapewright.evaluation.descriptor_cache import file_digest
    from shapewright.retrieval import SkippedMesh
    from shapewright.retrieval.indexing import index_chunks

    path = _cached(classifier_digest) if kept_in is None else kept_in
    index = _kept(path, classifier, classifier_digest, strict=kept_in is not None)
    digests: dict[Path, str] = {}
    reasons: dict[Path | str, str] = {}
    for file in files:
        try:
            digests[file] = file_digest(file)
        except OSError as error:
            reasons[file] = f"cannot be read: {error.strerror}"
    here = index.rows_of(digests.values())
    new = {digest: file for file, digest in digests.items() if digest not in here}
    before = len(index)
    try:
        for chunk in index_chunks(_read(new, jobs), classifier, classifier_digest, total=len(new), progress=progress):
            index = index.joined(chunk.index)
            reasons.update((skipped.name, skipped.reason) for skipped in chunk.skipped)
    finally:
        if len(index) > before:
            path.parent.mkdir(parents=True, exist_ok=True)
            index.save(path)
    rows = index.rows_of(digests.values())
    usable = {file: rows[digest] for file, digest in digests.items() if digest in rows}
    skipped_files = [file for file in files if file not in usable]
    return IndexedFiles(
        index.taken(list(usable.values()), [str(file) for file in usable]),
        tuple(SkippedMesh(str(file), reasons[file if file in reasons else digests[file]]) for file in skipped_files),
        path,
    )


def _cached(classifier_digest: str) -> Path:
    from shapewright.distances.descriptor_files import descriptor_version

    return cache_folder(None, "retrieval") / f"index-{classifier_digest[:24]}-d{descriptor_version()}.npz"


def _kept(path: Path, classifier: "MeshClassifier", classifier_digest: str, *, strict: bool) -> "CollectionIndex":
    from shapewright.retrieval import CollectionIndex

    try:
        index = CollectionIndex.load(path)
        index.check_fits(classifier.class_names, classifier_digest)
    except FileNotFoundError:
        return CollectionIndex.empty(classifier.class_names, classifier_digest)
    except ClassifierError as error:
        if strict:
            raise ClassifierError(error.message, where=f"--index {path}") from None
        return CollectionIndex.empty(classifier.class_names, classifier_digest)
    return index


def _read(files: "dict[str, Path]", jobs: int) -> "Iterator[tuple[str, TriangleMesh | PointCloud | str]]":
    from shapewright.mesh.file import load_queries

    for digest, query in zip(files, load_queries(list(files.values()), jobs=jobs), strict=True):
        yield digest, query.message if isinstance(query, MeshFileError) else query
