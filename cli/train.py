"""`shapewright train`: a classifier out of procedural models, as one ONNX file."""

import time
from pathlib import Path
from typing import Annotated

import typer

from cli.console import AsJson, print_json, shown_progress
from cli.sources import load_classes, read_object
from shapewright.errors import ClassifierError
from shapewright.whole_file import write_whole


def train(
    output: Annotated[Path, typer.Option("--output", "-o", help="Classifier file, .onnx.", show_default=False)],
    models: Annotated[
        list[str] | None,
        typer.Argument(
            help="Classes, shipped models or JSON files; default: every shipped class with all of its models.",
            show_default=False,
        ),
    ] = None,
    variations: Annotated[
        int | None, typer.Option(min=1, help="Random variations of each class (default: 1000).", show_default=False)
    ] = None,
    images: Annotated[
        int | None, typer.Option(min=1, help="Images of each variation (default: 10).", show_default=False)
    ] = None,
    epochs: Annotated[int | None, typer.Option(min=1, help="Passes over the images.", show_default=False)] = None,
    seed: Annotated[
        int | None,
        typer.Option(min=0, help="Seed of variations, views and training (default: 0).", show_default=False),
    ] = None,
    settings_file: Annotated[
        Path | None, typer.Option("--settings", help='JSON file with any of the settings, e.g. {"image_size": 160}.')
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Train a classifier with pictures of random variations; the models of a class share its variations evenly.

    Examples:

      [bold]shapewright train -o classifier.onnx[/]                                    the shipped models
      [bold]shapewright train table sword lamp.json -o mine.onnx --variations 200[/]   and one of your own
    """
    if output.suffix.lower() != ".onnx":
        raise ClassifierError("classifiers are written as .onnx", where=str(output))
    from shapewright.classification import TrainingSettings, train_classifier

    by_class = load_classes(models)
    options = {"variations": variations, "images_per_variation": images, "epochs": epochs, "seed": seed}
    chosen = read_object(settings_file) if settings_file is not None else {}
    chosen |= {name: value for name, value in options.items() if value is not None}
    try:
        settings = TrainingSettings(**chosen)
    except TypeError as error:
        raise ClassifierError(f"a setting that there is not, or of a wrong type: {error}") from None
    started_s = time.monotonic()
    names = {name: [compiled.model.name for compiled in members] for name, members in by_class.items()}
    with shown_progress("training") as progress:
        trained = train_classifier(by_class, settings, progress=progress)
    seconds = time.monotonic() - started_s
    output.parent.mkdir(parents=True, exist_ok=True)
    write_whole(output, trained.onnx)
    if as_json:
        print_json(
            {
                "file": str(output),
                "class_names": list(trained.class_names),
                "models": names,
                "metrics": trained.metrics,
                "seconds": round(seconds, 3),
            }
        )
        return
    typer.echo(f"{output}: {', '.join(trained.class_names)} ({seconds:.0f} s)")
    for name, value in trained.metrics.items():
        if isinstance(value, float):
            typer.echo(f"  {name}: {value:.4g}")
