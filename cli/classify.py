"""`shapewright classify`: what are these meshes?"""

import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from cli.evaluation_options import ClassifierFile, Jobs, Threshold, threads
from cli.picture import save_picture
from cli.sources import by_digest, chosen_classifier, classifier_line, classifier_name, find_meshes, load_class
from models_store.library.shipped import list_classes
from shapewright.errors import MeshError, MeshFileError

if TYPE_CHECKING:
    from shapewright.classification import Classification, Classifier
    from shapewright.modeling import CompiledModel

READERS = 4
"""Files that are read at once at most; more than that one classifier cannot keep busy."""


def classify(
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="FOLDER|MESH...", help="Files of meshes or point clouds, or folders with some.", show_default=False
        ),
    ],
    classifier: ClassifierFile = None,
    views: Annotated[
        int,
        typer.Option(min=1, max=1000, help="Pictures taken of each mesh; three times as many of a scan of one side."),
    ] = 10,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random views.")] = 0,
    fit: Annotated[
        bool,
        typer.Option("--fit", help="Also fit the shipped models of the likeliest classes; takes a second a mesh."),
    ] = False,
    threshold: Threshold = 0.5,
    pictures: Annotated[
        Path | None,
        typer.Option(
            help="Folder for PNGs: each mesh as the classifier saw it, and the nearest variation of each unknown one.",
            show_default=False,
        ),
    ] = None,
    jobs: Jobs = None,
    as_json: AsJson = False,
) -> None:
    """Tell the class of one or more meshes or point clouds, with probabilities, or that it is unknown.

    The classifier that ships knows ten classes; --classifier names one of `shapewright train`. Geometry counts beside
    the pictures where the exemplars that training wrote lie beside it. Of several meshes those that cannot be used are
    listed with the reason. A file without faces is a point cloud: PLY, OBJ, OFF, LAS, LAZ, PCD, XYZ, PTS; of a folder,
    not ASC, CSV and TXT, which have to be named.

    Examples:

      [bold]shapewright classify query.off[/]
      [bold]shapewright classify scan.pcd[/]
      [bold]shapewright classify my-meshes more/*.obj --json[/]
      [bold]shapewright classify query.off -c mine.onnx --fit --pictures seen[/]
      [bold]shapewright classify my-meshes --threshold 0.3[/]
    """
    import numpy as np

    from shapewright.mesh.file import load_queries

    files = find_meshes(sources, with_clouds=True)
    classifier_file = chosen_classifier(classifier)
    results: list[dict[str, Any]] = []
    skipped: dict[str, MeshFileError] = {}
    started_s = time.monotonic()
    with (
        threads(jobs) as used,
        shown_progress("classifying") as progress,
        ThreadPoolExecutor(1) as pool,
    ):
        loading = pool.submit(_loaded, classifier_file, fit=fit)  # while a child process reads the first mesh
        read = load_queries(files, jobs=min(used, READERS))
        for number, (file, query) in enumerate(zip(files, read, strict=True)):
            progress.report(number / len(files), file.name)
            network, models = loading.result()
            mesh_started_s = time.monotonic()
            try:
                if isinstance(query, MeshFileError):
                    raise query
                found = network.classify(query, views=views, rng=np.random.default_rng(seed), models=models)
            except MeshError as error:
                skipped[str(file)] = MeshFileError(error.message, where=error.where)  # without what the frames hold
                continue
            seconds = round(time.monotonic() - mesh_started_s, 3)
            picture = None
            if pictures is not None:
                picture = pictures / f"{number + 1:0{len(str(len(files)))}d}-{file.stem}.png"
                from shapewright.rendering import compose_grid

                pictures.mkdir(parents=True, exist_ok=True)
                save_picture(compose_grid(found.images), picture)
                if found.answer_at(threshold) != found.class_name:
                    _save_neighbor(network, found, picture.with_name(f"{picture.stem}-nearest.png"))
            results.append(
                {"file": str(file)}
                | found.to_dict()
                | {"answer": found.answer_at(threshold)}
                | {"seconds": seconds, "picture": None if picture is None else str(picture)}
            )
    if not results:
        raise next(iter(skipped.values()))
    if as_json:
        print_json(
            {
                "classifier": classifier_name(classifier),
                "views": views,
                "threshold": threshold,
                "class_names": list(network.class_names),
                "results": results,
                "skipped_count": len(skipped),
                "skipped": [{"file": file, "reason": _reason(file, error)} for file, error in skipped.items()],
                "seconds": round(time.monotonic() - started_s, 3),
            }
        )
        return
    _print(results, skipped)
    typer.echo(classifier_line(classifier))


def _save_neighbor(network: "Classifier", found: "Classification", file: Path) -> None:
    """Save a picture of the variation that is nearest to an unknown mesh, if its model ships."""
    neighbor = found.neighbor
    if neighbor is None or network.exemplars is None:
        return
    model = _shipped([neighbor.class_name]).get(neighbor.digest)
    if model is None:
        return
    from shapewright.rendering import render_mesh

    save_picture(render_mesh(model.instance(network.exemplars.values(neighbor.row, model))), file)


def _loaded(classifier: Path, *, fit: bool) -> "tuple[Classifier, dict[str, CompiledModel] | None]":
    """Load a classifier with the compiled kernels that it needs, and for fits the shipped models of its classes."""
    import numpy as np

    from shapewright.classification import load_classifier
    from shapewright.distances.panorama import panorama_descriptor

    network = load_classifier(classifier)
    if network.exemplars is not None:  # kernels are loaded when first called
        corner, faces = np.eye(4, 3), np.array([[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]])
        network.exemplars.distances(panorama_descriptor(corner, faces))
    return network, _shipped(network.class_names) if fit else None


def _shipped(class_names: Sequence[str]) -> "dict[str, CompiledModel]":
    """The shipped models of these classes by their digests; a class of others is compared with its exemplars."""
    return by_digest(load_class(name) for name in class_names if name in list_classes())


def _print(results: list[dict[str, Any]], skipped: dict[str, MeshFileError]) -> None:
    from rich.markup import escape
    from rich.table import Column, Table

    table = Table(
        Column("file", overflow="fold"),
        Column("answer", no_wrap=True),
        Column("known", no_wrap=True),
        Column("probability", no_wrap=True),
        Column("next", overflow="fold"),
    )
    for result in results:
        first, *others = result["probabilities"]
        following = f"{others[0]['class_name']} {others[0]['probability']:.1%}" if others else ""
        known = "" if result["known"] is None else f"{result['known']:.1%}"
        likeliest = f"{first['probability']:.1%}"
        if result["answer"] != first["class_name"]:
            likeliest = f"{first['class_name']} {likeliest}"
        table.add_row(escape(result["file"]), result["answer"], known, likeliest, following)
    stdout().print(table)
    for result in results:
        if result["answer"] != result["class_name"]:
            typer.echo(f"{result['file']}: {_why_unknown(result)}")
    for file, error in skipped.items():
        typer.echo(f"skipped {file}: {_reason(file, error)}", err=True)


def _why_unknown(result: dict[str, Any]) -> str:
    """Say why a mesh is called unknown."""
    pictured = {one["class_name"]: one["probability"] for one in result["picture_probabilities"]}
    likeliest = max(pictured, key=lambda name: pictured[name])
    said = [f"the pictures say {likeliest} with {pictured[likeliest]:.0%}"]
    if (neighbor := result["neighbor"]) is not None:
        usual = neighbor["usual_distance"]
        limit = "" if usual is None else f"; nine of ten of this class are nearer than {usual:.2f}"
        said.insert(0, f"nearest is a {neighbor['class_name']} at distance {neighbor['distance']:.2f}{limit}")
    return "; ".join(["unknown", *said])


def _reason(file: str, error: MeshFileError) -> str:
    place = (error.where or "").removeprefix(ascii(file)).lstrip(": ")
    return f"{place}: {error.message}" if place else error.message
