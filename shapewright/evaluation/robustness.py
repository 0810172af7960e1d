"""A classifier on the meshes of a dataset, each clean and under every condition, in this process or in several."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from shapewright.classification.classifier import DEFAULT_VIEWS
from shapewright.classification.evidence import OTHER
from shapewright.errors import EvaluationError, MeshError
from shapewright.evaluation.conditions import Condition
from shapewright.evaluation.datasets import LabelledFile, Skipped, load_each
from shapewright.evaluation.verdict import Verdict
from shapewright.in_processes import in_processes
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.retrieval.indexing import MeshClassifier

LoadClassifier = Callable[[], MeshClassifier]
"""Loads the classifier; picklable, as each process loads its own."""


@dataclass(frozen=True, eq=False)
class MeshVerdicts:
    """The answers about one mesh.

    Attributes:
        item: the mesh.
        clean: the answer about the mesh as it is.
        corrupted: the answers under the conditions; those that had to be skipped are missing.
    """

    item: LabelledFile
    clean: Verdict
    corrupted: Mapping[Condition, Verdict]


@dataclass(frozen=True)
class SkippedRun:
    """A mesh that was left out, and why: under one condition, or, without a condition, altogether."""

    file: str
    condition: Condition | None
    reason: str


@dataclass(frozen=True, eq=False)
class Robustness:
    """The answers about all meshes of a dataset.

    Attributes:
        class_names: of the classifier.
        conditions: what was done to each mesh.
        meshes: in the order of the dataset; those that could not be classified even clean are missing.
        skipped: what was left out, in the same order.
    """

    class_names: tuple[str, ...]
    conditions: tuple[Condition, ...]
    meshes: tuple[MeshVerdicts, ...]
    skipped: tuple[SkippedRun, ...]

    def verdicts(self, condition: Condition | None) -> list[Verdict]:
        """Return the answers under one condition, or about the clean meshes."""
        if condition is None:
            return [mesh.clean for mesh in self.meshes]
        return [mesh.corrupted[condition] for mesh in self.meshes if condition in mesh.corrupted]

    def skipped_under(self, condition: Condition | None) -> list[SkippedRun]:
        """Return what was left out under one condition, or altogether."""
        return [run for run in self.skipped if run.condition == condition]


def measure_robustness(
    items: Sequence[LabelledFile],
    load_classifier: LoadClassifier,
    conditions: Sequence[Condition],
    *,
    views: int = DEFAULT_VIEWS,
    seed: int = 0,
    jobs: int = 1,
    progress: Progress = NULL_PROGRESS,
) -> Robustness:
    """Classify every mesh clean and under every condition.

    A mesh that a corruption or the classifier refuses is skipped under that condition, with the reason.

    Args:
        items: the meshes; classes that the classifier does not know count as :data:`OTHER`.
        load_classifier: loads what is measured.
        conditions: what is done to each mesh; see :meth:`Condition.corrupted`.
        views: pictures of each mesh.
        seed: of the corruptions and of the views.
        jobs: processes; with 1 the work is done here.
        progress: receives a report after every mesh; may cancel.

    Raises:
        ClassifierError: the classifier cannot be loaded.
        EvaluationError: no mesh could be classified clean.
        RenderingError: no headless OpenGL.
    """
    classifier = load_classifier()
    trial = _Trial(tuple(conditions), views, seed)
    outcomes: dict[int, _Answers | SkippedRun] = {}

    def report() -> None:
        progress.report(len(outcomes) / max(len(items), 1), f"meshes: {len(outcomes)} of {len(items)}")

    def numbered() -> Iterator[tuple[int, _Task]]:
        for number, (item, mesh) in enumerate(load_each(items, jobs=jobs)):
            if isinstance(mesh, Skipped):
                outcomes[number] = SkippedRun(item.file, None, mesh.reason)
            else:
                yield number, _Task(item.file, item.class_name, mesh)

    report()
    answered: Iterator[tuple[int, _Answers | SkippedRun]]
    if jobs == 1:
        answered = ((number, trial(task, classifier)) for number, task in numbered())
    else:
        begin = partial(_begin_child, load_classifier, trial)
        answered = in_processes(numbered(), _answer_in_child, jobs=jobs, begin=begin, beat=report)
    for number, outcome in answered:
        outcomes[number] = outcome
        report()
    meshes, skipped = [], []
    for number in sorted(outcomes):
        outcome = outcomes[number]
        if isinstance(outcome, SkippedRun):
            skipped.append(outcome)
        else:
            meshes.append(MeshVerdicts(items[number], outcome.clean, outcome.corrupted))
            skipped += outcome.skipped
    if not meshes:
        reason = f" ({skipped[0].file}: {skipped[0].reason})" if skipped else ""
        raise EvaluationError(f"no mesh could be classified{reason}")
    return Robustness(classifier.class_names, trial.conditions, tuple(meshes), tuple(skipped))


@dataclass(frozen=True, eq=False)
class _Task:
    """A mesh that was read."""

    file: str
    class_name: str
    mesh: TriangleMesh


@dataclass(frozen=True, eq=False)
class _Answers:
    """What is kept of one task."""

    clean: Verdict
    corrupted: dict[Condition, Verdict]
    skipped: list[SkippedRun]


@dataclass(frozen=True)
class _Trial:
    """What is done to every mesh."""

    conditions: tuple[Condition, ...]
    views: int
    seed: int

    def __call__(self, task: _Task, classifier: MeshClassifier) -> _Answers | SkippedRun:
        """Classify one mesh under all conditions, so that it is read and sent once."""
        label = task.class_name if task.class_name in classifier.class_names else OTHER

        def verdict(query: TriangleMesh | PointCloud) -> Verdict:
            rng = np.random.default_rng(self.seed)
            return Verdict.of(label, classifier.classify(query, views=self.views, rng=rng))

        try:
            clean = verdict(task.mesh)
        except MeshError as error:
            return SkippedRun(task.file, None, error.message)
        answers = _Answers(clean, {}, [])
        for condition in self.conditions:
            try:
                query = condition.corrupted(task.mesh, seed=self.seed, file=task.file)
                answers.corrupted[condition] = verdict(query)
            except MeshError as error:
                answers.skipped.append(SkippedRun(task.file, condition, error.message))
        return answers


_child: tuple[_Trial, MeshClassifier] | None = None


def _begin_child(load_classifier: LoadClassifier, trial: _Trial) -> None:
    global _child
    _child = trial, load_classifier()


def _answer_in_child(task: _Task) -> _Answers | SkippedRun:
    assert _child is not None
    trial, classifier = _child
    return trial(task, classifier)
