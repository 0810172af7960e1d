"""`shapewright demo`: the whole path on one mesh, all of it through the REST service."""

import contextlib
import signal
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
from models_store.library.shipped import list_classes, list_further_classes, list_shipped
from shapewright.errors import ModelError, ShapewrightError

if TYPE_CHECKING:
    from rich.console import Console

    from cli.client import Client

SAMPLE = Path(__file__).resolve().parent.parent / "examples" / "goblet.ply"
READY_WITHIN_S = 300.0
VIEWS = 30
"""More than usual: the few pictures that the demo trains with leave single views unsure."""
SHOWN = ("layer", "verdict", "parameters", "ratios", "alternatives", "distances")
"""What the report keeps of an estimation."""


def demo(
    mesh: Annotated[
        Path | None, typer.Argument(help="Mesh file (default: examples/goblet.ply).", show_default=False)
    ] = None,
    once: Annotated[bool, typer.Option("--once", help="End when all is done; do not keep serving.")] = False,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port of the service; 0 takes a free one.")] = 0,
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the results.")] = Path("demo-output"),
    data_dir: Annotated[
        Path | None,
        typer.Option(
            help="Keep the service's folder here; a classifier that an earlier demo trained there with the same "
            "settings is used again (default: a temporary folder, trained anew).",
            show_default=False,
        ),
    ] = None,
    classes: Annotated[
        list[str] | None,
        typer.Option(
            "--class",
            help="Learn this class only; repeatable (default: all that ship but the further objects).",
            show_default=False,
        ),
    ] = None,
    variations: Annotated[int, typer.Option(min=1, help="Random variations of each class to learn from.")] = 60,
    images: Annotated[int, typer.Option(min=1, help="Images of each variation.")] = 5,
    seed: Annotated[int, typer.Option(min=0, help="Seed of all random choices.")] = 0,
    settings_file: Annotated[
        Path | None,
        typer.Option("--settings", help='JSON file with settings of the estimation: {"estimator": "reference"}.'),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Show the whole path on one mesh: train, classify, estimate, and look at it in the dashboard.

    Starts the service and a worker, uploads the procedural models that ship, trains a classifier with pictures of
    their random variations (the further objects that ship stand for what is of none of the classes), uploads MESH,
    asks what it is and which parameters rebuild it. Everything goes through the REST service, as it would from
    another machine. Exit status 0 only if every step succeeded.

    Examples:

      [bold]bash scripts/demo[/]                       the sample, then the dashboard until Ctrl-C
      [bold]bash scripts/demo my-table.off --once[/]   a mesh of yours
      [bold]bash scripts/demo my-table.off --class table --class chair --class stool[/]   it is one of these
    """
    for number in (signal.SIGINT, signal.SIGTERM):  # a shell that starts us in the background has SIGINT ignored
        signal.signal(number, signal.default_int_handler)
    console = stderr() if as_json else stdout()
    names = _models_of(classes)
    query = SAMPLE if mesh is None else mesh
    training = {"variations": variations, "images_per_variation": images, "negatives": variations, "seed": seed}
    finished = False
    try:
        _refuse_early(query)
        estimating = {"seed": seed} | (read_object(settings_file) if settings_file else {})
        output.mkdir(parents=True, exist_ok=True)
        with contextlib.ExitStack() as stack:
            folder = data_dir or stack.enter_context(_temporary_folder())
            _step(console, 1, "start the service and a worker (SQLite, a folder, no other server)")
            from cli.client import connected
            from cli.local_service import local_service

            service = stack.enter_context(local_service(folder, port=port, log=output / "service.log"))
            client = stack.enter_context(connected(service["url"], ready_within_s=READY_WITHIN_S))
            console.print(f"   {service['url']}, worker {service['worker_pid']}, log {output / 'service.log'}")
            report = _walk(client, console, names, _negatives_of(classes), query, output, training, estimating)
            report["dashboard_url"] = service["dashboard_url"]
            finished = True
            if as_json:
                print_json(report)
            console.print(f"\nDashboard: [bold]{service['dashboard_url']}[/]")
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


def _models_of(classes: list[str] | None) -> list[str]:
    """Return the names of the shipped models of some classes; raises ModelError for one that does not ship.

    Without classes, of all but the further objects.
    """
    known, further = list_classes(), list_further_classes()
    for name in classes or ():
        if name not in known:
            raise ModelError(f"no such class ships (these do: {', '.join(known)})", where=repr(name))
    chosen = classes or [name for name in known if name not in further]
    return [model for name in dict.fromkeys(chosen) for model in known[name]]


def _negatives_of(classes: list[str] | None) -> list[str]:
    """Return the names of the models of the further objects that are none of the classes."""
    known = list_classes()
    return [model for name in list_further_classes() if name not in (classes or ()) for model in known[name]]


def _refuse_early(query: Path) -> None:
    """A mesh that the service will refuse is told about before a classifier is trained."""
    from shapewright.mesh.file import load_mesh

    load_mesh(query, in_child=True)


@contextlib.contextmanager
def _temporary_folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="shapewright-demo-", ignore_cleanup_errors=True) as folder:
        yield Path(folder)


def _step(console: "Console", number: int, text: str) -> None:
    console.print(f"[bold cyan]{number}[/] [bold]{text}[/]")


def _walk(
    client: "Client",
    console: "Console",
    names: list[str],
    negatives: list[str],
    query: Path,
    output: Path,
    training: dict[str, int],
    estimating: dict[str, Any],
) -> dict[str, Any]:
    """Take the steps 2 to 5; return what they found."""
    _step(console, 2, "upload the procedural models")
    models = _upload_models(client, console, names)
    others = _upload_models(client, console, negatives) if negatives else []

    _step(console, 3, "train a classifier with pictures of their variations")
    ids, other_ids = ([model["id"] for model in group] for group in (models, others))
    classifier = _train(client, console, ids, other_ids, training)

    _step(console, 4, f"upload {query}, classify it and estimate its parameters")
    uploaded = client.upload("/v1/meshes", query)
    console.print(
        f"   {uploaded['vertex_count']} vertices, {uploaded['face_count']} triangles, "
        f"{'closed' if uploaded['watertight'] else 'not closed'}"
    )
    classification = _run(
        client,
        "classifying",
        "/v1/classifications",
        {"mesh_id": uploaded["id"], "classifier_id": classifier["id"], "views": VIEWS},
    )
    found = classification["result"]
    if found["answer"] == found["class_name"]:
        console.print(f"   it is a [bold]{found['class_name']}[/] ({found['seconds']:.1f} s)")
    else:
        nearest = f"nearest is [bold]{found['class_name']}[/]"
        console.print(f"   it is [bold]{found['answer']}[/], {nearest} ({found['seconds']:.1f} s)")
    if found["known"] is not None:
        console.print(f"   it is of one of the classes with a probability of {found['known']:.1%}")
    estimation = _run(
        client,
        "estimating",
        "/v1/estimations",
        {"mesh_id": uploaded["id"], "class_name": found["class_name"], "settings": estimating},
    )
    fit = estimation["result"]

    _step(console, 5, "what was found")
    console.print(probability_table(found["probabilities"]))
    print_estimation(console, fit, seconds=fit["seconds"])
    picture, glb = _write_files(client, uploaded["id"], estimation, output, query.stem)
    console.print(f"   {picture}\n   {glb}")
    return {
        "query": str(query),
        "class_name": found["class_name"],
        "answer": found["answer"],
        "known": found["known"],
        "probabilities": found["probabilities"],
        "classifier_metrics": classifier["metrics"],
        "model": fit["model"]["name"],
        **{name: fit[name] for name in SHOWN},
        "seconds": {"classification": found["seconds"], "estimation": fit["seconds"]},
        "picture_file": str(picture),
        "mesh_file": str(glb),
    }


def _upload_models(client: "Client", console: "Console", names: list[str]) -> list[Any]:
    models, uploaded = [], 0
    shipped = list_shipped()
    for name in names:
        model, new = client.post_document("/v1/models", shipped[name].read_text(encoding="utf-8"))
        models.append(model)
        uploaded += new
    for class_name in sorted({model["class_name"] for model in models}):
        names = [model["name"] for model in models if model["class_name"] == class_name]
        console.print(f"   {class_name}: {', '.join(names)}")
    console.print(f"   {len(models)} models, {uploaded} of them new here")
    return models


def _train(
    client: "Client", console: "Console", model_ids: list[str], negative_ids: list[str], settings: dict[str, int]
) -> Any:
    for classifier in client.list_items("/v1/classifiers"):
        same = all(classifier["settings"].get(name) == value for name, value in settings.items())
        same = same and set(classifier["model_ids"]) == set(model_ids)
        if classifier["state"] == "succeeded" and same and set(classifier["negative_model_ids"]) == set(negative_ids):
            console.print("   the classifier of an earlier demo in this folder is used again")
            return classifier
    started_s = time.monotonic()
    body = {"name": "demo", "model_ids": model_ids, "negative_model_ids": negative_ids, "settings": settings}
    classifier = _run(client, "training", "/v1/classifiers", body)
    count = settings["variations"] * settings["images_per_variation"]
    seconds = time.monotonic() - started_s
    console.print(f"   {len(classifier['class_names'])} classes, {count} images each ({seconds:.1f} s)")
    return classifier


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
