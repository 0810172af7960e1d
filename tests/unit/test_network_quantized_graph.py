"""The backbone in 8 bits says nearly what the one in floating point says, and takes bytes as they are."""

import json
from importlib import resources

import numpy as np
import onnx
import onnxruntime
import pytest
import simple_shapes

from shapewright.classification.look import Look
from shapewright.classification.pictures import draw
from shapewright.network import FeatureExtractor, load_backbone
from shapewright.network.backbone import RANGES_FILE, Backbone, efficientnet_lite0_layers
from shapewright.network.quantized_graph import quantized_features_graph, range_names
from shapewright.rendering import random_views
from shapewright.training import TrainingSettings
from shapewright.training.calibration import Calibration
from shapewright.training.export import classifier_metadata, export_classifier
from shapewright.training.head import Head, Layer


@pytest.fixture(scope="module")
def ranges() -> dict[str, tuple[float, float]]:
    text = resources.files("shapewright.network").joinpath(RANGES_FILE).read_text(encoding="utf-8")
    return {name: (low, high) for name, (low, high) in json.loads(text).items()}


def test_both_graphs_agree_on_drawn_pictures() -> None:
    rotations, scales = random_views(np.random.default_rng(0), 12, scale_range=(0.7, 1.0))
    meshes = [simple_shapes.goblet(), simple_shapes.stool(), simple_shapes.crossing_sheets()]
    look = Look("splats", 224, "sphere", 1.0, (0.7, 1.0))
    pictures = draw(meshes, rotations, scales, look, shown=np.repeat(np.arange(3), 4))
    exact = FeatureExtractor(load_backbone("efficientnet_lite0"))(pictures)
    whole = FeatureExtractor(load_backbone("efficientnet_lite0_int8"))(pictures)
    alike = [np.corrcoef(one, other)[0, 1] for one, other in zip(exact, whole, strict=True)]
    assert np.mean(alike) > 0.975
    assert min(alike) > 0.92, "bare sheets are the worst"
    others = [np.corrcoef(one, other)[0, 1] for one, other in zip(exact, np.roll(whole, 4, axis=0), strict=True)]
    assert max(others) < min(alike), "another object is never as near"
    middle = exact.mean(axis=0)
    assert np.corrcoef((exact - middle).ravel(), (whole - middle).ravel())[0, 1] > 0.95, (
        "what tells pictures apart, too"
    )


def sums_that_could_saturate(model: onnx.ModelProto) -> list[str]:
    """Products of bytes in which two that stand side by side may not fit into 16 bits, whatever the kernel's order.

    x86 processors without VNNI add two products of an unsigned and a signed byte that way. So this says on any machine
    whether a plain session is right on all.
    """
    constants = {tensor.name: onnx.numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    made = {name: node for node in model.graph.node for name in node.output}
    products, found = ("Conv", "Gemm", "MatMul"), []
    moves = ("DequantizeLinear", "QuantizeLinear", "Transpose", "Add", "GlobalAveragePool")
    for node in model.graph.node:
        sources = [made.get(name) for name in node.input]
        if node.op_type not in products or sources[1] is None or sources[1].op_type != "DequantizeLinear":
            in_bytes = any(source is not None and source.op_type == "DequantizeLinear" for source in sources)
            assert not in_bytes or node.op_type in moves, f"{node.op_type} is not known here"
            continue
        assert sources[0].op_type == "DequantizeLinear", "activations are bytes as well"
        activation = constants[sources[0].input[2]]
        weight, zero = (constants[sources[1].input[place]] for place in (0, 2))
        assert (activation.dtype, weight.dtype, np.any(zero)) == (np.uint8, np.int8, False)
        kernels = np.sort(weight.reshape(len(weight), -1).astype(np.int64), axis=1)
        highest = 255 * np.maximum(kernels[:, -2:], 0).sum(axis=1).max()
        lowest = 255 * np.minimum(kernels[:, :2], 0).sum(axis=1).min()
        if highest > np.iinfo(np.int16).max or lowest < np.iinfo(np.int16).min:
            found.append(node.name or node.output[0])
    return found


def exported(backbone: Backbone) -> onnx.ModelProto:
    """A classifier's file on this backbone."""
    weight = np.random.default_rng(0).normal(size=(3, backbone.feature_count)).astype(np.float32)
    head = Head(layers=(Layer(weight, weight[:, 0]),), class_count=3, temperature=1.0, curves={}, best_epoch=0)
    calibration = Calibration(1.0, None, None, None, {})
    metadata = classifier_metadata(("a", "b", "c"), (), backbone, TrainingSettings(), {}, calibration)
    return onnx.load_model_from_string(export_classifier(backbone, head, metadata))


def test_no_sum_of_an_exported_file_can_saturate_on_any_processor() -> None:
    model = exported(load_backbone())
    assert sum(node.op_type == "Conv" for node in model.graph.node) == 49
    assert sums_that_could_saturate(model) == []


def test_a_sum_that_could_saturate_is_found_whatever_machine_this_is() -> None:
    """Two weights of 127 that meet two activations of 255: wrong where 16 bits are all there is."""
    model = exported(load_backbone())
    place = next(n for n, tensor in enumerate(model.graph.initializer) if tensor.name == "w2_int")
    weight = onnx.numpy_helper.to_array(model.graph.initializer[place]).copy()
    weight[3, :2] = 127
    model.graph.initializer[place].CopyFrom(onnx.numpy_helper.from_array(weight, "w2_int"))
    assert sums_that_could_saturate(model) == ["conv2"]
    weight[3, :2] = -127
    model.graph.initializer[place].CopyFrom(onnx.numpy_helper.from_array(weight, "w2_int"))
    assert sums_that_could_saturate(model) == ["conv2"]


def test_a_plain_session_counts_as_ours() -> None:
    pictures = np.random.default_rng(0).integers(0, 256, (2, 224, 224, 3), dtype=np.uint8)
    backbone = load_backbone()
    plain = onnxruntime.InferenceSession(backbone.graph, providers=["CPUExecutionProvider"])
    (expected,) = plain.run(["features"], {"images": pictures})
    np.testing.assert_array_equal(FeatureExtractor(backbone)(pictures), expected)


def test_pictures_are_not_converted() -> None:
    graph = onnx.load_model_from_string(load_backbone("efficientnet_lite0_int8").graph).graph
    assert graph.input[0].type.tensor_type.elem_type == onnx.TensorProto.UINT8
    assert "Cast" not in {node.op_type for node in graph.node}
    assert {node.op_type for node in graph.node if graph.input[0].name in node.input} == {"Transpose"}
    convolutions = [node for node in graph.node if node.op_type == "Conv"]
    made = {node.output[0]: node.op_type for node in graph.node}
    assert all(made[name] == "DequantizeLinear" for node in convolutions for name in node.input)


def test_the_ranges_are_those_of_the_float_graph(ranges) -> None:
    layers, _ = efficientnet_lite0_layers()
    assert list(ranges) == range_names(layers)
    made = {
        name
        for node in onnx.load_model_from_string(load_backbone("efficientnet_lite0").graph).graph.node
        for name in node.output
    }
    assert set(ranges) <= made
    assert all(low < high for low, high in ranges.values())


def test_every_constant_is_finite_and_the_graph_repeats(ranges) -> None:
    layers, _ = efficientnet_lite0_layers()
    first, again = (
        quantized_features_graph(layers, ranges, pixel_mean=127.0, pixel_scale=128.0).SerializeToString(
            deterministic=True
        )
        for _ in range(2)
    )
    assert first == again
    for tensor in onnx.load_model_from_string(first).graph.initializer:
        values = onnx.numpy_helper.to_array(tensor)
        assert np.isfinite(values.astype(np.float64)).all()
        if tensor.name.endswith("_scale"):
            assert np.all(values > 0)
    assert len(first) < 0.35 * len(load_backbone("efficientnet_lite0").graph)
