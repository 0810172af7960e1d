"""Speed of classification: ``.venv/bin/python benchmarks/classify.py``, one JSON document.

One mesh of about 5 000 faces on a warm classifier (10 views, with geometry), by its parts; the same without geometry;
meshes of a folder a second, files and their child processes included. The baseline asks for one view at a time. The
classifier that ships is measured unless ``--classifier`` names another.
"""

import argparse
import json
import os
import platform
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from shapewright.classification import Classifier, load_classifier, load_ready_classifier
from shapewright.classification.readings import readings
from shapewright.distances.panorama import panorama_descriptor
from shapewright.evaluation.datasets import LabelledFile, load_each
from shapewright.mesh import TriangleMesh

FACES = 5000


def median_ms(work: Callable[[], object], repeats: int) -> float:
    """Median after one warm-up."""
    work()
    seconds = []
    for _ in range(repeats):
        started_s = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - started_s)
    return round(1e3 * statistics.median(seconds), 1)


def sphere_like(faces: int) -> TriangleMesh:
    """A lumpy ball of about so many faces."""
    sides = round(np.sqrt(faces / 2))
    height, angle = np.meshgrid(np.linspace(-1, 1, sides + 1), np.arange(sides) * 2 * np.pi / sides, indexing="ij")
    radius = np.sqrt(np.maximum(1 - height**2, 0.0)) * (1 + 0.2 * np.sin(5 * angle) * np.cos(4 * height))
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=-1).reshape(-1, 3)
    ring, side = np.meshgrid(np.arange(sides), np.arange(sides), indexing="ij")
    a, b = ring * sides + side, ring * sides + (side + 1) % sides
    quads = np.stack([a, b, b + sides, a + sides], axis=-1).reshape(-1, 4)
    return TriangleMesh(vertices, np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]))


def meshes_a_second(classifier: Classifier, mesh: TriangleMesh, count: int) -> float:
    """Files read in children, ahead of the classifier, as the commands do it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.off"
        mesh.save(path)
        started_s = time.perf_counter()
        for _, read in load_each([LabelledFile("mesh.off", "", path)] * count):
            assert isinstance(read, TriangleMesh)
            classifier.classify(read)
        return count / (time.perf_counter() - started_s)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--classifier", "-c", type=Path)
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--meshes", type=int, default=60)
    options = parser.parse_args()
    classifier = load_classifier(options.classifier) if options.classifier else load_ready_classifier()
    pictures_alone = Classifier.__new__(Classifier)
    pictures_alone.__dict__.update(vars(classifier) | {"exemplars": None})
    mesh = sphere_like(FACES)
    images = classifier.render(mesh)
    parts = {
        "reading": median_ms(lambda: readings(mesh), options.repeats),
        "reading and drawing": median_ms(lambda: classifier.render(mesh), options.repeats),
        "network": median_ms(lambda: classifier.predict(images), options.repeats),
    }
    if classifier.exemplars is not None:
        descriptor = panorama_descriptor(mesh.vertices, mesh.faces)
        exemplars = classifier.exemplars
        parts["descriptor"] = median_ms(lambda: panorama_descriptor(mesh.vertices, mesh.faces), options.repeats)
        parts["exemplars"] = median_ms(lambda: exemplars.nearest(exemplars.distances(descriptor)), options.repeats)
    total_ms = median_ms(lambda: classifier.classify(mesh), options.repeats)

    def view_by_view() -> None:
        for number in range(10):
            pictures_alone.classify(mesh, views=1, rng=np.random.default_rng(number))

    document = {
        "machine": platform.machine(),
        "cores": os.cpu_count(),
        "faces": len(mesh.faces),
        "views": 10,
        "exemplars": 0 if classifier.exemplars is None else len(classifier.exemplars),
        "classify_ms": total_ms,
        "parts_ms": parts,
        "pictures_alone_ms": median_ms(lambda: pictures_alone.classify(mesh), options.repeats),
        "view_by_view_ms": (one_by_one := median_ms(view_by_view, options.repeats)),
        "folder_meshes_per_second": round(meshes_a_second(classifier, mesh, options.meshes), 2),
    }
    document["view_by_view_over_batch"] = round(one_by_one / document["pictures_alone_ms"], 2)
    print(json.dumps(document, indent=2))


if __name__ == "__main__":
    main()
