"""`shapewright evaluate`: how well models, classifier and estimator do on labelled meshes."""

import time
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, flowing, print_json, shown_progress, stdout
from cli.evaluate_classifier import classification, retrieval
from cli.evaluate_estimation import estimation
from cli.evaluate_robustness import robustness
from cli.evaluation_options import (
    CacheFolder,
    Classes,
    DatasetFolder,
    Jobs,
    Limit,
    ReportFile,
    Seed,
    cache_folder,
    names_in,
    threads,
)
from cli.sources import load_all_compiled
from models_store.library.shipped import list_classes
from shapewright.errors import EvaluationError
from shapewright.progress import PartialProgress
from shapewright.whole_file import write_whole

if TYPE_CHECKING:
    from shapewright.evaluation.coverage import Coverage
    from shapewright.evaluation.metrics import ClassCoverage

app = typer.Typer(rich_markup_mode="rich", no_args_is_help=True)


@app.callback(
    help=flowing(
        """Measure how well the parts do on a folder of labelled meshes.

        A dataset is a folder with `labels.csv`; its columns `file` and `class` are read. Every evaluation takes
        --json, --report, --limit, --classes, --seed and --jobs, and names the meshes that it had to skip.

        Examples:

          [bold]shapewright evaluate classification --dataset DIR[/]                the classifier that ships
          [bold]shapewright evaluate retrieval --dataset DIR -c mine.onnx[/]        a classifier of yours
          [bold]shapewright evaluate estimation --dataset DIR --report fits.html[/]   queries and fits side by side
          [bold]shapewright evaluate robustness --dataset DIR --limit 50[/]         corrupted meshes
          [bold]shapewright evaluate coverage --dataset DIR --report cover.html[/]  with pictures
        """
    )
)
def evaluate() -> None:
    """Group the evaluations."""


def coverage(
    dataset: DatasetFolder,
    report: ReportFile = None,
    limit: Limit = None,
    classes: Classes = None,
    against: Annotated[
        str | None,
        typer.Option(
            metavar="A,B",
            help="Compare with these classes and the own one (default: every class of the dataset that ships).",
            show_default=False,
        ),
    ] = None,
    samples: Annotated[int, typer.Option(min=1, help="Variations of each class, shared by its models.")] = 10_000,
    worst: Annotated[int, typer.Option(min=0, help="Meshes of each class in the report, worst first.")] = 6,
    seed: Seed = 0,
    jobs: Jobs = None,
    cache: CacheFolder = None,
    as_json: AsJson = False,
) -> None:
    """Tell whether each real mesh has a random variation of its class nearby, and a nearer one than other classes have.

    Distances are panorama distances (0 to 2). A class is the set of its models. What was computed for a model or a
    mesh is kept: after a change of one model only that model is done again.

    Examples:

      [bold]shapewright evaluate coverage --dataset DIR --classes sword --report sword.html[/]
      [bold]shapewright evaluate coverage --dataset DIR --samples 2000 --limit 50 --json[/]
    """
    from shapewright.evaluation.coverage import measure_coverage
    from shapewright.evaluation.datasets import of_classes, read_dataset, spread
    from shapewright.evaluation.descriptor_cache import DescriptorCache
    from shapewright.evaluation.metrics import coverage_of_classes

    started_s = time.monotonic()
    if report is not None and report.is_dir():
        raise EvaluationError("a file is needed, this is a folder", where=f"--report {report}")
    items = read_dataset(dataset)
    labels = {item.class_name for item in items}
    queried, compared = _chosen_classes(labels, names_in(classes), names_in(against))
    models = {name: load_all_compiled(members) for name, members in compared.items()}
    chosen = spread(of_classes(items, queried), limit)
    with threads(jobs) as used, shown_progress("coverage") as progress:
        measured = measure_coverage(
            chosen,
            models,
            DescriptorCache(cache_folder(cache, "coverage")),
            samples=samples,
            seed=seed,
            jobs=used,
            progress=PartialProgress(progress, 0.0, 0.95),
        )
        summed = coverage_of_classes(measured)
        if report is not None:
            from shapewright.evaluation.report import coverage_report

            last = PartialProgress(progress, 0.95, 1.0)
            page = coverage_report(
                measured, summed, title=dataset.resolve().name, worst=worst, jobs=used, progress=last
            )
            report.parent.mkdir(parents=True, exist_ok=True)
            write_whole(report, page.encode())
    if as_json:
        document = {
            "dataset": str(dataset),
            "samples": samples,
            "seed": seed,
            **_document(measured, summed),
            "other_classes_count": len(items) - len(of_classes(items, queried)),
            "report": None if report is None else str(report),
            "seconds": round(time.monotonic() - started_s, 3),
        }
        print_json(document)
        return
    _print(measured, summed)
    if report is not None:
        typer.echo(str(report))


for verb in (classification, retrieval, estimation, robustness, coverage):
    app.command(verb.__name__, help=flowing(verb.__doc__))(verb)


def _chosen_classes(
    labels: set[str], classes: list[str] | None, against: list[str] | None
) -> tuple[list[str], dict[str, list[str]]]:
    """Return the classes whose meshes are taken, and the shipped models of each class that is compared."""
    by_class = list_classes()
    for option, chosen in (("--classes", classes), ("--against", against)):
        for name in chosen or []:
            if name not in by_class:
                raise EvaluationError(
                    f"no model of class {name!r} ships (of these: {', '.join(by_class)})", where=option
                )
    queried = [name for name in by_class if name in labels and (classes is None or name in classes)]
    if not queried and classes is not None:
        named = ", ".join(classes) or "nothing is named"
        raise EvaluationError(f"no mesh of the dataset has one of these classes: {named}", where="--classes")
    if not queried:
        raise EvaluationError("no mesh of the dataset has the class of a shipped model", where="--dataset")
    rivals = [name for name in by_class if name in (labels if against is None else against)]
    return queried, {name: by_class[name] for name in by_class if name in queried or name in rivals}


def _document(measured: "Coverage", summed: "dict[str, ClassCoverage]") -> dict[str, Any]:
    return {
        "n": len(measured.queries),
        "per_class": {name: figures.to_dict() for name, figures in summed.items()},
        "matrix": {name: figures.medians for name, figures in summed.items()},
        "meshes": _meshes(measured),
        "skipped_count": len(measured.skipped),
        "skipped": [asdict(skipped) for skipped in measured.skipped],
    }


def _meshes(measured: "Coverage") -> list[dict[str, Any]]:
    from shapewright.evaluation.metrics import nearest_class

    rows = []
    for query, neighbours in zip(measured.queries, measured.neighbours, strict=True):
        own = query.item.class_name
        rival = nearest_class(dict(neighbours), but=own) if len(neighbours) > 1 else None
        rows.append(
            {
                "file": query.item.file,
                "class": own,
                "own_distance": neighbours[own].distance,
                "own_model": neighbours[own].model,
                "nearest_other_class": rival,
                "nearest_other_distance": None if rival is None else neighbours[rival].distance,
            }
        )
    return rows


def _print(measured: "Coverage", summed: "dict[str, ClassCoverage]") -> None:
    from rich.table import Table

    table = Table("class", "n", "own", "mean", "worst", "other class", "median", "own first", box=None, pad_edge=False)
    for index, column in enumerate(table.columns):
        column.no_wrap = True
        column.justify = "left" if index in (0, 5) else "right"
    for name, figures in summed.items():
        other = figures.nearest_other_median
        table.add_row(
            name,
            str(figures.n),
            f"{figures.own_median:.4f}",
            f"{figures.own_mean:.4f}",
            f"{figures.own_maximum:.4f}",
            figures.nearest_other_class or "",
            "" if other is None else f"{other:.4f}",
            f"{figures.share_nearest:.0%}" + ("" if figures.own_is_nearest else " !"),
        )
    stdout().print(table)
    behind = [name for name, figures in summed.items() if not figures.own_is_nearest]
    if behind:
        stdout().print(f"Another class is nearer (!): {', '.join(behind)}.")
    for skipped in measured.skipped:
        typer.echo(f"skipped {skipped.file}: {skipped.reason}", err=True)
    if measured.skipped:
        count = len(measured.skipped)
        typer.echo("1 mesh was skipped" if count == 1 else f"{count} meshes were skipped", err=True)
