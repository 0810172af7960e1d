"""Weights of a TensorFlow.js model in one file.

``python -m shapewright.network.tfjs_weights model.json weights.npz`` converts them.

A model of TensorFlow.js is ``model.json``, whose ``weightsManifest`` names the weights in order, and binary files
that hold them one after the other. Quantised weights are unsigned integers; the number meant is
``integer * scale + min``. They stay integers in our file, which is a quarter of the size.

The file is a plain ``.npz``: for each weight ``<name>`` as stored, ``<name>:scale`` and ``<name>:min`` where it is
quantised, and ``source``, a line that says where the weights come from.
"""

import argparse
import hashlib
import io
import json
import math
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from shapewright.errors import ClassifierError
from shapewright.whole_file import write_whole

SOURCE = "source"
_STORED = {"float32": "<f4", "int32": "<i4", "uint8": "u1", "uint16": "<u2", "float16": "<f2", "bool": "u1"}


def read_tfjs(model: Path) -> dict[str, np.ndarray]:
    """The entries of our file for a model of TensorFlow.js, without ``source``.

    Raises:
        ClassifierError: the files are missing, damaged, or of a kind that is not known.
    """
    try:
        manifest = json.loads(model.read_bytes())["weightsManifest"]
        entries: dict[str, np.ndarray] = {}
        for group in manifest:
            content = b"".join((model.parent / Path(path).name).read_bytes() for path in group["paths"])
            entries |= dict(_read_group(group["weights"], content))
    except OSError as error:
        raise ClassifierError(f"cannot be read: {error.strerror}", where=Path(error.filename or model).name) from error
    except (ValueError, KeyError, TypeError) as error:
        raise ClassifierError(f"no model of TensorFlow.js: {error!r}", where=model.name) from error
    return entries


def _read_group(weights: list[dict[str, Any]], content: bytes) -> Iterator[tuple[str, np.ndarray]]:
    start = 0
    for weight in weights:
        name, quantisation = weight["name"], weight.get("quantization", {})
        stored = np.dtype(_STORED[quantisation.get("dtype", weight["dtype"])])
        count = math.prod(weight["shape"])
        yield name, np.frombuffer(content, stored, count, start).reshape(weight["shape"])
        start += count * stored.itemsize
        if "scale" in quantisation:
            yield f"{name}:scale", np.array(quantisation["scale"], dtype=np.float64)
            yield f"{name}:min", np.array(quantisation["min"], dtype=np.float64)
    if start != len(content):
        raise ValueError(f"{len(content)} bytes of weights instead of {start}")


class WeightsFile:
    """Weights in a file that this module wrote.

    Args:
        path: the ``.npz``; it is read at once.

    Raises:
        ClassifierError: the file is missing, damaged, or another kind of file.
    """

    def __init__(self, path: Path) -> None:
        self._where = path.name
        try:
            content = path.read_bytes()
            self._entries = np.load(io.BytesIO(content), allow_pickle=False)
            self.source = str(self._entries[SOURCE])
        except OSError as error:
            raise ClassifierError(f"cannot be read: {error.strerror}", where=path.name) from error
        except (ValueError, KeyError, IndexError, EOFError, zipfile.BadZipFile) as error:
            raise ClassifierError(f"no file of weights: {error}", where=path.name) from error
        self.sha256 = hashlib.sha256(content).hexdigest()

    def __getitem__(self, name: str) -> Float[np.ndarray, "..."]:
        """One weight as the numbers that TensorFlow.js would use, float32.

        Raises:
            ClassifierError: there is no such weight, or it is damaged.
        """
        try:
            stored = self._entries[name]
            if f"{name}:scale" in self._entries:
                stored = stored * float(self._entries[f"{name}:scale"]) + float(self._entries[f"{name}:min"])
        except (ValueError, KeyError, zipfile.BadZipFile) as error:
            raise ClassifierError(f"the weight {name} cannot be read: {error}", where=self._where) from error
        return np.asarray(stored, dtype=np.float32)


def main(arguments: list[str] | None = None) -> None:
    """Convert a model's weights."""
    parser = argparse.ArgumentParser(prog="tfjs_weights", description="Weights of a TensorFlow.js model in one file.")
    parser.add_argument("model", type=Path, help="model.json, with the files that it names beside it")
    parser.add_argument("output", type=Path, help=".npz")
    parser.add_argument("--source", default="", help="where the model comes from, in words")
    options = parser.parse_args(arguments)
    entries = read_tfjs(options.model)
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **entries, **{SOURCE: np.array(options.source)})
    options.output.parent.mkdir(parents=True, exist_ok=True)
    write_whole(options.output, content.getvalue())


if __name__ == "__main__":
    main()
