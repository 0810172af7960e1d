"""`shapewright classify`: what is this mesh?"""

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from shapewright.progress import PartialProgress


def classify(
    meshes: Annotated[list[Path], typer.Argument(help="Mesh files.", show_default=False)],
    classifier: Annotated[
        Path, typer.Option("--classifier", "-c", help="The .onnx file of `shapewright train`.", show_default=False)
    ],
    views: Annotated[int, typer.Option(min=1, max=1000, help="Pictures taken of each mesh.")] = 10,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random views.")] = 0,
    as_json: AsJson = False,
) -> None:
    """Tell the class of one or more meshes, with probabilities, or that it is unknown.

    Geometry counts beside the pictures where the exemplars that `shapewright train` wrote lie beside the classifier.

    Examples:

      [bold]shapewright classify query.off -c classifier.onnx[/]
      [bold]shapewright classify meshes/*.obj -c classifier.onnx --json[/]
    """
    import numpy as np

    from shapewright.classification import load_classifier
    from shapewright.mesh_file import load_mesh

    network = load_classifier(classifier)
    results: list[dict[str, Any]] = []
    with shown_progress("classifying") as progress:
        for number, file in enumerate(meshes):
            PartialProgress(progress, number / len(meshes), 1.0).report(0.0, file.name)
            started_s = time.monotonic()
            found = network.classify(load_mesh(file, in_child=True), views=views, rng=np.random.default_rng(seed))
            results.append(
                {
                    "file": str(file),
                    "answer": found.answer,
                    "class_name": found.class_name,
                    "known": found.known,
                    "probabilities": _listed(found.probabilities, "probability"),
                    "picture_probabilities": _listed(found.picture_probabilities, "probability"),
                    "distances": None if found.distances is None else _listed(found.distances, "distance"),
                    "seconds": round(time.monotonic() - started_s, 3),
                }
            )
    if as_json:
        print_json({"classifier": str(classifier), "views": views, "results": results})
        return
    from rich.table import Table

    table = Table("file", "answer", "known", "class", "probability", "next")
    for result in results:
        first, *others = result["probabilities"]
        following = f"{others[0]['class_name']} {others[0]['probability']:.1%}" if others else ""
        known = "" if result["known"] is None else f"{result['known']:.1%}"
        probability = f"{first['probability']:.1%}"
        table.add_row(result["file"], result["answer"], known, first["class_name"], probability, following)
    stdout().print(table)


def _listed(values: dict[str, float], what: str) -> list[dict[str, Any]]:
    return [{"class_name": name, what: value} for name, value in values.items()]
