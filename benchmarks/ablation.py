"""What each choice is worth on labelled meshes: ``.venv/bin/python benchmarks/ablation.py --dataset DIR``.

One JSON document: for each choice the accuracy within the classes, known against other (AUROC) and the mean average
precision, by pictures alone and with geometry; means over the seeds. Every line is trained anew from variations of the
shipped models, fewer than the paper's so that all lines together take about an hour on two cores. Meshes are read once.
``--only`` takes some of the lines. Nothing is tuned here: the lines are what a user can choose.
*Splats, whole variations* against the default is what broken variations bring, against *fused, whole variations* what
splats bring. *The paper's own configuration* is what ours is compared with: Inception, the paper's framing and light,
random views, no objects of no class, no geometry. The lines with Inception need ``scripts/backbone-inception``.
"""

import argparse
import json
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from cli.evaluation_options import cache_folder
from cli.sources import load_classes, load_negatives
from shapewright.classification import Classifier
from shapewright.classification.evidence import OTHER
from shapewright.evaluation.classification_figures import Evidence, figures_by, rankings_of, retrieval_figures
from shapewright.evaluation.classified import Found, Judged, JudgedDataset, Said
from shapewright.evaluation.datasets import LabelledFile, Skipped, load_each, read_dataset, spread
from shapewright.mesh import TriangleMesh
from shapewright.training import FolderStore, TrainingSettings, train_classifier

Meshes = list[tuple[LabelledFile, TriangleMesh]]

VIEWS = (1, 3, 10, 20)
PAPER_BACKBONE = "inception_v3"
"""The paper's network up to the block that its published weights know from ImageNet alone."""
STYLES = ("splats", "fused", "edges", "lambert", "depth", "normals", "shaded")


def lines(base: TrainingSettings) -> dict[str, TrainingSettings]:
    """The settings of each line."""
    plain = replace(base, negatives=0, exemplars=False)
    few = {"variations": base.variations, "images_per_variation": base.images_per_variation, "seed": base.seed}
    return {
        "default": base,
        "without variations": replace(plain, vary=False),
        "without objects of no class": replace(base, negatives=0),
        "the network in floating point": replace(base, backbone="efficientnet_lite0"),
        "random weights of the network": replace(plain, backbone="efficientnet_lite0_random"),
        "inception_v3": replace(base, backbone="inception_v3", image_size=0),
        "the paper's own configuration": TrainingSettings.paper(**few, backbone=PAPER_BACKBONE),
        "the paper's framing, one light": TrainingSettings.paper(**few),
        "the paper's framing, fused": replace(
            base, style="fused", broken=0.0, framing="paper", window=2.0, scale_range=(0.8, 2.0)
        ),
        **{f"{style}, whole variations": replace(base, style=style, broken=0.0) for style in STYLES},
    }


def judged(classifier: Classifier, meshes: Meshes, views: int) -> JudgedDataset:
    """Every mesh, by this classifier."""
    names = classifier.class_names
    rows = []
    for item, mesh in meshes:
        found = classifier.classify(mesh, views=views)
        said = [
            Said(*(np.array([values[name] for name in names]) for values in pair))
            for pair in (
                (found.probabilities, found.scores),
                (found.picture_probabilities, found.picture_scores),
            )
        ]
        distances = None if found.distances is None else np.array([found.distances[name] for name in names])
        label = item.class_name if item.class_name in names else OTHER
        rows.append(Judged(item, label, Found.of(found), *said, None, distances, None, {}, 0.0))
    return JudgedDataset(names, tuple(rows), ())


def figures(dataset: JudgedDataset) -> dict[str, float]:
    """Accuracy, AUROC and mean average precision by pictures and by all evidence."""
    out, rankings = {}, rankings_of(dataset)
    for name, said in (
        ("pictures", [one.by_pictures for one in dataset.judged]),
        ("all", [one.by_all for one in dataset.judged]),
    ):
        evidence = Evidence.joined(said)
        by = figures_by(dataset, evidence)
        out[f"accuracy_{name}"] = by.accuracy
        out[f"auroc_{name}"] = by.auroc_known or float("nan")
        out[f"map_{name}"] = retrieval_figures(dataset, rankings[name])[0].average_precision
    return out


def mean_of(rows: list[dict[str, float]]) -> dict[str, Any]:
    """Means, and the accuracies of the single seeds."""
    found: dict[str, Any] = {key: round(float(np.mean([row[key] for row in rows])), 4) for key in rows[0]}
    return found | {"accuracies": [round(row["accuracy_all"], 4) for row in rows]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--dataset", type=Path, required=True)
    parser.add_argument("--variations", type=int, default=150)
    parser.add_argument("--images", type=int, default=5)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--others", type=int, default=200, help="meshes of other classes")
    parser.add_argument("--only", nargs="*", help="lines to measure")
    options = parser.parse_args()
    classes = load_classes(None)
    negatives = load_negatives(classes)
    items = read_dataset(options.dataset)
    inside = [item for item in items if item.class_name in classes]
    outside = spread([item for item in items if item.class_name not in classes], options.others)
    meshes = [(item, mesh) for item, mesh in load_each([*inside, *outside], jobs=2) if not isinstance(mesh, Skipped)]
    store = FolderStore(cache_folder(None, "learning"))
    results: dict[str, Any] = {}
    first: Classifier | None = None
    names = lines(TrainingSettings())
    for name in options.only or names:
        started_s, rows = time.monotonic(), []
        for seed in range(options.seeds):
            base = TrainingSettings(
                variations=options.variations,
                images_per_variation=options.images,
                negatives=options.variations // 2,
                seed=seed,
            )
            trained = train_classifier(classes, lines(base)[name], negatives=negatives, store=store)
            classifier = Classifier(trained.onnx, exemplars=trained.exemplars)
            first = first or classifier
            rows.append(figures(judged(classifier, meshes, 10)))
        results[name] = mean_of(rows)
        print(f"{name}: {results[name]} ({time.monotonic() - started_s:.0f} s)", file=sys.stderr, flush=True)
    assert first is not None
    for views in VIEWS:
        results[f"{views} views (first line, first seed)"] = mean_of([figures(judged(first, meshes, views))])
    print(
        json.dumps(
            {
                "n": len(inside),
                "n_other": len(outside),
                "variations": options.variations,
                "images_per_variation": options.images,
                "seeds": options.seeds,
                "lines": results,
            },
            indent=2,
        )
    )


if __name__ == "__main__":
    main()
