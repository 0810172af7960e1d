"""Speed and memory of a training: ``.venv/bin/python benchmarks/training.py``, one JSON document.

The paper's scale by default: ten classes that ship, 1000 variations of 10 pictures each, and the objects of no class
beside them. The training begins with an empty store. Then one class more is learned on top of what is stored: only its
own chunks are computed. The baseline draws and describes some variations of every class one by one, with the network in
floating point; ``ratio`` tells how many times faster the training's pictures come.
"""

import argparse
import json
import os
import platform
import resource
import tempfile
import time
from typing import Any

import numpy as np

from cli.sources import load_classes, load_negatives
from shapewright.classification.pictures import draw
from shapewright.modeling import CompiledModel
from shapewright.network import FeatureExtractor, load_backbone
from shapewright.progress import CallbackProgress, Progress
from shapewright.training import FolderStore, TrainingSettings, train_classifier
from shapewright.training.chunks import chunks_of
from shapewright.training.sources import ModelSource

ELEVENTH = "stool"


class Phases:
    """Notes when the drawing ended and the learning began."""

    def __init__(self) -> None:
        self.started_s = time.perf_counter()
        self.drawn_s: float | None = None

    def progress(self) -> Progress:
        """What the training reports to."""
        return CallbackProgress(self._report)

    def _report(self, fraction: float, message: str) -> None:
        if self.drawn_s is None and message == "reading features":
            self.drawn_s = time.perf_counter() - self.started_s


def train(classes: dict[str, list[CompiledModel]], settings: TrainingSettings, store: FolderStore) -> dict[str, Any]:
    """Train once and tell how long it took."""
    phases, processor_s = Phases(), time.process_time()
    trained = train_classifier(classes, settings, phases.progress(), negatives=load_negatives(classes), store=store)
    seconds = time.perf_counter() - phases.started_s
    drawn_s = phases.drawn_s or 0.0
    return {
        "images": trained.metrics["images"],
        "seconds": round(seconds, 1),
        "seconds_drawing_and_describing": round(drawn_s, 1),
        "seconds_learning": round(seconds - drawn_s, 1),
        "processor_seconds": round(time.process_time() - processor_s, 1),
        "held_out_accuracy": trained.metrics["held_out_accuracy"],
        "left_out_accuracy": trained.metrics.get("left_out_accuracy"),
    }


def one_by_one(classes: dict[str, list[CompiledModel]], settings: TrainingSettings, each: int) -> float:
    """Images a second when every picture is drawn and described alone, in floating point."""
    extractor = FeatureExtractor(load_backbone("efficientnet_lite0"), threads=2)
    count = 0
    extractor(np.zeros((1, settings.image_size, settings.image_size, 3), dtype=np.uint8))
    shown = np.zeros(1, dtype=np.int64)
    started_s = time.perf_counter()
    for models in classes.values():
        chunk = chunks_of(ModelSource(models[0]), each)[0]
        rotations, scales = chunk.views(settings)
        for number, learned in enumerate(chunk.objects(settings)):
            for rotation, scale in zip(rotations[number], scales[number], strict=True):
                extractor(draw([learned], rotation[None], scale[None], settings.look, shown=shown))
                count += 1
    return count / (time.perf_counter() - started_s)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--variations", type=int, default=1000)
    parser.add_argument("--images", type=int, default=10)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    settings = TrainingSettings(
        variations=options.variations,
        images_per_variation=options.images,
        negatives=options.variations // 2,
        seed=options.seed,
    )
    classes = load_classes(None)
    with tempfile.TemporaryDirectory() as folder:
        store = FolderStore(folder)
        figures = train(classes, settings, store)
        peak_mb = round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
        again = train(classes | load_classes([ELEVENTH]), settings, store)
    baseline = one_by_one(classes, settings, each=2)
    rate = figures["images"] / figures["seconds_drawing_and_describing"]
    document = {
        "machine": platform.machine(),
        "cores": os.cpu_count(),
        "classes": len(classes),
        "training": figures,
        "images_per_second": round(rate, 1),
        "one_by_one_images_per_second": round(baseline, 1),
        "ratio": round(rate / baseline, 2),
        "peak_memory_mb": peak_mb,
        "one_class_more": again,
    }
    print(json.dumps(document, indent=2))


if __name__ == "__main__":
    main()
