"""The backbone: ONNX Runtime and torch agree, its weights are really pretrained."""

import numpy as np
import onnx
import pytest
import simple_shapes
import torch

from shapewright.errors import ClassifierError
from shapewright.network import BACKBONES, FeatureExtractor, load_backbone
from shapewright.network.backbone import WEIGHTS_FOLDER, efficientnet_lite0_layers
from shapewright.network.efficientnet_lite import layers_from_state
from shapewright.network.torch_network import TorchBackbone
from shapewright.rendering import random_views, render_images

LITE0 = ("efficientnet_lite0", "efficientnet_lite0_int8", "efficientnet_lite0_random")


@pytest.fixture(scope="module")
def pictures() -> np.ndarray:
    rotations, scales = random_views(np.random.default_rng(0), 6)
    meshes = [simple_shapes.goblet(), simple_shapes.stool(), simple_shapes.crossing_sheets()] * 2
    drawn = render_images(meshes, None, rotations, scales)
    noise = np.random.default_rng(1).integers(0, 256, (2, 224, 224, 3), dtype=np.uint8)
    return np.concatenate([drawn, noise])


def test_torch_and_onnxruntime_agree(pictures):
    layers, _ = efficientnet_lite0_layers()
    with torch.no_grad():
        expected = TorchBackbone(layers)(torch.from_numpy(pictures)).numpy()
    ours = FeatureExtractor(load_backbone("efficientnet_lite0"))(pictures)
    assert ours.shape == (8, 1280)
    assert expected.std() > 0.1
    assert np.abs(ours - expected).max() < 2e-4


def test_batches_do_not_change_features(pictures):
    for name in ("efficientnet_lite0", "efficientnet_lite0_int8"):
        whole = FeatureExtractor(load_backbone(name))(pictures)
        pieces = FeatureExtractor(load_backbone(name), batch_size=3, threads=1)(pictures)
        assert np.abs(whole - pieces).max() < 1e-4


def test_features_follow_the_object_not_the_view():
    # Two views of one object are closer than views of two objects: what pretraining brings.
    rotations, scales = random_views(np.random.default_rng(2), 40)
    objects = np.repeat([0, 1], 20)
    meshes = [simple_shapes.goblet(), simple_shapes.stool()]
    images = render_images(meshes, None, rotations, scales, objects=objects)

    def separation(name: str) -> float:
        features = FeatureExtractor(load_backbone(name))(images)
        features = features / np.linalg.norm(features, axis=1, keepdims=True)
        apart = np.linalg.norm(features[objects == 0].mean(axis=0) - features[objects == 1].mean(axis=0))
        within = np.mean([features[objects == i].std(axis=0).mean() for i in (0, 1)]) * np.sqrt(1280)
        return float(apart / within)

    assert separation("efficientnet_lite0_int8") > 2 * separation("efficientnet_lite0_random")


@pytest.mark.parametrize("name", ["efficientnet_lite0", "efficientnet_lite0_int8"])
def test_the_graph_takes_bytes_and_is_the_same_each_time(name):
    backbone = load_backbone(name)
    model = onnx.load_model_from_string(backbone.graph)
    assert model.graph.input[0].type.tensor_type.elem_type == onnx.TensorProto.UINT8
    assert len(backbone.weights_sha256) == 64
    assert backbone.weights_sha256.startswith("57934424"), "the digits in the weights' file name"
    assert BACKBONES[name].make(WEIGHTS_FOLDER).graph == backbone.graph
    assert load_backbone(name) is backbone


def test_the_key_names_the_graph():
    keys = {load_backbone(name).key for name in LITE0}
    assert len(keys) == len(LITE0)
    assert load_backbone().key == load_backbone("efficientnet_lite0_int8").key
    assert load_backbone().key.startswith("efficientnet_lite0_int8-")


def test_unknown_and_damaged_backbones_are_refused():
    with pytest.raises(ClassifierError, match="unknown backbone") as caught:
        load_backbone("resnet_9000")
    assert caught.value.where == "backbone"
    with pytest.raises(ClassifierError, match="lack"):
        layers_from_state({"_conv_stem.weight": np.zeros((32, 3, 3, 3))})
    norm = {f"_bn0.{name}": np.ones(32) for name in ("weight", "bias", "running_mean", "running_var")}
    with pytest.raises(ClassifierError) as caught:
        layers_from_state({"_conv_stem.weight": np.zeros((8, 3, 3, 3)), **norm})
    assert caught.value.where == "_conv_stem"
