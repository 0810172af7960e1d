"""`shapewright evaluate estimation`: an estimator on labelled meshes, or on synthetic queries of known values."""

import time
from collections.abc import Mapping
from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from cli.estimation_queries import Queries, dataset_queries, synthetic_queries
from cli.evaluation_options import Classes, Jobs, Limit, ReportFile, Seed, names_in, threads
from cli.sources import read_object
from shapewright.errors import EvaluationError
from shapewright.progress import PartialProgress, Progress
from shapewright.whole_file import write_whole

if TYPE_CHECKING:
    from shapewright.estimation import EstimationSettings
    from shapewright.evaluation.estimated import Estimated, EstimatedQueries
    from shapewright.evaluation.estimation_cases import Damage

_REPORT_SHARE = 0.05


class Scale(StrEnum):
    """Whether synthetic queries say their unit."""

    known = "known"
    free = "free"


class CorruptionName(StrEnum):
    """What can be done to the meshes: every corruption that leaves faces."""

    noise = "noise"
    holes = "holes"
    decimated = "decimated"
    half = "half"
    flipped = "flipped"
    clustered = "clustered"
    outliers = "outliers"
    dust = "dust"
    ground = "ground"
    stitched = "stitched"
    closed = "closed"
    voxels = "voxels"
    uneven = "uneven"


class EstimatorChoice(StrEnum):
    """What can be measured."""

    reference = "reference"
    fast = "fast"
    both = "both"


def estimation(
    dataset: Annotated[
        Path | None, typer.Option(help="Folder with labels.csv (columns file, class).", show_default=False)
    ] = None,
    synthetic: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="N", help="Take N random instances of the shipped models instead.", show_default=False
        ),
    ] = None,
    scale: Annotated[Scale, typer.Option(help="Synthetic: whether a query says its unit.")] = Scale.free,
    model_known: Annotated[
        bool, typer.Option("--model-known/--class-known", help="Synthetic: try the true model, or all of its class.")
    ] = False,
    corruption: Annotated[
        CorruptionName | None, typer.Option(help="Corrupt every mesh first.", show_default=False)
    ] = None,
    strength: Annotated[
        float | None, typer.Option(help="Of the corruption (default: its own middle one).", show_default=False)
    ] = None,
    estimator: Annotated[
        EstimatorChoice | None, typer.Option(help="Which one (default: that of the settings).", show_default=False)
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Coarser settings, as in `shapewright estimate`.")] = False,
    settings_file: Annotated[
        Path | None, typer.Option("--settings", help="JSON file with any of the settings.", show_default=False)
    ] = None,
    report: ReportFile = None,
    limit: Limit = None,
    classes: Classes = None,
    seed: Seed = 0,
    jobs: Jobs = None,
    as_json: AsJson = False,
) -> None:
    """Tell how well estimations rebuild the meshes of a dataset, or recover the values of synthetic queries.

    Each mesh is estimated with all shipped models of its class. Synthetic queries are random instances of all shipped
    models, or of those of --classes, in turn: in any orientation, at any scale and place, with a surface that is cut
    into other triangles.

    What a strength means, and three that are usual, the mildest first:

      noise: standard deviation of the noise along each axis, as a share of the diagonal (0.002, 0.005, 0.01)
      holes: share of the area that is missing (0.1, 0.2, 0.4)
      decimated: share of the faces that are kept (0.3, 0.1, 0.03)
      half: pixels along each side of the depth picture that is all there is (256, 128, 64)
      flipped: share of the faces that are turned over (0.25, 0.5, 1)
      clustered: cells along the longest side of the grid that vertices are rounded to (48, 24, 16)
      outliers: small triangles that float about the object (50, 150, 500)
      dust: distance of the farthest of a few small clumps, as a share of the diagonal (0.1, 0.4, 1)
      ground: side of the square sheet below the object, in longest sides of the bounding box (1, 1.5, 2)
      stitched: shift of each of six one-sided scans, as a share of the diagonal (0.005, 0.015, 0.03)
      closed: voxels along the longest side of the grid on which the surface is closed (96, 64, 40)
      voxels: voxels along the longest side of the bounding box (64, 40, 24)
      uneven: factor by which vertices are denser on a third of the surface (2, 4, 16)

    Examples:

      [bold]shapewright evaluate estimation --dataset DIR --report estimated.html[/]
      [bold]shapewright evaluate estimation --synthetic 100 --scale known --json[/]
      [bold]shapewright evaluate estimation --synthetic 50 --corruption holes --strength 0.4 --classes table[/]
    """
    from shapewright.evaluation.estimation_figures import against, estimation_figures
    from shapewright.evaluation.recovery_figures import recoveries, recovery_figures

    started_s = time.monotonic()
    if (dataset is None) == (synthetic is None):
        raise typer.BadParameter("name a dataset or a number of synthetic queries", param_hint="--dataset")
    if synthetic is None and (model_known or scale is Scale.known):
        raise typer.BadParameter("is for synthetic queries only", param_hint="--model-known, --scale")
    if report is not None and report.is_dir():
        raise EvaluationError("a file is needed, this is a folder", where=f"--report {report}")
    several = _settings(settings_file, quick, estimator, seed)
    damage = _damage(corruption, strength, seed)
    with threads(jobs) as used, shown_progress("estimating") as progress:
        if dataset is not None:
            queries = dataset_queries(dataset, limit, names_in(classes), damage, used)
        else:
            count = min(synthetic or 0, limit or synthetic or 0)
            queries = synthetic_queries(count, names_in(classes), damage, seed, scale is Scale.known, model_known)
        done = _estimated(queries, several, used, PartialProgress(progress, 0.0, 1.0 - _REPORT_SHARE))
        figures = {}
        for name, found in done.items():
            figures[name] = estimation_figures(found.estimated)
            if synthetic is not None:
                recovered = recoveries(found.estimated)
                figures[name] |= recovery_figures(found.estimated, recovered, model_known=model_known)
        _write_report(report, done, figures, queries, several, PartialProgress(progress, 1.0 - _REPORT_SHARE, 1.0))
    first = next(iter(done))
    document = {
        "dataset": None if dataset is None else str(dataset),
        "synthetic": synthetic,
        "scale": None if synthetic is None else scale.value,
        "model_known": model_known,
        "corruption": None if damage is None else {"name": damage.corruption.name, "strength": damage.strength},
        "seed": seed,
        "estimator": first,
        **figures[first],
        "meshes": [_row(one) for one in done[first].estimated],
        "skipped_count": len(done[first].skipped),
        "skipped": [asdict(skipped) for skipped in done[first].skipped],
        "report": None if report is None else str(report),
        "seconds": round(time.monotonic() - started_s, 3),
    }
    if len(done) > 1:
        document["estimators"] = figures
        document["against_reference"] = against(done["fast"].estimated, done["reference"].estimated)
    if as_json:
        print_json(document)
        return
    for name in done:
        _print(name, figures[name])
    for skipped in done[first].skipped:
        typer.echo(f"skipped {skipped.file}: {skipped.reason}", err=True)
    if report is not None:
        typer.echo(str(report))


def _settings(
    file: Path | None, quick: bool, estimator: EstimatorChoice | None, seed: int
) -> "dict[str, EstimationSettings]":
    """Return the settings of each estimator that is measured, the one whose figures stand first in front."""
    from shapewright.estimation import EstimationSettings

    document = EstimationSettings.quick().to_dict() if quick else {}
    document |= {} if file is None else read_object(file)
    document["seed"] = seed
    if estimator is None:
        settings = EstimationSettings.from_dict(document)
        return {settings.estimator: settings}
    names = ("fast", "reference") if estimator is EstimatorChoice.both else (estimator.value,)
    return {name: EstimationSettings.from_dict({**document, "estimator": name}) for name in names}


def _damage(corruption: CorruptionName | None, strength: float | None, seed: int) -> "Damage | None":
    from shapewright.evaluation.corruptions import CORRUPTIONS
    from shapewright.evaluation.estimation_cases import Damage

    if corruption is None:
        if strength is not None:
            raise typer.BadParameter("is for corrupted meshes only; name a corruption", param_hint="--strength")
        return None
    chosen = CORRUPTIONS[corruption.value]
    return Damage(chosen, chosen.checked(strength), seed)


def _estimated(
    queries: Queries, several: "Mapping[str, EstimationSettings]", jobs: int, progress: Progress
) -> "dict[str, EstimatedQueries]":
    from shapewright.evaluation.estimated import estimate_cases

    done = {}
    for number, (name, settings) in enumerate(several.items()):
        part = PartialProgress(progress, number / len(several), (number + 1) / len(several))
        cases = queries.cases
        done[name] = estimate_cases(cases(), len(cases), queries.models, settings, jobs=jobs, progress=part)
        if not done[name].estimated:
            skipped = done[name].skipped
            reason = f" ({skipped[0].file}: {skipped[0].reason})" if skipped else ""
            raise EvaluationError(f"there is no mesh to estimate{reason}")
    return done


def _row(one: "Estimated") -> dict[str, Any]:
    answer = one.answer
    return {
        "file": one.name,
        "class": one.class_name,
        "model": answer.model,
        "layer": answer.layer,
        "zbuffer": answer.distances.zbuffer,
        "surface": answer.distances.surface,
        "seconds": round(answer.seconds, 4),
        "processor_seconds": round(answer.processor_seconds, 4),
    }


def _write_report(
    report: Path | None,
    done: "Mapping[str, EstimatedQueries]",
    figures: Mapping[str, Mapping[str, Any]],
    queries: Queries,
    several: "Mapping[str, EstimationSettings]",
    progress: Progress,
) -> None:
    if report is None:
        return
    from shapewright.evaluation.estimation_report import estimation_report

    settings = next(iter(several.values()))
    page = estimation_report(
        done,
        figures,
        queries.cases,
        queries.models,
        title=queries.title,
        thresholds={"surface": settings.surface_threshold, "zbuffer": settings.zbuffer_threshold},
        skipped=next(iter(done.values())).skipped,
        progress=progress,
    )
    report.parent.mkdir(parents=True, exist_ok=True)
    write_whole(report, page.encode())


_SHARES = {
    "within_5_percent": "parameters within 5 % of their range",
    "within_5_percent_determined": "those that are called determined",
    "within_5_percent_ratios": "ratios of lengths within 5 %",
    "determined_share": "called determined",
    "options_right": "options right",
    "model_right": "model right",
    "pose_right": "pose right",
    "interval_coverage": "90 % intervals that hold the value",
}


def _print(estimator: str, figures: Mapping[str, Any]) -> None:
    from rich.table import Table

    columns = "class", "n", "layer 3", "layer 1", "z-buffer", "surface", "seconds", "processor s"
    table = Table(*columns, box=None, pad_edge=False)
    for name, row in figures["per_class"].items():
        third, first = (f"{row['layer_share'][layer]:.0%}" for layer in "31")
        distances = f"{row['zbuffer_median']:.3f}", f"{row['surface_median']:.4f}"
        seconds = f"{row['seconds_median']:.1f}", f"{row['processor_seconds_median']:.1f}"
        table.add_row(name, str(row["n"]), third, first, *distances, *seconds)
    stdout().print(table)
    layers = ", ".join(f"layer {layer} {share:.1%}" for layer, share in sorted(figures["layer_share"].items())[::-1])
    typer.echo(
        f"{estimator}: {figures['n']} queries; {layers}; z-buffer distance {figures['zbuffer_median']:.3f} (median)"
    )
    for name, words in _SHARES.items():
        if figures.get(name) is not None:
            typer.echo(f"{words}: {figures[name]:.1%}")
