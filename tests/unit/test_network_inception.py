"""Inception v3: the graph is the network that Keras builds, its weights are read right, its settings fit it."""

from collections.abc import Iterator

import numpy as np
import pytest
import simple_shapes
import torch
from torch.nn import functional

from shapewright.errors import ClassifierError
from shapewright.network import FeatureExtractor, inception, load_backbone
from shapewright.network.backbone import BACKBONES, WEIGHTS_FOLDER, Backbone
from shapewright.network.graphs import features_graph
from shapewright.rendering import random_views, render_images
from shapewright.training import TrainingSettings


class KerasInception:
    """Written after the Keras application, layer by layer, with batch normalisation as layers of their own.

    It draws random weights when it first runs, and keeps them under the names that Keras gives them.
    """

    def __init__(self, seed: int) -> None:
        self.weights: dict[str, np.ndarray] = {}
        self.ends: dict[str, np.ndarray] = {}
        self._rng = np.random.default_rng(seed)
        self._number = 0

    def conv(self, x: torch.Tensor, channels: int, rows: int, columns: int, strides: int = 1, padding="same"):
        self._number += 1
        scale = np.sqrt(2.0 / (x.shape[1] * rows * columns))
        kernel = self._rng.normal(scale=scale, size=(rows, columns, x.shape[1], channels)).astype(np.float32)
        beta, mean = self._rng.normal(scale=0.2, size=(2, channels)).astype(np.float32)
        variance = self._rng.uniform(0.5, 1.5, channels).astype(np.float32)
        norm = f"batch_normalization_{self._number}"
        self.weights |= {
            f"conv2d_{self._number}/kernel": kernel,
            f"{norm}/beta": beta,
            f"{norm}/moving_mean": mean,
            f"{norm}/moving_variance": variance,
        }
        x = functional.conv2d(x, torch.from_numpy(kernel).permute(3, 2, 0, 1), stride=strides, padding=padding)
        moments = torch.from_numpy(mean), torch.from_numpy(variance)
        return functional.relu(functional.batch_norm(x, *moments, bias=torch.from_numpy(beta), eps=1e-3))

    def end(self, name: str, *branches: torch.Tensor) -> torch.Tensor:
        x = torch.cat(branches, dim=1)
        self.ends[name] = x.mean(dim=(2, 3)).numpy()
        return x

    def run(self, images: np.ndarray) -> None:
        conv, valid = self.conv, "valid"
        x = torch.from_numpy(images).permute(0, 3, 1, 2).float() / 127.5 - 1.0
        x = conv(x, 32, 3, 3, strides=2, padding=valid)
        x = conv(x, 32, 3, 3, padding=valid)
        x = conv(x, 64, 3, 3)
        x = functional.max_pool2d(x, 3, 2)
        x = conv(x, 80, 1, 1, padding=valid)
        x = conv(x, 192, 3, 3, padding=valid)
        x = functional.max_pool2d(x, 3, 2)
        for block, pooled in enumerate((32, 64, 64)):
            one = conv(x, 64, 1, 1)
            five = conv(conv(x, 48, 1, 1), 64, 5, 5)
            three = conv(conv(conv(x, 64, 1, 1), 96, 3, 3), 96, 3, 3)
            x = self.end(f"mixed{block}", one, five, three, conv(self.mean(x), pooled, 1, 1))
        three = conv(x, 384, 3, 3, strides=2, padding=valid)
        double = conv(conv(conv(x, 64, 1, 1), 96, 3, 3), 96, 3, 3, strides=2, padding=valid)
        x = self.end("mixed3", three, double, functional.max_pool2d(x, 3, 2))
        for block, inner in enumerate((128, 160, 160, 192), start=4):
            one = conv(x, 192, 1, 1)
            seven = conv(conv(conv(x, inner, 1, 1), inner, 1, 7), 192, 7, 1)
            double = conv(conv(conv(x, inner, 1, 1), inner, 7, 1), inner, 1, 7)
            double = conv(conv(double, inner, 7, 1), 192, 1, 7)
            x = self.end(f"mixed{block}", one, seven, double, conv(self.mean(x), 192, 1, 1))
        three = conv(conv(x, 192, 1, 1), 320, 3, 3, strides=2, padding=valid)
        seven = conv(conv(conv(x, 192, 1, 1), 192, 1, 7), 192, 7, 1)
        seven = conv(seven, 192, 3, 3, strides=2, padding=valid)
        x = self.end("mixed8", three, seven, functional.max_pool2d(x, 3, 2))
        for block in (9, 10):
            one = conv(x, 320, 1, 1)
            three = conv(x, 384, 1, 1)
            three = torch.cat([conv(three, 384, 1, 3), conv(three, 384, 3, 1)], dim=1)
            double = conv(conv(x, 448, 1, 1), 384, 3, 3)
            double = torch.cat([conv(double, 384, 1, 3), conv(double, 384, 3, 1)], dim=1)
            x = self.end(f"mixed{block}", one, three, double, conv(self.mean(x), 192, 1, 1))

    @staticmethod
    def mean(x: torch.Tensor) -> torch.Tensor:
        return functional.avg_pool2d(x, 3, stride=1, padding=1, count_include_pad=False)


@pytest.fixture(scope="module")
def images() -> np.ndarray:
    return np.random.default_rng(3).integers(0, 256, (2, 107, 107, 3), dtype=np.uint8)


@pytest.fixture(scope="module")
def keras(images: np.ndarray) -> KerasInception:
    network = KerasInception(seed=4)
    with torch.no_grad():
        network.run(images)
    return network


def extractor(weights: inception.Weights, last: str) -> FeatureExtractor:
    steps = inception.pretrained_steps(weights, last)
    graph = features_graph(steps, pixel_mean=inception.PIXEL_MEAN, pixel_scale=inception.PIXEL_SCALE)
    width = graph.graph.output[0].type.tensor_type.shape.dim[1].dim_value
    return FeatureExtractor(Backbone("test", "", "", 107, width, "", graph.SerializeToString()))


@pytest.mark.parametrize(("last", "count"), [("mixed0", 256), ("mixed3", 768), ("mixed6", 768), ("mixed10", 2048)])
def test_agrees_with_the_network_of_keras(keras, images, last, count):
    expected = keras.ends[last]
    ours = extractor(keras.weights, last)(images)
    assert ours.shape == expected.shape == (2, count)
    assert expected.std() > 0.1
    assert np.abs(ours - expected).max() < 1e-5 * expected.max()


def test_all_weights_are_read_and_none_beyond_the_last_block(keras):
    class Noting(dict):
        def __getitem__(self, name: str) -> np.ndarray:
            read.add(name)
            return super().__getitem__(name)

    read: set[str] = set()
    inception.pretrained_steps(Noting(keras.weights), inception.LAST)
    assert read == set(keras.weights)
    read.clear()
    inception.pretrained_steps(Noting(keras.weights), inception.MIDDLE)
    assert {int(name.split("/")[0].split("_")[-1]) for name in read} == set(range(1, 61))


def test_weights_of_another_shape_and_unknown_blocks_are_refused(keras):
    with pytest.raises(ClassifierError) as caught:
        inception.pretrained_steps(keras.weights | {"conv2d_5/kernel": np.zeros((3, 3, 80, 8), np.float32)})
    assert caught.value.where == "conv2d_5"
    with pytest.raises(ClassifierError) as caught:
        inception.pretrained_steps(keras.weights | {"batch_normalization_7/beta": np.zeros(1, np.float32)})
    assert caught.value.where == "batch_normalization_7"
    with pytest.raises(ClassifierError, match="mixed11"):
        inception.pretrained_steps(keras.weights, "mixed11")


def sides_to_halve(size: int) -> Iterator[int]:
    """Pixels a side of what each convolution or pooling that halves gets; some valid ones come after it."""
    for cut_off in (2, 2, 0, 0, 0):
        yield size
        size = (size - 3) // 2 + 1 - cut_off


def test_sizes_that_fit_leave_no_pixel_out():
    sizes = BACKBONES["inception_v3"].sizes
    assert sizes.fit(299)
    for size in range(60, 500):
        seen = list(sides_to_halve(size))
        whole = all(side >= 3 and (side - 3) % 2 == 0 for side in seen)
        assert sizes.fit(size) == whole, (size, seen)


def test_the_size_of_pictures_follows_the_backbone():
    assert TrainingSettings().image_size == 224
    assert TrainingSettings(backbone="inception_v3").image_size == 299
    assert TrainingSettings.from_dict({"backbone": "inception_v3", "image_size": 203}).image_size == 203
    settings = TrainingSettings(backbone="inception_v3_last")
    assert TrainingSettings.from_dict(settings.to_dict()) == settings
    with pytest.raises(ClassifierError, match=r"75, 107, 139, …, 299, … for inception_v3") as caught:
        TrainingSettings(backbone="inception_v3", image_size=224)
    assert caught.value.where == "image_size"


def test_missing_weights_name_the_script(tmp_path, repository):
    for name in ("inception_v3", "inception_v3_last"):
        with pytest.raises(ClassifierError, match="scripts/backbone-inception"):
            load_backbone(name, tmp_path)
    assert (repository / "scripts" / "backbone-inception").exists()


def test_random_weights_need_no_file(images, tmp_path):
    backbone = load_backbone("inception_v3_random", tmp_path)
    features = FeatureExtractor(backbone)(images)
    assert (backbone.feature_count, features.shape) == (768, (2, 768))
    assert features.std() > 0.01


def pattern() -> np.ndarray:
    row, column, colour = np.meshgrid(np.arange(299), np.arange(299), np.arange(3), indexing="ij")
    return ((column * column // 37 + row * (7 + 3 * colour) + column * row // 53) % 256).astype(np.uint8)[None]


@pytest.fixture
def real_weights() -> None:
    if not (WEIGHTS_FOLDER / inception.WEIGHTS_FILE).exists():
        pytest.skip("no weights of inception_v3: bash scripts/backbone-inception fetches them")


@pytest.mark.parametrize(
    ("name", "largest"),
    [  # what TensorFlow.js 4.22 computes from the package's own model, preprocessed to -1 … 1
        ("inception_v3", {579: 2.22998, 304: 2.16798, 60: 2.12432, 701: 1.80041, 687: 1.79438, 581: 1.7773}),
        ("inception_v3_last", {292: 0.34587, 242: 0.3192, 2029: 0.27856, 46: 0.24802, 1977: 0.24548, 1995: 0.2384}),
    ],
)
def test_real_weights_give_the_features_of_tensorflow_js(real_weights, name, largest):
    features = FeatureExtractor(load_backbone(name))(pattern())[0]
    assert np.argsort(-features)[:6].tolist() == list(largest)
    assert features[list(largest)] == pytest.approx(list(largest.values()), abs=3e-5)


def test_real_weights_tell_objects_apart_better_than_random_ones(real_weights):
    rotations, scales = random_views(np.random.default_rng(2), 16)
    objects = np.repeat([0, 1], 8)
    meshes = [simple_shapes.goblet(), simple_shapes.stool()]
    pictures = render_images(meshes, None, rotations, scales, objects=objects, size=203)

    def separation(name: str) -> float:
        features = FeatureExtractor(load_backbone(name))(pictures)
        features = features / np.linalg.norm(features, axis=1, keepdims=True)
        first, second = (features[objects == i] for i in (0, 1))
        within = np.sqrt(0.5 * (first.var(axis=0).sum() + second.var(axis=0).sum()))
        return float(np.linalg.norm(first.mean(axis=0) - second.mean(axis=0)) / within)

    assert separation("inception_v3") > 1.5 * separation("inception_v3_random")
