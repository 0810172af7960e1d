"""Estimations of many queries, in this process or in several, for all figures at once."""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.errors import MeshError
from shapewright.estimation import Distances, Estimation, EstimationSettings, ParameterEstimate, Query, Stage, estimate
from shapewright.estimation.result import Alternative, Layer, Ratio
from shapewright.evaluation.datasets import Skipped
from shapewright.evaluation.synthetic import Truth
from shapewright.in_processes import in_processes
from shapewright.modeling import CompiledModel, ProceduralModel, compile_model
from shapewright.progress import NULL_PROGRESS, Progress

EstimateQuery = Callable[[Query, Sequence[CompiledModel], EstimationSettings], Estimation]
"""Estimates one query; picklable, as other processes call it, too."""


@dataclass(frozen=True, eq=False)
class Case:
    """A query to estimate.

    Attributes:
        name: of its file, or of the synthetic query.
        class_name: its true class.
        query: the mesh and what is known of it.
        models: names of the models that are tried.
        truth: what it was made of; ``None`` for a real mesh.
    """

    name: str
    class_name: str
    query: Query
    models: tuple[str, ...]
    truth: Truth | None = None


@dataclass(frozen=True, eq=False)
class Answer:
    """What an evaluation keeps of an estimation; meshes are left out, as they can be generated again."""

    model: str
    layer: Layer
    values: Float[np.ndarray, " P"]
    parameters: tuple[ParameterEstimate, ...]
    pose: Pose
    distances: Distances
    stages: tuple[Stage, ...]
    ratios: tuple[Ratio, ...]
    other_poses: tuple[Pose, ...]
    """Alternatives that are other poses of the same model."""
    seconds: float
    processor_seconds: float

    @classmethod
    def of(cls, estimation: Estimation, seconds: float, processor_seconds: float) -> "Answer":
        """Take out what figures need."""
        return cls(
            model=estimation.model.name,
            layer=estimation.layer,
            values=estimation.values,
            parameters=estimation.parameters,
            pose=estimation.pose,
            distances=estimation.distances,
            stages=estimation.stages,
            ratios=estimation.ratios,
            other_poses=tuple(_poses(estimation.alternatives, estimation.model.name)),
            seconds=seconds,
            processor_seconds=processor_seconds,
        )


def _poses(alternatives: Iterable[Alternative], model: str) -> Iterator[Pose]:
    return (one.pose for one in alternatives if one.kind == "pose" and one.model.name == model)


@dataclass(frozen=True, eq=False)
class Estimated:
    """A case and what was estimated; the mesh of its query is not kept."""

    name: str
    class_name: str
    truth: Truth | None
    answer: Answer


@dataclass(frozen=True)
class EstimatedQueries:
    """All queries that could be estimated, in the order of the cases, and those that could not."""

    estimated: tuple[Estimated, ...]
    skipped: tuple[Skipped, ...]


def estimate_cases(
    cases: Iterable[Case | Skipped],
    count: int,
    models: Mapping[str, CompiledModel],
    settings: EstimationSettings,
    *,
    estimate_query: EstimateQuery | None = None,
    jobs: int = 1,
    progress: Progress = NULL_PROGRESS,
) -> EstimatedQueries:
    """Estimate every case; one whose mesh is refused is skipped with its reason.

    Args:
        cases: may be an iterator that reads or draws; at most two for each job wait at once.
        count: how many cases there are, for the progress.
        models: by name; those that the cases name.
        settings: of the estimator.
        estimate_query: what estimates; the library's estimators if not given.
        jobs: processes; with 1 the work is done here. Each has its own compiled models.
        progress: told of every case; may cancel.
    """
    estimate_query = estimate if estimate_query is None else estimate_query
    outcomes: dict[int, Estimated | Skipped] = {}
    kept: dict[int, tuple[str, str, Truth | None]] = {}

    def report() -> None:
        progress.report(len(outcomes) / max(count, 1), f"queries: {len(outcomes)} of {count}")

    def numbered() -> Iterator[tuple[int, Case]]:
        for number, case in enumerate(cases):
            if isinstance(case, Skipped):
                outcomes[number] = case
            else:
                kept[number] = (case.name, case.class_name, case.truth)
                yield number, case

    report()
    answers: Iterator[tuple[int, Answer | str]]
    if jobs == 1:
        answers = ((number, _answer(case, models, settings, estimate_query)) for number, case in numbered())
    else:
        sources = {name: compiled.model for name, compiled in models.items()}
        tasks = ((number, replace(case, truth=None)) for number, case in numbered())
        answers = in_processes(
            tasks,
            _answer_in_child,
            jobs=jobs,
            begin=partial(_begin_child, sources, settings, estimate_query),
            beat=report,
        )
    for number, answer in answers:
        name, class_name, truth = kept.pop(number)
        if isinstance(answer, str):
            outcomes[number] = Skipped(name, answer)
        else:
            outcomes[number] = Estimated(name, class_name, truth, answer)
        report()
    ordered = [outcomes[number] for number in sorted(outcomes)]
    return EstimatedQueries(
        tuple(one for one in ordered if isinstance(one, Estimated)),
        tuple(one for one in ordered if isinstance(one, Skipped)),
    )


def _answer(
    case: Case, models: Mapping[str, CompiledModel], settings: EstimationSettings, estimate_query: EstimateQuery
) -> Answer | str:
    """Estimate one case; a mesh that is refused gives the reason."""
    tried = [models[name] for name in case.models]
    began, processor_began = time.perf_counter(), time.process_time()
    try:
        estimation = estimate_query(case.query, tried, settings)
    except MeshError as error:
        return error.message
    return Answer.of(estimation, time.perf_counter() - began, time.process_time() - processor_began)


@dataclass(frozen=True)
class _Child:
    """What a child process works with."""

    models: "_Compiled"
    settings: EstimationSettings
    estimate_query: EstimateQuery


class _Compiled(dict[str, CompiledModel]):
    """Models by name, compiled when they are needed first."""

    def __init__(self, sources: Mapping[str, ProceduralModel]) -> None:
        super().__init__()
        self._sources = sources

    def __missing__(self, name: str) -> CompiledModel:
        self[name] = compile_model(self._sources[name])
        return self[name]


_child: _Child | None = None


def _begin_child(
    sources: Mapping[str, ProceduralModel], settings: EstimationSettings, estimate_query: EstimateQuery
) -> None:
    global _child
    _child = _Child(_Compiled(sources), settings, estimate_query)


def _answer_in_child(case: Case) -> Answer | str:
    assert _child is not None
    return _answer(case, _child.models, _child.settings, _child.estimate_query)
