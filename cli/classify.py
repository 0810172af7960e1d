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
    """Tell the class of one or more meshes, with probabilities.

    Examples:

      [bold]shapewright classify query.off -c classifier.onnx[/]
      [bold]shapewright classify meshes/*.obj -c classifier.onnx --json[/]
    """
    import numpy as np

    from shapewright.classification import Classifier
    from shapewright.mesh_file import load_mesh

    network = Classifier(classifier)
    results: list[dict[str, Any]] = []
    with shown_progress("classifying") as progress:
        for number, file in enumerate(meshes):
            PartialProgress(progress, number / len(meshes), 1.0).report(0.0, file.name)
            started_s = time.monotonic()
            found = network.classify(load_mesh(file, in_child=True), views=views, rng=np.random.default_rng(seed))
            ranked = sorted(found.probabilities.items(), key=lambda item: -item[1])
            results.append(
                {
                    "file": str(file),
                    "class_name": found.class_name,
                    "probabilities": [{"class_name": n, "probability": float(p)} for n, p in ranked],
                    "seconds": round(time.monotonic() - started_s, 3),
                }
            )
    if as_json:
        print_json({"classifier": str(classifier), "views": views, "results": results})
        return
    from rich.table import Table

    table = Table("file", "class", "probability", "next")
    for result in results:
        first, *others = result["probabilities"]
        following = f"{others[0]['class_name']} {others[0]['probability']:.1%}" if others else ""
        table.add_row(result["file"], result["class_name"], f"{first['probability']:.1%}", following)
    stdout().print(table)
