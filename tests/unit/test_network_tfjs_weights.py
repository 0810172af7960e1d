"""Weights of TensorFlow.js models: what was stored is what is read, damaged files are refused."""

import json
from pathlib import Path

import numpy as np
import pytest

from shapewright.errors import ClassifierError
from shapewright.network import tfjs_weights
from shapewright.network.tfjs_weights import WeightsFile

INTEGERS = np.arange(24, dtype=np.uint8).reshape(2, 3, 4)
FINE_INTEGERS = np.array([0, 1, 65535], dtype="<u2")
PLAIN = np.array([[0.5, -1.5]], dtype="<f4")
HALVES = np.array([0.25, -8.0], dtype="<f2")


def write_model(folder: Path, *, changed: dict | None = None) -> Path:
    """A tiny model whose first weight is torn apart by the border of two files."""
    weights = [
        {
            "name": "conv/kernel",
            "shape": [2, 3, 4],
            "dtype": "float32",
            "quantization": {"dtype": "uint8", "scale": 0.125, "min": -1.0},
        },
        {
            "name": "fine",
            "shape": [3],
            "dtype": "float32",
            "quantization": {"dtype": "uint16", "scale": 0.5, "min": 2.0},
        },
        {"name": "plain", "shape": [1, 2], "dtype": "float32"},
        {"name": "half", "shape": [2], "dtype": "float32", "quantization": {"dtype": "float16"}},
        {"name": "single", "shape": [], "dtype": "float32"},
    ]
    weights[0] |= changed or {}
    content = b"".join(array.tobytes() for array in (INTEGERS, FINE_INTEGERS, PLAIN, HALVES, np.float32(7.0)))
    (folder / "first").write_bytes(content[:10])
    (folder / "second").write_bytes(content[10:])
    model = folder / "model.json"
    model.write_text(json.dumps({"weightsManifest": [{"paths": ["first", "second"], "weights": weights}]}))
    return model


def convert(model: Path) -> Path:
    output = model.parent / "deeper" / "weights.npz"
    tfjs_weights.main([str(model), str(output), "--source", "hand-made"])
    return output


def test_weights_are_what_the_model_means(tmp_path):
    weights = WeightsFile(convert(write_model(tmp_path)))
    assert weights.source == "hand-made"
    assert np.array_equal(weights["conv/kernel"], INTEGERS * 0.125 - 1.0)
    assert np.array_equal(weights["fine"], [2.0, 2.5, 32769.5])
    assert np.array_equal(weights["plain"], PLAIN)
    assert np.array_equal(weights["half"], HALVES)
    assert weights["single"] == 7.0
    assert all(weights[name].dtype == np.float32 for name in ("conv/kernel", "fine", "plain", "half", "single"))


def test_the_same_model_gives_the_same_file(tmp_path):
    model = write_model(tmp_path)
    first = convert(model)
    digest, content = WeightsFile(first).sha256, first.read_bytes()
    assert convert(model).read_bytes() == content
    assert WeightsFile(first).sha256 == digest


@pytest.mark.parametrize(
    "changed",
    [{"shape": [2, 3, 5]}, {"shape": [2, 3]}, {"dtype": "string", "quantization": {}}, {"shape": None}],
)
def test_a_manifest_that_does_not_fit_is_refused(tmp_path, changed):
    with pytest.raises(ClassifierError, match="no model of TensorFlow") as caught:
        convert(write_model(tmp_path, changed=changed))
    assert caught.value.where == "model.json"
    assert not (tmp_path / "deeper").exists()


def test_missing_and_foreign_files_are_refused(tmp_path):
    model = write_model(tmp_path)
    (tmp_path / "second").unlink()
    with pytest.raises(ClassifierError, match="cannot be read") as caught:
        convert(model)
    assert caught.value.where == "second"
    model.write_text("[]")
    with pytest.raises(ClassifierError, match="no model of TensorFlow"):
        convert(model)

    other = tmp_path / "other.npz"
    with pytest.raises(ClassifierError, match="cannot be read"):
        WeightsFile(other)
    objects = tmp_path / "objects.npz"
    np.savez(objects, source=np.array([{"not": "plain"}], dtype=object))
    np.savez(other, numbers=np.zeros(3))
    array = tmp_path / "array.npz"
    with array.open("wb") as file:
        np.save(file, np.zeros(3))
    text = tmp_path / "text.npz"
    text.write_text("no archive")
    empty = tmp_path / "empty.npz"
    empty.touch()
    for path in (other, objects, array, text, empty):
        with pytest.raises(ClassifierError, match="no file of weights"):
            WeightsFile(path)


def test_a_weight_that_is_not_there_is_named(tmp_path):
    weights = WeightsFile(convert(write_model(tmp_path)))
    with pytest.raises(ClassifierError, match="conv/bias"):
        weights["conv/bias"]
