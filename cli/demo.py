"""`shapewright demo`: the whole path on one mesh, all of it through the REST service."""

import contextlib
import os
import shlex
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stderr, stdout
from cli.estimation_text import print_estimation
from cli.report import probability_table
from cli.sources import read_object
from shapewright.errors import ShapewrightError

if TYPE_CHECKING:
    from rich.console import Console

    from cli.client import Client

COMMAND = "shapewright"
SAMPLE = Path(__file__).resolve().parent.parent / "examples" / "goblet.ply"
READY_WITHIN_S = 300.0
SHOWN = ("layer", "verdict", "parameters", "ratios", "alternatives", "distances")
"""What the report keeps of an estimation."""


def demo(
    mesh: Annotated[
        Path | None,
        typer.Argument(help="File of a mesh or point cloud (default: examples/goblet.ply).", show_default=False),
    ] = None,
    once: Annotated[bool, typer.Option("--once", help="End when all is done; do not keep serving.")] = False,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port of the service; 0 takes a free one.")] = 0,
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the results.")] = Path("demo-output"),
    data_dir: Annotated[
        Path | None,
        typer.Option(
            help="Keep the service's folder here; a later demo or `shapewright serve` goes on with it "
            "(default: a temporary folder).",
            show_default=False,
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of all random choices.")] = 0,
    settings_file: Annotated[
        Path | None,
        typer.Option("--settings", help='JSON file with settings of the estimation: {"estimator": "reference"}.'),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Show the whole path on one mesh: upload, classify, estimate, learn, and look at it in the dashboard.

    Starts the service and a worker, uploads MESH, asks the ready classifier what it is, and the models of its class
    which parameters rebuild it. After the sample a class is added to the ready classifier, which takes under a minute.
    Everything goes through the REST service, as it would from another machine. A point cloud is classified only:
    rebuilding needs faces. Exit status 0 only if every step succeeded.

    Examples:

      [bold]bash scripts/demo[/]                       the sample, then the dashboard until Ctrl-C
      [bold]bash scripts/demo my-table.off --once[/]   a mesh of yours
    """
    for number in (signal.SIGINT, signal.SIGTERM):  # a shell that starts us in the background has SIGINT ignored
        signal.signal(number, signal.default_int_handler)
    console = stderr() if as_json else stdout()
    query = SAMPLE if mesh is None else mesh
    finished = False
    started_s = time.monotonic()
    try:
        with query.open("rb"):  # a missing file is noticed before anything is started
            pass
        estimating = {"seed": seed} | (read_object(settings_file) if settings_file else {})
        output.mkdir(parents=True, exist_ok=True)
        with contextlib.ExitStack() as stack:
            folder = data_dir or stack.enter_context(_temporary_folder())
            _step(console, 1, "start the service and a worker (SQLite, a folder, no other server)")
            from cli.client import connected
            from cli.local_service import local_service

            log = output / "service.log"
            service = stack.enter_context(local_service(folder, port=port, log=log))
            client = stack.enter_context(connected(service["url"], ready_within_s=READY_WITHIN_S))
            start_s = time.monotonic() - started_s
            console.print(f"   {service['url']}, worker {service['worker_pid']}, log {log} ({start_s:.1f} s)")
            report, page = _walk(client, console, query, output, seed, estimating)
            if mesh is None:
                _learn(client, console, report, output, seed)
            report["seconds"] |= {"start": start_s, "total": time.monotonic() - started_s}
            report["dashboard_url"] = service["dashboard_url"] + page
            finished = True
            if as_json:
                print_json(report)
            console.print(f"\nAll of it took {report['seconds']['total']:.0f} s.")
            if not once:
                console.print(f"Dashboard: [bold]{report['dashboard_url']}[/]", soft_wrap=True)
            _print_next(console, query, report)
            if not once:
                console.print("Ctrl-C ends the demo.")
                while True:
                    time.sleep(3600)
    except KeyboardInterrupt:
        if not finished:
            raise typer.Exit(130) from None
    except (ShapewrightError, OSError) as error:
        stderr().print(f"shapewright: the demo stopped: {error}", markup=False)
        raise typer.Exit(1) from None


@contextlib.contextmanager
def _temporary_folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="shapewright-demo-", ignore_cleanup_errors=True) as folder:
        yield Path(folder)


def _step(console: "Console", number: int, text: str) -> None:
    console.print(f"[bold cyan]{number}[/] [bold]{text}[/]")


def _walk(
    client: "Client", console: "Console", query: Path, output: Path, seed: int, estimating: dict[str, Any]
) -> tuple[dict[str, Any], str]:
    """Take the other steps; return what they found, and the page of the dashboard that shows it."""
    _step(console, 2, f"upload {_shown(query)} and classify it with the ready classifier")
    uploaded = client.upload("/v1/meshes", query)
    mesh_id, is_cloud = uploaded["id"], uploaded["kind"] == "point_cloud"
    faces = "" if is_cloud else f", {uploaded['face_count']} triangles"
    closed = "" if is_cloud else ", closed" if uploaded["watertight"] else ", not closed"
    console.print(f"   {uploaded['vertex_count']} {'points' if is_cloud else 'vertices'}{faces}{closed}")
    body = {"mesh_id": mesh_id, "seed": seed}
    classification = _run(client, "classifying", "/v1/classifications", body)
    found = classification["result"]
    _print_answer(console, found)
    report = {
        "query": str(query),
        "classifier_id": classification["classifier_id"],
        **{name: found[name] for name in ("class_name", "answer", "known", "probabilities")},
        "seconds": {"classification": found["seconds"]},
    }
    if is_cloud:
        console.print("   Rebuilding needs faces: a point cloud is classified only.")
        return report, f"#/meshes/{mesh_id}"

    _step(console, 3, f"estimate which parameters rebuild it, with the models of {found['class_name']}")
    body = {"mesh_id": mesh_id, "class_name": found["class_name"], "settings": estimating}
    estimation = _run(client, "estimating", "/v1/estimations", body)
    fit = estimation["result"]
    print_estimation(console, fit, seconds=fit["seconds"])

    _step(console, 4, "write a picture (mesh, fit, both in one) and the fitted mesh")
    picture, glb = _write_files(client, mesh_id, estimation, output, query.stem)
    console.print(f"   {picture}\n   {glb}", soft_wrap=True)
    report["seconds"]["estimation"] = fit["seconds"]
    report |= {"model": fit["model"]["name"], **{name: fit[name] for name in SHOWN}}
    report |= {"picture_file": str(picture), "mesh_file": str(glb)}
    return report, f"#/estimations/{estimation['id']}"


def _learn(client: "Client", console: "Console", report: dict[str, Any], output: Path, seed: int) -> None:
    """Take the last step, if there is something to learn; note in the report what came of it."""
    from cli.demo_learning import ADDED, add_class, can_add

    if not can_add(client, report["classifier_id"]):
        return
    _step(console, 5, f"learn: add the class {ADDED} to the ready classifier")
    report["learning"] = add_class(client, console, report["classifier_id"], output, seed)
    report["seconds"]["learning"] = report["learning"].pop("seconds")


def _print_answer(console: "Console", found: Any) -> None:
    """Print what the mesh is, and the probabilities of the classes."""
    if found["answer"] == found["class_name"]:
        console.print(f"   it is a [bold]{found['class_name']}[/] ({found['seconds']:.1f} s)")
    else:
        nearest = f"nearest is [bold]{found['class_name']}[/]"
        console.print(f"   it is [bold]{found['answer']}[/], {nearest} ({found['seconds']:.1f} s)")
    if found["known"] is not None:
        console.print(f"   it is of one of the classes with a probability of {found['known']:.1%}")
    console.print(probability_table(found["probabilities"]))


def _run(client: "Client", title: str, path: str, body: dict[str, Any]) -> Any:
    """Start long work, follow its job, return its result."""
    accepted = client.post(path, body)
    with shown_progress(f"   {title}") as progress:
        client.follow(accepted["job"], progress)
    return client.get(accepted["url"])


def _write_files(client: "Client", mesh_id: str, estimation: Any, output: Path, name: str) -> tuple[Path, Path]:
    """Fetch query and fitted mesh from the service, write the fitted one and the picture of both."""
    import numpy as np

    from cli.picture import save_side_by_side
    from shapewright.mesh.file import load_mesh

    glb, picture = output / f"{name}-fitted.glb", output / f"{name}.png"
    glb.write_bytes(client.get_bytes(f"/v1/estimations/{estimation['id']}/mesh"))
    with tempfile.TemporaryDirectory() as folder:
        query = Path(folder) / "query.glb"
        query.write_bytes(client.get_bytes(f"/v1/meshes/{mesh_id}/content"))
        rotation = np.array(estimation["result"]["pose"]["rotation"])
        save_side_by_side(load_mesh(query), load_mesh(glb), picture, model_to_query=rotation)
    return picture, glb


def _print_next(console: "Console", query: Path, report: dict[str, Any]) -> None:
    """Print the commands that do the same without the service, and this again for another mesh."""
    command, mesh = _command(), shlex.quote(_shown(query))
    lines = [f"{command} classify {mesh}"]
    if "model" in report:
        lines.append(f"{command} estimate {mesh} --class {report['class_name']} --picture fit.png")
    if "learning" in report:
        lines.append(f"{command} train {report['learning']['class_name']} --extend ready -o mine.onnx")
    lines.append(f"{command} demo YOUR-MESH")
    console.print("What to type next:")
    for line in lines:
        console.print(f"  {line}", markup=False, soft_wrap=True)


def _shown(path: Path) -> str:
    """Return a path as one would type it: relative if it lies below the working folder."""
    relative = os.path.relpath(path)
    return str(path) if relative.startswith("..") else relative


def _command() -> str:
    """Return how this command can be typed here: its name, or the way to it where no such name is in the path."""
    called = Path(sys.argv[0])
    return COMMAND if called.name != COMMAND or shutil.which(COMMAND) else _shown(called)
