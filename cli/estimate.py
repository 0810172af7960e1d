"""`shapewright estimate`: which parameter values rebuild this mesh?"""

import os
import time
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from cli.estimation_text import print_estimation
from cli.sources import load_class, load_compiled, read_object
from shapewright.errors import EstimationError, MeshFileError
from shapewright.progress import LimitedProgress

if TYPE_CHECKING:
    from shapewright.estimation import Estimation
    from shapewright.estimation.query import Axis, Unit
    from shapewright.mesh import TriangleMesh

UNITS = ("mm", "cm", "m", "in")
AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
ESTIMATORS = ("fast", "reference")


def estimate(
    mesh: Annotated[
        Path,
        typer.Argument(help="Mesh file (.off, .obj, .ply, .stl, .glb), or a folder of them.", show_default=False),
    ],
    models: Annotated[
        list[str] | None,
        typer.Option(
            "--model",
            "-m",
            help="Name of a shipped model, or a JSON file. Repeatable: the one that fits best is found.",
            show_default=False,
        ),
    ] = None,
    class_name: Annotated[
        str | None, typer.Option("--class", help="Try every shipped model of this class.", show_default=False)
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Write the fitted mesh (.glb, .obj, .off, .ply, .stl), or a folder's table (.parquet, .csv, .jsonl).",
        ),
    ] = None,
    picture: Annotated[
        Path | None, typer.Option(help="Write a PNG: the query, the fitted mesh, and both in one.")
    ] = None,
    residuals: Annotated[
        list[Path] | None,
        typer.Option(
            "--residuals",
            metavar="FILE",
            help="Write how far query and fit are apart as colors: a scene (.glb) or a picture (.png). Repeatable.",
            show_default=False,
        ),
    ] = None,
    quick: Annotated[
        bool,
        typer.Option("--quick", help="Coarser settings of the reference: about a fifth of its time."),
    ] = False,
    samples: Annotated[
        int | None,
        typer.Option(
            min=1, help="Random instances that the reference starts from (default: 10000).", show_default=False
        ),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Seed of all random choices (default: 0).", show_default=False)
    ] = None,
    units: Annotated[
        str | None,
        typer.Option(
            help=f"Unit of the file's coordinates ({', '.join(UNITS)}): the scale is known, and lengths come in it.",
            show_default=False,
        ),
    ] = None,
    up: Annotated[
        str | None,
        typer.Option(help=f"The axis of the file that points up: {', '.join(AXES)}.", show_default=False),
    ] = None,
    estimator: Annotated[
        str | None,
        typer.Option(
            help="Who searches: fast (the default, seconds), or reference (the paper step by step, minutes).",
            show_default=False,
        ),
    ] = None,
    time_limit_s: Annotated[
        float | None,
        typer.Option(
            "--time-limit",
            min=0.0,
            metavar="SECONDS",
            help="Stop after so many seconds, of a folder for each mesh, with the best answer until then.",
            show_default=False,
        ),
    ] = None,
    settings_file: Annotated[
        Path | None, typer.Option("--settings", help='JSON file with any of the settings, e.g. {"image_size": 128}.')
    ] = None,
    sort: Annotated[
        str | None,
        typer.Option(
            metavar="COLUMN[/COLUMN]",
            help="Folder: sort the rows by a parameter or a ratio, e.g. stem_length/bowl_depth.",
            show_default=False,
        ),
    ] = None,
    descending: Annotated[bool, typer.Option("--descending", help="Folder: the largest first.")] = False,
    strip: Annotated[
        Path | None,
        typer.Option(help="Folder: write a PNG of the sorted meshes above their fits.", show_default=False),
    ] = None,
    jobs: Annotated[
        int | None,
        typer.Option(
            min=1, max=256, help="Folder: processes (default: as many as there are cores).", show_default=False
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Estimate the parameters of a procedural model, or of the best one of a class, so that it rebuilds a mesh.

    The fitted mesh is written in the coordinates of your file, so that both lie on top of each other. It takes seconds
    for a model or a class; --time-limit makes sure. Beside each value stands what the mesh says about it: where it
    lies with a probability of 90 %, and whether it is determined at all. Say the unit of your file if you know it:
    without it the size of the mesh says nothing, only proportions do.

    A folder gives a table with one row for each mesh below it; a mesh that cannot be estimated is a row with the
    reason. Running the command again estimates only what has no row yet.

    Examples:

      [bold]shapewright estimate goblet.ply --model glass_with_stem[/]
      [bold]shapewright estimate goblet.ply --class glass_with_stem --units mm --up +z[/]
      [bold]shapewright estimate goblet.ply -m glass_with_stem -o fitted.glb --picture fit.png --residuals off.png[/]
      [bold]shapewright estimate goblet.ply -m glass_with_stem --estimator reference --quick[/]
      [bold]shapewright estimate DIR --class glass_with_stem -o glasses.parquet[/]
      [bold]shapewright estimate DIR --class glass_with_stem -o t.csv --sort stem_length/bowl_depth --strip s.png[/]
    """
    if not mesh.is_dir():
        _refuse_endings(output, picture, residuals or [])
    if (class_name is None) == (not models):
        raise typer.BadParameter("name models or a class", param_hint="--model")
    from shapewright.estimation import EstimationCancelled, EstimationSettings, Query
    from shapewright.estimation import estimate as run_estimation
    from shapewright.mesh.file import load_mesh

    read = {} if settings_file is None else read_object(settings_file)
    if (estimator or read.get("estimator")) != "reference":
        _refuse_settings_of_the_reference({"--quick": quick, "--samples": samples is not None})
    chosen = (EstimationSettings.quick().to_dict() if quick else {}) | read
    given = {"samples": samples, "seed": seed, "estimator": estimator}
    chosen |= {name: value for name, value in given.items() if value is not None}
    settings = EstimationSettings.from_dict(chosen)
    _one_of(units, UNITS, "--units")
    _one_of(up, AXES, "--up")
    generators = load_class(class_name) if class_name is not None else [load_compiled(model) for model in models or []]
    unit, axis = cast("Unit | None", units), cast("Axis | None", up)
    if mesh.is_dir():
        from cli.estimate_folder import FolderRequest, estimate_folder

        if output is None or picture is not None or residuals:
            message = "a folder needs a table to write, and has neither --picture nor --residuals"
            raise typer.BadParameter(message, param_hint="--output")
        limits = (time_limit_s, jobs or len(os.sched_getaffinity(0)))
        request = FolderRequest(mesh, generators, settings, unit, axis, output, sort, descending, strip, *limits)
        estimate_folder(request, as_json=as_json)
        return
    if sort is not None or strip is not None:
        raise typer.BadParameter("are for a folder of meshes", param_hint="--sort, --strip")
    mesh_read = load_mesh(mesh, in_child=True)
    query = Query(mesh_read, units=unit, up=axis)
    started_s = time.monotonic()
    with shown_progress("estimating") as shown:
        progress = LimitedProgress(
            shown, lambda: time_limit_s is not None and time.monotonic() - started_s >= time_limit_s
        )
        try:
            estimation = run_estimation(query, generators, settings, progress=progress)
        except EstimationCancelled as cancelled:
            if cancelled.best is None:
                raise EstimationError("the time was over before anything was found", where="--time-limit") from None
            estimation = cancelled.best
    seconds = time.monotonic() - started_s
    written = [path for path in (output, picture, *(residuals or [])) if path is not None]
    for path in written:
        path.parent.mkdir(parents=True, exist_ok=True)
    if output is not None:
        estimation.mesh.save(output)
    if picture is not None:
        from cli.picture import save_side_by_side

        save_side_by_side(mesh_read, estimation.mesh, picture, model_to_query=estimation.pose.rotation)
    for path in residuals or []:
        _write_residuals(mesh_read, estimation, path)
    document = estimation.to_dict()
    if as_json:
        files = {
            "mesh_file": output and str(output),
            "picture_file": picture and str(picture),
            "residual_files": [str(path) for path in residuals or []],
        }
        print_json({"query": str(mesh), **document, **files, "seconds": round(seconds, 3)})
        return
    print_estimation(stdout(), document, seconds=seconds)
    for path in written:
        typer.echo(f"written: {path}")


def _refuse_settings_of_the_reference(given: dict[str, bool]) -> None:
    for option, is_given in given.items():
        if is_given:
            message = "only the reference estimator has it (--estimator reference); the fast one takes seconds"
            raise typer.BadParameter(message, param_hint=option)


def _write_residuals(query: "TriangleMesh", estimation: "Estimation", path: Path) -> None:
    from cli.picture import save_picture, upright_view
    from shapewright.estimation.residual_views import ResidualViews
    from shapewright.whole_file import write_whole

    views = ResidualViews.of(query, estimation.mesh)
    if path.suffix.lower() == ".glb":
        write_whole(path, views.glb())
    else:
        save_picture(views.picture(rotation=upright_view(estimation.pose.rotation)), path)


def _refuse_endings(output: Path | None, picture: Path | None, residuals: list[Path]) -> None:
    if output is not None and output.suffix.lower() not in (".glb", ".obj", ".off", ".ply", ".stl"):
        raise MeshFileError("write one of .glb, .obj, .off, .ply, .stl", where=str(output))
    if picture is not None and picture.suffix.lower() != ".png":
        raise EstimationError("pictures are written as .png", where=str(picture))
    for path in residuals:
        if path.suffix.lower() not in (".glb", ".png"):
            raise EstimationError("residuals are written as .glb or .png", where=str(path))


def _one_of(value: str | None, known: Iterable[str], option: str) -> None:
    if value is not None and value not in known:
        raise typer.BadParameter(f"expected one of {', '.join(known)}, got {value!r}", param_hint=option)
