"""`shapewright estimate DIR`: one table row for each mesh below a folder, in several processes, resumable."""

import multiprocessing
import signal
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from cli.child_process import die_with_parent
from cli.console import print_json, shown_progress
from cli.finished_rows import FinishedRows
from cli.table_files import check_ending, save_table
from shapewright.errors import Cancelled
from shapewright.progress import CallbackProgress, LimitedProgress, Progress

if TYPE_CHECKING:
    from multiprocessing.synchronize import Event

    from shapewright.estimation import EstimationSettings
    from shapewright.estimation.query import Axis, Unit
    from shapewright.estimation.table.rows import TableRow
    from shapewright.estimation.table.sorting import SortKey
    from shapewright.modeling import CompiledModel


@dataclass(frozen=True)
class FolderRequest:
    """What the command line asks for.

    Attributes:
        folder: that holds the meshes.
        models: that are tried for each.
        settings: of every estimation.
        units: unit of the files' coordinates.
        up: the axis of the files that points up.
        output: the table to write.
        sort: what its rows are sorted by; the names of the files if not given.
        descending: whether the largest comes first.
        strip: picture of the sorted meshes to write.
        time_limit_s: seconds after which an estimation ends with its best until then.
        jobs: processes.
    """

    folder: Path
    models: "Sequence[CompiledModel]"
    settings: "EstimationSettings"
    units: "Unit | None"
    up: "Axis | None"
    output: Path
    sort: str | None
    descending: bool
    strip: Path | None
    time_limit_s: float | None
    jobs: int

    def sort_key(self) -> "SortKey | None":
        """Return what the rows are sorted by.

        Raises:
            EstimationError: no column of numbers.
        """
        from shapewright.estimation.table.sorting import SortKey

        if self.sort is None:
            return None
        key = SortKey.parse(self.sort)
        models = [compiled.model for compiled in self.models]
        key.check(parameter.name for model in models for parameter in model.parameters if not parameter.options)
        return key


def estimate_folder(request: FolderRequest, *, as_json: bool) -> None:
    """Estimate what has no row yet, and write the table and the strip.

    Raises:
        Cancelled: Ctrl-C; what is done is in the table.
        EstimationError: nothing to sort by, or an ending that is none of a table.
        MeshFileError: no mesh below the folder.
    """
    from cli.sources import find_meshes
    from shapewright.estimation.table.rows import cells_of
    from shapewright.estimation.table.sorting import sort_by
    from shapewright.estimation.table.table import Table

    started_s = time.monotonic()
    check_ending(request.output)
    key = request.sort_key()
    files = {path.relative_to(request.folder).as_posix(): path for path in find_meshes([request.folder])}
    request.output.parent.mkdir(parents=True, exist_ok=True)
    run = _Run(request, files)
    stopped = run.work()
    rows = [run.rows[name] for name in files if name in run.rows]
    if key is not None:
        rows = sort_by(key, rows, [cells_of(row) for row in rows], descending=request.descending)
    ratio = [key.columns] if key is not None and key.denominator is not None else []
    save_table(Table.of(rows, [(pair[0], pair[-1]) for pair in ratio]), request.output)
    if stopped:
        state = f"{len(rows)} of {len(files)} meshes are in {request.output}"
        raise Cancelled(f"stopped; {state}; the same command goes on from there")
    if request.strip is not None:
        from cli.picture_strip import save_strip

        save_strip(rows, files, request.models, key, request.strip)
    _tell(request, rows, run, time.monotonic() - started_s, as_json=as_json)


@dataclass
class _Run:
    """Estimating the files of a folder; rows of an earlier run are taken over."""

    request: FolderRequest
    files: Mapping[str, Path]
    rows: "dict[str, TableRow]" = field(default_factory=dict)
    reused: int = 0
    seconds: float = 0.0

    def work(self) -> bool:
        """Fill the rows; returns whether Ctrl-C stopped it before all were there."""
        from shapewright.estimation.many import Work, estimate_files

        request = self.request
        path = request.output.with_name(f"{request.output.name}.rows.jsonl")
        finished = FinishedRows(path, _conditions(request))
        keys = {name: finished.key_of(file) for name, file in self.files.items()}
        known = {name: finished.get(key, name) for name, key in keys.items()}
        self.rows = {name: row for name, row in known.items() if row is not None}
        self.reused = len(self.rows)
        left = {name: file for name, file in self.files.items() if name not in self.rows}
        stop = multiprocessing.get_context("spawn").Event()
        models = [compiled.model for compiled in request.models]
        work = Work(
            models, request.settings, request.units, request.up, partial(_stoppable, stop, request.time_limit_s)
        )
        jobs = min(request.jobs, len(left))
        began_s = time.monotonic()
        try:
            with shown_progress("estimating") as progress, _stopping(stop):

                def beat() -> None:
                    if stop.is_set():
                        raise Cancelled
                    done = len(self.rows) - self.reused
                    message = f"{len(self.rows)} of {len(self.files)} meshes"
                    progress.report(len(self.rows) / len(self.files), message + _eta(began_s, done, len(left) - done))

                for outcome in estimate_files(left, work, jobs=jobs, begin=_begin_child, beat=beat) if left else ():
                    if stop.is_set():
                        break
                    self.rows[outcome.row.file] = outcome.row
                    finished.add(keys[outcome.row.file], outcome)
                    beat()
        except Cancelled:
            return True
        finally:
            self.seconds = time.monotonic() - began_s
        return len(self.rows) < len(self.files)


def _conditions(request: FolderRequest) -> dict[str, Any]:
    return {
        "version": version("shapewright"),
        "models": [compiled.model.digest for compiled in request.models],
        "settings": request.settings.to_dict(),
        "units": request.units,
        "up": request.up,
        "time_limit_s": request.time_limit_s,
    }


def _begin_child() -> None:
    """Leave Ctrl-C to the parent, which tells through the event; and do not outlive it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()


def _stoppable(stop: "Event", time_limit_s: float | None) -> Progress:
    def look(fraction: float, message: str) -> None:
        if stop.is_set():
            raise Cancelled

    progress = CallbackProgress(look)
    started_s = time.monotonic()
    return LimitedProgress(progress, lambda: time_limit_s is not None and time.monotonic() - started_s >= time_limit_s)


@contextmanager
def _stopping(stop: "Event") -> Iterator[None]:
    """Let the first Ctrl-C end the work in an orderly way; a second one breaks off."""

    def note(*_: object) -> None:
        stop.set()
        signal.signal(signal.SIGINT, before)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _eta(began_s: float, done: int, left: int) -> str:
    """Say how long the rest takes at the pace until now."""
    if not done or not left:
        return ""
    seconds = (time.monotonic() - began_s) / done * left
    return f", {seconds:.0f} s left" if seconds < 90 else f", {seconds / 60:.0f} min left"


def _tell(request: FolderRequest, rows: "Sequence[TableRow]", run: _Run, seconds: float, *, as_json: bool) -> None:
    errors = [row for row in rows if row.answer is None]
    layers = [row.answer["layer"] for row in rows if row.answer is not None]
    done = len(rows) - run.reused
    document = {
        "folder": str(request.folder),
        "table": str(request.output),
        "strip": request.strip and str(request.strip),
        "meshes": len(rows),
        "estimated": len(layers),
        "reused": run.reused,
        "errors": [{"file": row.file, "error": row.error} for row in errors],
        "layers": {str(layer): layers.count(layer) for layer in (1, 2, 3)},
        "sort": request.sort,
        "meshes_per_minute": round(60.0 * done / run.seconds, 2) if done else None,
        "seconds": round(seconds, 3),
    }
    if as_json:
        print_json(document)
        return
    for row in errors:
        print(f"{row.file}: {row.error}", file=sys.stderr)
    reused = f", {run.reused} of them by an earlier run" if run.reused else ""
    typer.echo(f"{len(layers)} of {len(rows)} meshes estimated{reused} · {seconds:.1f} s")
    for path in (request.output, request.strip):
        if path is not None:
            typer.echo(f"written: {path}")
