"""`shapewright train`: a classifier out of procedural models, as one ONNX file."""

import time
from pathlib import Path
from typing import Annotated

import typer

from cli.console import AsJson, print_json, shown_progress
from cli.evaluation_options import CacheFolder
from cli.learning import extend, learn, save_classifier
from cli.sources import load_classes, load_negatives, read_object
from shapewright.errors import ClassifierError


def train(
    output: Annotated[Path, typer.Option("--output", "-o", help="Classifier file, .onnx.", show_default=False)],
    models: Annotated[
        list[str] | None,
        typer.Argument(
            help="Classes, shipped models or JSON files; default: all models of every class that ships, without the "
            "further objects.",
            show_default=False,
        ),
    ] = None,
    base: Annotated[
        str | None,
        typer.Option(
            "--extend",
            help="Add the classes to this classifier: 'ready', the one that ships, or a file. Takes under a minute.",
            metavar="ready|FILE",
            show_default=False,
        ),
    ] = None,
    variations: Annotated[
        int | None,
        typer.Option(
            min=1, help="Random variations of each class (default: 2000; with --extend 200).", show_default=False
        ),
    ] = None,
    images: Annotated[
        int | None,
        typer.Option(min=1, help="Images of each variation (default: 5; with --extend 4).", show_default=False),
    ] = None,
    epochs: Annotated[int | None, typer.Option(min=1, help="Passes over the images.", show_default=False)] = None,
    seed: Annotated[
        int | None,
        typer.Option(min=0, help="Seed of variations, views and training (default: 0).", show_default=False),
    ] = None,
    settings_file: Annotated[
        Path | None, typer.Option("--settings", help='JSON file with any of the settings, e.g. {"image_size": 160}.')
    ] = None,
    cache: CacheFolder = None,
    as_json: AsJson = False,
) -> None:
    """Train a classifier with pictures of random variations; the models of a class share its variations evenly.

    Shipped objects that are of none of the classes, and random assemblies, teach what is unknown. What was drawn is
    kept: the next training draws only what is new. Beside the .onnx file lies one with the geometry of the variations.

    With --extend a trained classifier gets new classes, and those that it knows stay. Of their models a few variations
    are drawn again: name the files of those that do not ship, too.

    Examples:

      [bold]shapewright train -o classifier.onnx[/]                                    the shipped models
      [bold]shapewright train table sword lamp.json -o mine.onnx --variations 200[/]   and one of your own
      [bold]shapewright train lamp.json --extend ready -o mine.onnx[/]                 added to the ready classifier
    """
    if output.suffix.lower() != ".onnx":
        raise ClassifierError("classifiers are written as .onnx", where=str(output))
    from shapewright.classification import exemplars_file
    from shapewright.training import TrainingSettings

    if base is not None and not models:
        raise ClassifierError("name the classes to add", where="--extend")
    by_class = load_classes(models)
    options = {"variations": variations, "images_per_variation": images, "epochs": epochs, "seed": seed}
    chosen = read_object(settings_file) if settings_file is not None else {}
    chosen |= {name: value for name, value in options.items() if value is not None}
    started_s = time.monotonic()
    if base is None:
        settings = TrainingSettings.from_dict(chosen)
        with shown_progress("training") as progress:
            trained = learn(by_class, load_negatives(by_class), settings, progress, cache)
    else:
        trained = extend(base, by_class, chosen, cache)
    seconds = time.monotonic() - started_s
    save_classifier(trained, output)
    names = {
        name: [model["name"] for model in trained.metadata["models"] if model["class"] == name]
        for name in trained.class_names
    }
    beside = None if trained.exemplars is None else exemplars_file(output)
    if as_json:
        print_json(
            {
                "file": str(output),
                "exemplars_file": None if beside is None else str(beside),
                "class_names": list(trained.class_names),
                "models": names,
                "extended": base,
                "metrics": trained.metrics,
                "seconds": round(seconds, 3),
            }
        )
        return
    typer.echo(f"{output}: {', '.join(trained.class_names)} ({seconds:.0f} s)")
    if beside is not None:
        typer.echo(f"{beside}: the geometry of the variations, for `classify` and `retrieve`")
    for name, value in trained.metrics.items():
        if isinstance(value, float):
            typer.echo(f"  {name}: {value:.4g}")
