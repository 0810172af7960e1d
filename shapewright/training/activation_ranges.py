"""Measures the ranges of the backbone's activations that its 8-bit form needs, and writes them beside it.

``python -m shapewright.training.activation_ranges``. The pictures show random assemblies in the default style, so
the ranges depend on no procedural model. They are kept in the repository: every machine then has the same graph.
"""

import json
from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper

from shapewright.network import backbone
from shapewright.network.backbone import RANGES_FILE, efficientnet_lite0_layers, load_backbone
from shapewright.network.ports import IMAGES
from shapewright.network.quantized_graph import Ranges, range_names
from shapewright.network.session import make_session
from shapewright.training.chunks import chunk_images, chunks_of
from shapewright.training.settings import TrainingSettings
from shapewright.training.sources import AssemblySource

OBJECTS = 48
VIEWS = 2
_BATCH = 8


def measured_ranges() -> Ranges:
    """Smallest and largest activations over the pictures, from the network in floating point."""
    names = range_names(efficientnet_lite0_layers()[0])
    model = onnx.load_model_from_string(load_backbone("efficientnet_lite0").graph)
    model.graph.output.extend(helper.make_tensor_value_info(name, TensorProto.FLOAT, None) for name in names)
    session = make_session(model.SerializeToString())
    settings = TrainingSettings(images_per_variation=VIEWS)
    (chunk,) = chunks_of(AssemblySource(), OBJECTS)
    images = chunk_images(chunk, settings)
    lows, highs = np.zeros(len(names)), np.zeros(len(names))
    for start in range(0, len(images), _BATCH):
        found = session.run(names, {IMAGES: images[start : start + _BATCH]})
        lows = np.minimum(lows, [array.min() for array in found])
        highs = np.maximum(highs, [array.max() for array in found])
    return {name: (float(low), float(high)) for name, low, high in zip(names, lows, highs, strict=True)}


def main() -> None:
    """Write the file."""
    rounded = {name: [float(f"{end:.5g}") for end in ends] for name, ends in measured_ranges().items()}
    lines = ",\n".join(f"  {json.dumps(name)}: {json.dumps(ends)}" for name, ends in rounded.items())
    Path(backbone.__file__).with_name(RANGES_FILE).write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
