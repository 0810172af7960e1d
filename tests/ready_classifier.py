"""The files of a ready classifier whose network is not real: what the service reads of it are its metadata."""

import json
from pathlib import Path
from typing import Any

import onnx
from onnx import helper

from shapewright.classification.file_format import FORMAT, FORMAT_VERSION, METADATA_KEY, exemplars_file
from shapewright.classification.ready_files import READY_FILE


def write_ready_classifier(folder: Path, metadata: str | None = None, **changes: Any) -> Path:
    """Write both files into a folder, which is created; ``changes`` are fields of the metadata."""
    described: dict[str, Any] = {
        "format": FORMAT,
        "version": FORMAT_VERSION,
        "class_names": ["box", "crate"],
        "models": [{"name": "box", "class": "box", "digest": "a" * 64}],
        "settings": {"variations": 3},
        "metrics": {"accuracy": 0.75, "loss": float("nan")},
    }
    numbers = helper.make_tensor("weights", onnx.TensorProto.FLOAT, [300], [0.5] * 300)
    graph = helper.make_graph([], "empty", [], [], [numbers])
    model = helper.make_model(graph)
    helper.set_model_props(model, {"class_names": "[]", METADATA_KEY: metadata or json.dumps(described | changes)})
    folder.mkdir(parents=True, exist_ok=True)
    (folder / READY_FILE).write_bytes(model.SerializeToString())
    exemplars_file(folder / READY_FILE).write_bytes(b"exemplars")
    return folder
