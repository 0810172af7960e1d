"""`shapewright classify`: what are these meshes?"""

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from cli.evaluation_options import Jobs, threads
from cli.sources import find_meshes
from shapewright.errors import MeshError, MeshFileError

READERS = 4
"""Files that are read at once at most; more than that one classifier cannot keep busy."""


def classify(
    sources: Annotated[
        list[Path],
        typer.Argument(metavar="FOLDER|MESH...", help="Mesh files, or folders with some.", show_default=False),
    ],
    classifier: Annotated[
        Path, typer.Option("--classifier", "-c", help="The .onnx file of `shapewright train`.", show_default=False)
    ],
    views: Annotated[int, typer.Option(min=1, max=1000, help="Pictures taken of each mesh.")] = 10,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random views.")] = 0,
    jobs: Jobs = None,
    as_json: AsJson = False,
) -> None:
    """Tell the class of one or more meshes, with probabilities, or that it is unknown.

    Geometry counts beside the pictures where the exemplars that `shapewright train` wrote lie beside the classifier.
    Of several meshes those that cannot be used are listed with the reason.

    Examples:

      [bold]shapewright classify query.off -c classifier.onnx[/]
      [bold]shapewright classify my-meshes more/*.obj -c classifier.onnx --json[/]
    """
    import numpy as np

    from shapewright.classification import load_classifier
    from shapewright.mesh_file import load_meshes

    files = find_meshes(sources)
    network = load_classifier(classifier)
    results: list[dict[str, Any]] = []
    skipped: dict[str, MeshFileError] = {}
    started_s = time.monotonic()
    with threads(jobs) as used, shown_progress("classifying") as progress:
        for number, (file, mesh) in enumerate(zip(files, load_meshes(files, jobs=min(used, READERS)), strict=True)):
            progress.report(number / len(files), file.name)
            mesh_started_s = time.monotonic()
            try:
                if isinstance(mesh, MeshFileError):
                    raise mesh
                found = network.classify(mesh, views=views, rng=np.random.default_rng(seed))
            except MeshError as error:
                skipped[str(file)] = MeshFileError(error.message, where=error.where)  # without what the frames hold
                continue
            results.append(
                {
                    "file": str(file),
                    "answer": found.answer,
                    "class_name": found.class_name,
                    "known": found.known,
                    "probabilities": _listed(found.probabilities, "probability"),
                    "picture_probabilities": _listed(found.picture_probabilities, "probability"),
                    "distances": None if found.distances is None else _listed(found.distances, "distance"),
                    "seconds": round(time.monotonic() - mesh_started_s, 3),
                }
            )
    if not results:
        raise next(iter(skipped.values()))
    if as_json:
        print_json(
            {
                "classifier": str(classifier),
                "views": views,
                "results": results,
                "skipped_count": len(skipped),
                "skipped": [{"file": file, "reason": _reason(file, error)} for file, error in skipped.items()],
                "seconds": round(time.monotonic() - started_s, 3),
            }
        )
        return
    _print(results, skipped)


def _print(results: list[dict[str, Any]], skipped: dict[str, MeshFileError]) -> None:
    from rich.markup import escape
    from rich.table import Column, Table

    table = Table(Column("file", overflow="fold"), "answer", "known", "class", "probability", "next")
    for result in results:
        first, *others = result["probabilities"]
        following = f"{others[0]['class_name']} {others[0]['probability']:.1%}" if others else ""
        known = "" if result["known"] is None else f"{result['known']:.1%}"
        probability = f"{first['probability']:.1%}"
        table.add_row(escape(result["file"]), result["answer"], known, first["class_name"], probability, following)
    stdout().print(table)
    for file, error in skipped.items():
        typer.echo(f"skipped {file}: {_reason(file, error)}", err=True)


def _reason(file: str, error: MeshFileError) -> str:
    place = (error.where or "").removeprefix(ascii(file)).lstrip(": ")
    return f"{place}: {error.message}" if place else error.message


def _listed(values: dict[str, float], what: str) -> list[dict[str, Any]]:
    return [{"class_name": name, what: value} for name, value in values.items()]
