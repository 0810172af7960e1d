"""`shapewright evaluate robustness`: a classifier on meshes that were corrupted."""

import time
from collections.abc import Mapping, Sequence
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from cli.evaluate_classifier import SettingsFile, Train, Views, shipped_classes_of
from cli.evaluation_options import (
    CacheFolder,
    Classes,
    ClassifierFile,
    DatasetFolder,
    Jobs,
    Limit,
    ReportFile,
    Seed,
    chosen_meshes,
    names_in,
    threads,
)
from cli.learning import kept_classifier_file
from cli.sources import chosen_classifier, load_negatives, read_object
from shapewright.errors import EvaluationError
from shapewright.progress import PartialProgress, Progress
from shapewright.whole_file import write_whole

if TYPE_CHECKING:
    from shapewright.evaluation.conditions import Condition
    from shapewright.evaluation.datasets import LabelledFile
    from shapewright.evaluation.robustness import MeshVerdicts, Robustness
    from shapewright.evaluation.robustness_figures import RobustnessFigures

_TRAINING_SHARE, _REPORT_SHARE = 0.1, 0.05


class Strengths(StrEnum):
    """Which of the three strengths of each corruption are measured."""

    middle = "middle"
    all = "all"


def robustness(
    dataset: DatasetFolder,
    classifier: ClassifierFile = None,
    corruptions: Annotated[
        str | None, typer.Option(metavar="A,B", help="Measure these corruptions only.", show_default=False)
    ] = None,
    strengths: Annotated[
        Strengths, typer.Option(help="Measure the middle strength of each, or all three.")
    ] = Strengths.all,
    report: ReportFile = None,
    limit: Limit = None,
    classes: Classes = None,
    views: Views = 10,
    train: Train = False,
    settings_file: SettingsFile = None,
    seed: Seed = 0,
    jobs: Jobs = None,
    cache: CacheFolder = None,
    as_json: AsJson = False,
) -> None:
    """Measure how well a classifier does on meshes that are corrupted as by scanning, sharing and converting.

    Each mesh is classified as it is, and under every corruption at three strengths. Measured are the share of meshes
    that get their class, with all evidence and by the pictures alone, the share accepted as known, the share of other
    meshes refused, and AUROC. The mean error is the mean of 1 - accuracy over all corruptions and strengths, as in
    ModelNet40-C; it is not divided by the error of a reference classifier.

    The corruptions are noise, holes, decimated, half (a one-sided scan), flipped, clustered, outliers, dust, ground,
    stitched, closed, voxels, uneven and points. What is done to a mesh depends on --seed, the corruption, its strength
    and the name of the file only. With --train a classifier is trained, with --seed, on the shipped models of the
    dataset's classes.

    Examples:

      [bold]shapewright evaluate robustness --dataset DIR --report robustness.html[/]
      [bold]shapewright evaluate robustness --dataset DIR -c classifier.onnx --strengths middle --limit 100[/]
      [bold]shapewright evaluate robustness --dataset DIR --corruptions noise,half,points --json[/]
    """
    from shapewright.classification import load_classifier
    from shapewright.evaluation.conditions import conditions_of
    from shapewright.evaluation.datasets import read_dataset
    from shapewright.evaluation.robustness import measure_robustness
    from shapewright.evaluation.robustness_figures import RobustnessFigures

    started_s = time.monotonic()
    if report is not None and report.is_dir():
        raise EvaluationError("a file is needed, this is a folder", where=f"--report {report}")
    conditions = conditions_of(_corruptions(corruptions), middle_only=strengths is Strengths.middle)
    items = read_dataset(dataset)
    chosen = chosen_meshes(items, classes, limit)
    with threads(jobs) as used, shown_progress("robustness") as progress:
        first = 0.0
        if classifier is None and (train or settings_file is not None):
            first = _TRAINING_SHARE
            chosen_file = _trained(items, settings_file, seed, PartialProgress(progress, 0.0, first), cache)
        else:
            chosen_file = chosen_classifier(classifier)
        measured = measure_robustness(
            chosen,
            partial(load_classifier, chosen_file, threads=1),
            conditions,
            views=views,
            seed=seed,
            jobs=used,
            progress=PartialProgress(progress, first, 1.0 - _REPORT_SHARE),
        )
        figures = RobustnessFigures.of(measured)
        _write_report(report, measured, figures, dataset, seed, PartialProgress(progress, 1.0 - _REPORT_SHARE, 1.0))
    if as_json:
        document = {
            "dataset": str(dataset),
            "classifier": _described(chosen_file),
            "class_names": list(measured.class_names),
            "strengths": strengths.value,
            "views": views,
            "seed": seed,
            **figures.to_dict(),
            "meshes": [_row(mesh) for mesh in measured.meshes],
            "skipped_count": len(measured.skipped),
            "skipped": [
                {"file": run.file, **_condition(run.condition), "reason": run.reason} for run in measured.skipped
            ],
            "report": None if report is None else str(report),
            "seconds": round(time.monotonic() - started_s, 3),
        }
        print_json(document)
        return
    _print(figures)
    _say_skipped(measured)
    if report is not None:
        typer.echo(str(report))


def _corruptions(text: str | None) -> list[str]:
    """Return the names of ``--corruptions a,b``, each once, or of all."""
    from shapewright.evaluation.corruptions import CORRUPTIONS

    names = names_in(text)
    if names is None:
        return list(CORRUPTIONS)
    known = ", ".join(CORRUPTIONS)
    for name in names:
        if name not in CORRUPTIONS:
            raise EvaluationError(f"unknown corruption {name!r}; expected any of: {known}", where="--corruptions")
    if not names:
        raise EvaluationError(f"expected the name of a corruption: {known}", where="--corruptions")
    return list(dict.fromkeys(names))


def _trained(
    items: "Sequence[LabelledFile]", settings_file: Path | None, seed: int, progress: Progress, cache: Path | None
) -> Path:
    """Return the file of a classifier of the dataset's classes, trained now or by an earlier run."""
    from shapewright.training import TrainingSettings

    settings = TrainingSettings.from_dict(
        ({} if settings_file is None else read_object(settings_file)) | {"seed": seed}
    )
    classes = shipped_classes_of({item.class_name for item in items})
    return kept_classifier_file(classes, load_negatives(classes), settings, progress, cache)


def _described(classifier: Path) -> dict[str, Any]:
    from shapewright.classification import exemplars_file, files_digest

    beside = exemplars_file(classifier)
    return {
        "file": str(classifier),
        "digest": files_digest(classifier.read_bytes(), beside if beside.is_file() else None),
    }


def _condition(condition: "Condition | None") -> dict[str, Any]:
    """Return what a skipped mesh was skipped under; nothing if it was skipped altogether."""
    if condition is None:
        return {"corruption": None, "strength": None}
    return {"corruption": condition.name, "strength": condition.strength}


def _row(mesh: "MeshVerdicts") -> dict[str, Any]:
    wrong: dict[str, list[float]] = {}
    for condition, verdict in mesh.corrupted.items():
        if not verdict.is_right:
            wrong.setdefault(condition.name, []).append(condition.strength)
    clean = mesh.clean
    return {
        "file": mesh.item.file,
        "class": mesh.item.class_name,
        "class_name": clean.class_name,
        "known": clean.known,
        "wrong_under": None if clean.is_other else wrong,
    }


def _write_report(
    report: Path | None,
    measured: "Robustness",
    figures: "RobustnessFigures",
    dataset: Path,
    seed: int,
    progress: Progress,
) -> None:
    if report is None:
        return
    from shapewright.evaluation.robustness_report import robustness_report

    page = robustness_report(measured, figures, title=dataset.resolve().name, seed=seed, progress=progress)
    report.parent.mkdir(parents=True, exist_ok=True)
    write_whole(report, page.encode())


def _print(figures: "RobustnessFigures") -> None:
    from rich.table import Table

    from shapewright.evaluation.robustness_figures import mean_figures

    by_corruption = figures.by_corruption
    count = max(len(row) for row in by_corruption.values())
    strengths = ["right"] if count == 1 else ["mild", "middle", "strong"]
    table = Table("corruption", *strengths, "pictures", "AUROC", "accepted", "refused", box=None, pad_edge=False)
    for column in table.columns[1:]:
        column.justify = "right"

    def add(name: str, accuracies: Sequence[float | None], means: Mapping[str, float | None]) -> None:
        auroc = means["auroc_known"]
        others = [means["accuracy_pictures"], means["accepted_known"], means["refused_other"]]
        pictures, accepted, refused = (_percent(value) for value in others)
        shown = [*(_percent(value) for value in accuracies), *[""] * (count - len(accuracies))]
        table.add_row(name, *shown, pictures, "-" if auroc is None else f"{auroc:.3f}", accepted, refused)

    add("(clean)", [figures.clean.accuracy], figures.clean.to_dict())
    for name, row in by_corruption.items():
        add(name, [one.accuracy for one in row.values()], mean_figures(row.values()))
    stdout().print(table)
    if count > 1:
        typer.echo("mild, middle, strong: right class; other columns: means over the strengths")
    typer.echo(f"{figures.clean.n} meshes of the classes, {figures.clean.n_other} others")
    means = f"accuracy {_percent(figures.mean['accuracy'])}, error {_percent(figures.mean_error)}"
    typer.echo(f"mean over all corruptions and strengths: {means}")


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{share:.1%}"


def _say_skipped(measured: "Robustness") -> None:
    for run in measured.skipped:
        under = "" if run.condition is None else f" under {run.condition.name} {run.condition.strength:g}"
        typer.echo(f"skipped {run.file}{under}: {run.reason}", err=True)
