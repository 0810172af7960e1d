"""Speed of pictures, features and classification: ``.venv/bin/python benchmarks/images.py``, one JSON document.

Instances are turned shapes of 3 072 triangles, as large as a procedural model's after two subdivisions. The baseline
draws and reads back every picture by itself, with the same renderer.
"""

import argparse
import json
import platform
import resource
import statistics
import time
from collections.abc import Callable

import numpy as np

from shapewright.classification import Classifier
from shapewright.mesh import TriangleMesh
from shapewright.network import FeatureExtractor, load_backbone
from shapewright.rendering import random_views, render_images, renderer_name
from shapewright.training.calibration import Calibration
from shapewright.training.export import classifier_metadata, export_classifier
from shapewright.training.head import Head, Layer
from shapewright.training.settings import TrainingSettings

SIDES, RINGS = 48, 33


def instances(count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    height = np.linspace(-1.0, 1.0, RINGS)
    radius = 0.35 + 0.25 * np.sin(3.0 * height + rng.uniform(0, 3, (count, 1))) * rng.uniform(0.3, 1, (count, 1))
    angle = np.arange(SIDES) * 2 * np.pi / SIDES
    vertices = np.stack(
        np.broadcast_arrays(
            radius[:, :, None] * np.cos(angle),
            height[None, :, None],
            radius[:, :, None] * np.sin(angle),
        ),
        axis=-1,
    ).reshape(count, -1, 3)
    ring, side = np.meshgrid(np.arange(RINGS - 1), np.arange(SIDES), indexing="ij")
    a, b = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
    quads = np.stack([a, a + SIDES, b + SIDES, b], axis=-1).reshape(-1, 4)
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def median_seconds(work: Callable[[], object], repeats: int, clock: Callable[[], float] = time.perf_counter) -> float:
    """Median after one warm-up."""
    work()
    seconds = []
    for _ in range(repeats):
        start = clock()
        work()
        seconds.append(clock() - start)
    return statistics.median(seconds)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--variations", type=int, default=24)
    parser.add_argument("--views", type=int, default=10)
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    rng = np.random.default_rng(0)
    vertices, triangles = instances(options.variations, rng)
    count = options.variations * options.views
    objects = np.repeat(np.arange(options.variations), options.views)
    rotations, scales = random_views(rng, count)

    def batch(style: str = "edges") -> np.ndarray:
        return render_images(vertices, triangles, rotations, scales, objects=objects, style=style)

    def one_by_one() -> None:
        for i, number in enumerate(objects):
            at = slice(i, i + 1)
            render_images(vertices[number : number + 1], triangles, rotations[at], scales[at])

    batch_s = median_seconds(batch, options.repeats)
    processor_s = median_seconds(batch, options.repeats, clock=time.process_time)
    single_s = median_seconds(one_by_one, options.repeats)
    shaded_s = median_seconds(lambda: batch("shaded"), options.repeats)
    images = batch()[:96]
    backbone = load_backbone()
    extractor = FeatureExtractor(backbone)
    features_s = median_seconds(lambda: extractor(images), options.repeats)
    head = Head((Layer(rng.normal(size=(10, 1280)).astype(np.float32), np.zeros(10, np.float32)),), 10, 1.0, {}, 0)
    names = tuple(f"class_{number}" for number in range(10))
    metadata = classifier_metadata(names, (), backbone, TrainingSettings(), {}, Calibration(1.0, None, None, None, {}))
    classifier = Classifier(export_classifier(backbone, head, metadata))
    mesh = TriangleMesh(vertices[0], triangles)
    classify_s = median_seconds(lambda: classifier.classify(mesh, views=options.views), 4 * options.repeats)
    draw_s = median_seconds(lambda: classifier.render(mesh, views=options.views), 4 * options.repeats)
    print(
        json.dumps(
            {
                "renderer": renderer_name(),
                "machine": platform.machine(),
                "images": count,
                "image_size": 224,
                "triangles": len(triangles),
                "images_per_second": {
                    "edges_batch": round(count / batch_s, 1),
                    "edges_one_by_one": round(count / single_s, 1),
                    "shaded_batch": round(count / shaded_s, 1),
                    "batch_over_one_by_one": round(single_s / batch_s, 2),
                },
                "processor_ms_per_image": round(1e3 * processor_s / count, 2),
                "features_per_second": round(len(images) / features_s, 1),
                "drawn_and_described_per_second": round(1 / (batch_s / count + features_s / len(images)), 1),
                "classify_ms": {
                    "views": options.views,
                    "total": round(1e3 * classify_s, 1),
                    "drawing": round(1e3 * draw_s, 1),
                },
                "peak_memory_mb": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024),
            },
            indent=2,
        )
    )


if __name__ == "__main__":
    main()
