"""What a classifier, and the baselines beside it, say about every mesh of a dataset."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from shapewright.classification.answer import Classification
from shapewright.classification.classifier import DEFAULT_VIEWS, Classifier
from shapewright.classification.evidence import KNOWN_THRESHOLD, OTHER
from shapewright.distances.panorama import PanoramaDescriptor, panorama_descriptor, panorama_distances
from shapewright.errors import EvaluationError, MeshError
from shapewright.evaluation.datasets import LabelledFile, Skipped, load_each
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel
from shapewright.progress import NULL_PROGRESS, Progress


@dataclass(frozen=True, eq=False)
class Judged:
    """What was said about one mesh; arrays are in the order of the classifier's class names.

    Attributes:
        item: the mesh.
        label: its class if the classifier knows it, else :data:`OTHER`.
        found: the classifier's answer, without its pictures.
        by_all: said by all evidence.
        by_pictures: said by the pictures alone.
        by_fits: said by all evidence with the most probable classes fitted; ``None`` if nobody asked for that.
        distances: panorama distance to the nearest exemplar of each class; ``None`` without exemplars.
        base_distances: panorama distance to the base instances of each class: the smallest over its models;
            ``None`` if not every class has a model at hand.
        baselines: probabilities of classes by other classifiers, by their names.
        seconds: reading apart: for drawing, describing and comparing.
        fitted_seconds: the same with the fits.
    """

    item: LabelledFile
    label: str
    found: "Found"
    by_all: "Said"
    by_pictures: "Said"
    by_fits: "Said | None"
    distances: Float[np.ndarray, " C"] | None
    base_distances: Float[np.ndarray, " C"] | None
    baselines: Mapping[str, Float[np.ndarray, " C"]]
    seconds: float
    fitted_seconds: float | None = None


@dataclass(frozen=True, eq=False)
class Said:
    """What one kind of evidence says about a mesh, in the order of the class names.

    Attributes:
        probabilities: of the classes, given that it is one of them; the highest is the answer.
        scores: of the classes, comparable between meshes; the highest says how known the mesh is.
    """

    probabilities: Float[np.ndarray, " C"]
    scores: Float[np.ndarray, " C"]


@dataclass(frozen=True)
class Found:
    """The parts of a classification that an evaluation keeps."""

    class_name: str
    answer: str
    known: float | None
    probability: float

    @classmethod
    def of(cls, answer: Classification, threshold: float) -> "Found":
        """Take them out; ``threshold`` is that of ``known``."""
        return cls(
            answer.class_name, answer.answer_at(threshold), answer.known, answer.probabilities[answer.class_name]
        )


@dataclass(frozen=True, eq=False)
class JudgedDataset:
    """All meshes that could be read.

    Attributes:
        class_names: of the classifier.
        judged: a row a mesh.
        skipped: meshes without a usable surface.
    """

    class_names: tuple[str, ...]
    judged: tuple[Judged, ...]
    skipped: tuple[Skipped, ...]


def judge_dataset(
    items: Sequence[LabelledFile],
    classifier: Classifier,
    bases: Mapping[str, Sequence[CompiledModel]] | None,
    *,
    baselines: Mapping[str, Classifier] | None = None,
    fitted: Mapping[str, CompiledModel] | None = None,
    views: int = DEFAULT_VIEWS,
    seed: int = 0,
    threshold: float = KNOWN_THRESHOLD,
    jobs: int = 1,
    progress: Progress = NULL_PROGRESS,
) -> JudgedDataset:
    """Classify every mesh, once for all figures.

    Args:
        items: the meshes; classes that the classifier does not know count as :data:`OTHER`.
        classifier: what is measured.
        bases: models whose base instances stand for each class, as the paper compares; ``None`` compares with none.
        baselines: other classifiers of the same classes that look at pictures of their own.
        fitted: models by digest; each mesh is classified with fits, too.
        views: pictures of each mesh.
        seed: of the views.
        threshold: meshes whose ``known`` is below are answered with ``unknown``.
        jobs: meshes that are read at once.
        progress: told of every mesh; may cancel.

    Raises:
        EvaluationError: no mesh could be read, or a baseline knows other classes.
        RenderingError: no headless OpenGL.
    """
    names, others = classifier.class_names, dict(baselines or {})
    for name, other in others.items():
        if other.class_names != names:
            raise EvaluationError("a baseline knows other classes", where=name)
    base_descriptors = None
    if bases is not None:
        base_descriptors = [np.stack([_base_descriptor(model) for model in bases[name]]) for name in names]
    judged: list[Judged] = []
    skipped: list[Skipped] = []
    for number, (item, mesh) in enumerate(load_each(items, jobs=jobs)):
        progress.report(number / len(items), f"meshes: {number} of {len(items)}")
        if isinstance(mesh, Skipped):
            skipped.append(mesh)
            continue
        try:
            judged.append(_judge(item, mesh, classifier, base_descriptors, others, fitted, views, seed, threshold))
        except MeshError as error:
            skipped.append(Skipped(item.file, error.message))
    if not judged:
        raise EvaluationError("there is no mesh to classify", where=skipped[0].file if skipped else None)
    return JudgedDataset(names, tuple(judged), tuple(skipped))


def _judge(
    item: LabelledFile,
    mesh: TriangleMesh,
    classifier: Classifier,
    bases: Sequence[Float[np.ndarray, "K D"]] | None,
    others: Mapping[str, Classifier],
    fitted: Mapping[str, CompiledModel] | None,
    views: int,
    seed: int,
    threshold: float,
) -> Judged:
    names = classifier.class_names
    started_s = time.perf_counter()
    found = classifier.classify(mesh, views=views, rng=np.random.default_rng(seed))
    seconds = time.perf_counter() - started_s
    base_distances = None
    if bases is not None:
        descriptor = found.descriptor or panorama_descriptor(mesh.vertices, mesh.faces)
        base_distances = np.array([panorama_distances(descriptor, base).min() for base in bases])

    def row(values: Mapping[str, float]) -> Float[np.ndarray, " C"]:
        return np.array([values[name] for name in names])

    by_fits = fitted_seconds = None
    if fitted is not None:
        started_s = time.perf_counter()
        with_fits = classifier.classify(mesh, views=views, rng=np.random.default_rng(seed), models=fitted)
        fitted_seconds = time.perf_counter() - started_s
        by_fits = Said(row(with_fits.probabilities), row(with_fits.scores))
    said = {
        name: other.classify(mesh, views=views, rng=np.random.default_rng(seed)).picture_probabilities
        for name, other in others.items()
    }
    return Judged(
        item=item,
        label=item.class_name if item.class_name in names else OTHER,
        found=Found.of(found, threshold),
        by_all=Said(row(found.probabilities), row(found.scores)),
        by_pictures=Said(row(found.picture_probabilities), row(found.picture_scores)),
        by_fits=by_fits,
        distances=None if found.distances is None else row(found.distances),
        base_distances=base_distances,
        baselines={name: row(probabilities) for name, probabilities in said.items()},
        seconds=seconds,
        fitted_seconds=fitted_seconds,
    )


def _base_descriptor(model: CompiledModel) -> Float[np.ndarray, " D"]:
    mesh = model.instance(model.base_values())
    descriptor: PanoramaDescriptor = panorama_descriptor(mesh.vertices, mesh.faces)
    return descriptor.to_array()
