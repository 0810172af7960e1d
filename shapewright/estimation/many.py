"""Estimations of many meshes in several processes; whatever is wrong with one of them is its row."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from shapewright.errors import Cancelled, ShapewrightError
from shapewright.estimation.estimating import estimate
from shapewright.estimation.query import Axis, Query, Unit
from shapewright.estimation.result import EstimationCancelled
from shapewright.estimation.settings import EstimationSettings
from shapewright.estimation.table.rows import TableRow, answer_of
from shapewright.in_processes import in_processes
from shapewright.mesh import TriangleMesh
from shapewright.mesh.file import load_meshes
from shapewright.modeling import CompiledModel, ProceduralModel, compile_model
from shapewright.progress import NullProgress, Progress


@dataclass(frozen=True)
class Work:
    """What is done to every mesh; picklable.

    Attributes:
        models: that are tried.
        settings: of the estimation.
        units: unit of the files' coordinates, as in :class:`Query`.
        up: the axis of the files that points up.
        progress: makes the progress of one estimation, which may cancel it: the best until then is its answer.
    """

    models: Sequence[ProceduralModel]
    settings: EstimationSettings
    units: Unit | None = None
    up: Axis | None = None
    progress: Callable[[], Progress] = NullProgress


@dataclass(frozen=True)
class Outcome:
    """The row of a mesh.

    Attributes:
        row: what was estimated, or why nothing was.
        lasting: whether another try would come to the same.
    """

    row: TableRow
    lasting: bool = True


def _nothing() -> None:
    """Do nothing."""


def estimate_files(
    files: Mapping[str, Path],
    work: Work,
    *,
    jobs: int,
    begin: Callable[[], None] = _nothing,
    beat: Callable[[], None] = _nothing,
) -> Iterator[Outcome]:
    """Estimate each file; yields the rows as they are finished, in any order.

    Files are read in child processes with limits. A process that dies with a mesh, for want of memory, say, costs the
    row of that mesh and nothing else.

    Args:
        files: paths by the names that the rows have.
        work: what is done to each.
        jobs: processes, each with one thread; 1 works here, with all threads.
        begin: called in each process first; picklable.
        beat: called here again and again; what it raises ends the work.
    """
    if jobs == 1:
        yield from _here(files, work, beat)
        return
    begin_child = partial(_begin_child, work, begin)
    left = dict(files)
    begun: set[str] = set()

    def tasks(names: Sequence[str], broken: list[Outcome]) -> Iterator[tuple[int, tuple[str, TriangleMesh]]]:
        for number, read in enumerate(load_meshes([left[name] for name in names], jobs=jobs)):
            if isinstance(read, TriangleMesh):
                begun.add(names[number])
                yield number, (names[number], read)
            else:
                broken.append(_broken(names[number], read))

    def attempt(names: Sequence[str], processes: int) -> Iterator[Outcome]:
        broken: list[Outcome] = []
        found = in_processes(tasks(names, broken), _in_child, jobs=processes, begin=begin_child, beat=beat)
        for _, outcome in found:
            yield outcome
            yield from broken
            broken.clear()
        yield from broken

    def finished(outcomes: Iterator[Outcome]) -> Iterator[Outcome]:
        for outcome in outcomes:
            left.pop(outcome.row.file, None)
            begun.discard(outcome.row.file)
            yield outcome

    while left:
        try:
            yield from finished(attempt(list(left), jobs))
        except BrokenProcessPool:
            suspects = [name for name in left if name in begun]
            if not suspects:
                raise
            for name in suspects:  # one at a time: those that were only beside the culprit are estimated
                try:
                    yield from finished(attempt([name], 1))
                except BrokenProcessPool:
                    left.pop(name)
                    yield Outcome(TableRow(name, error="the process that estimated it died"), lasting=False)
            begun.clear()


def _here(files: Mapping[str, Path], work: Work, beat: Callable[[], None]) -> Iterator[Outcome]:
    compiled = [compile_model(model) for model in work.models]
    for name, read in zip(files, load_meshes(list(files.values())), strict=True):
        beat()
        yield _estimated(name, read, compiled, work) if isinstance(read, TriangleMesh) else _broken(name, read)


def _estimated(name: str, mesh: TriangleMesh, compiled: Sequence[CompiledModel], work: Work) -> Outcome:
    began_s = time.perf_counter()
    try:
        estimation = estimate(
            Query(mesh, units=work.units, up=work.up), compiled, work.settings, progress=work.progress()
        )
    except EstimationCancelled as cancelled:
        if cancelled.best is None:
            return Outcome(TableRow(name, error="the time was up before anything was found"), lasting=False)
        estimation = cancelled.best
    except Cancelled:
        return Outcome(TableRow(name, error="cancelled"), lasting=False)
    except ShapewrightError as error:
        return _broken(name, error)
    except Exception as error:  # whatever it is, the other meshes are estimated
        return Outcome(TableRow(name, error=f"unexpected {type(error).__name__}: {error}"), lasting=False)
    return Outcome(TableRow(name, answer_of(estimation), seconds=time.perf_counter() - began_s))


def _broken(name: str, error: ShapewrightError) -> Outcome:
    """Say why a mesh was refused; without its path, which is the name already."""
    return Outcome(TableRow(name, error=error.message))


_child: tuple[list[CompiledModel], Work] | None = None


def _begin_child(work: Work, begin: Callable[[], None]) -> None:
    global _child
    begin()
    _child = [compile_model(model) for model in work.models], work


def _in_child(task: tuple[str, TriangleMesh]) -> Outcome:
    assert _child is not None
    compiled, work = _child
    return _estimated(*task, compiled, work)
