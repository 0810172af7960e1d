"""Networks as ONNX graphs, written node by node: no exporter, the same bytes each time."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import onnx
from jaxtyping import Float
from onnx import TensorProto, helper, numpy_helper

from shapewright.classification.efficientnet_lite import Convolution
from shapewright.classification.file_format import FEATURES, IMAGES, OPEN_PROBABILITIES, PROBABILITIES

OPSET = 17
IR_VERSION = 8
"""Old enough for any ONNX Runtime since 1.14."""


def features_graph(layers: Sequence[Convolution], *, pixel_mean: float, pixel_scale: float) -> Any:
    """``images`` (uint8, NHWC) to ``features``: preprocessing, convolutions, mean over the picture.

    Returns:
        An ``onnx.ModelProto``.
    """
    constants = [
        constant(np.float32(pixel_mean), "pixel_mean"),
        constant(np.float32(1.0 / pixel_scale), "pixel_factor"),
        constant(np.float32(0.0), "zero"),
        constant(np.float32(6.0), "six"),
    ]
    nodes = [
        helper.make_node("Cast", [IMAGES], ["pixels"], to=TensorProto.FLOAT),
        helper.make_node("Sub", ["pixels", "pixel_mean"], ["centred"]),
        helper.make_node("Mul", ["centred", "pixel_factor"], ["scaled"]),
        helper.make_node("Transpose", ["scaled"], ["input"], perm=[0, 3, 1, 2]),
    ]
    current, remembered = "input", "input"
    for number, layer in enumerate(layers):
        if layer.opens_block:
            remembered = current
        weight, bias, result = f"w{number}", f"b{number}", f"conv{number}"
        constants += [constant(layer.weight, weight), constant(layer.bias, bias)]
        before, after = layer.padding
        nodes.append(
            helper.make_node(
                "Conv",
                [current, weight, bias],
                [result],
                kernel_shape=list(layer.weight.shape[2:]),
                strides=[layer.stride] * 2,
                group=layer.groups,
                pads=[before, before, after, after],
            )
        )
        current = result
        if layer.relu6:
            nodes.append(helper.make_node("Clip", [current, "zero", "six"], [f"relu{number}"]))
            current = f"relu{number}"
        if layer.adds_input:
            nodes.append(helper.make_node("Add", [current, remembered], [f"sum{number}"]))
            current = f"sum{number}"
    nodes += [
        helper.make_node("GlobalAveragePool", [current], ["pooled"]),
        helper.make_node("Flatten", ["pooled"], [FEATURES], axis=1),
    ]
    return features_model(nodes, constants, len(layers[-1].bias))


def features_model(nodes: Sequence[Any], constants: Sequence[Any], feature_count: int) -> Any:
    """The ``onnx.ModelProto`` of a backbone, from its nodes and constants."""
    graph = helper.make_graph(
        nodes,
        "features",
        [helper.make_tensor_value_info(IMAGES, TensorProto.UINT8, ["batch", "height", "width", 3])],
        [helper.make_tensor_value_info(FEATURES, TensorProto.FLOAT, ["batch", feature_count])],
        initializer=constants,
    )
    return _model(graph)


def classifier_graph(
    features: bytes,
    weight: Float[np.ndarray, "K D"],
    bias: Float[np.ndarray, " K"],
    class_count: int,
    temperature: float,
    *,
    image_size: int,
    metadata: dict[str, str],
) -> Any:
    """A backbone's graph with a last layer: ``probabilities`` = softmax((features · Wᵀ + b) / temperature).

    Two more outputs stay beside them: ``open_probabilities``, where the value of ``none`` (a row of W beyond the
    classes, if there is one) has its share, and ``features``, for distances between pictures.

    Returns:
        An ``onnx.ModelProto`` whose input is fixed to the size of the learning images.
    """
    model = onnx.load_model_from_string(features)
    graph = model.graph
    graph.name = "classifier"
    graph.initializer.extend(
        [
            constant(weight.astype(np.float32), "class_weight"),
            constant(bias.astype(np.float32), "class_bias"),
            constant(np.float32(temperature), "temperature"),
            constant(np.array([0], dtype=np.int64), "first_class"),
            constant(np.array([class_count], dtype=np.int64), "class_count"),
            constant(np.array([1], dtype=np.int64), "class_axis"),
        ]
    )
    of_classes = ["first_class", "class_count", "class_axis"]
    graph.node.extend(
        [
            helper.make_node("Gemm", [FEATURES, "class_weight", "class_bias"], ["logits"], transB=1),
            helper.make_node("Div", ["logits", "temperature"], ["calibrated_logits"]),
            helper.make_node("Slice", ["calibrated_logits", *of_classes], ["class_logits"]),
            helper.make_node("Softmax", ["class_logits"], [PROBABILITIES], axis=1),
            helper.make_node("Softmax", ["calibrated_logits"], ["with_none"], axis=1),
            helper.make_node("Slice", ["with_none", *of_classes], [OPEN_PROBABILITIES]),
        ]
    )
    del graph.input[:]
    graph.input.append(helper.make_tensor_value_info(IMAGES, TensorProto.UINT8, ["batch", image_size, image_size, 3]))
    for place, name in enumerate((PROBABILITIES, OPEN_PROBABILITIES)):
        graph.output.insert(place, helper.make_tensor_value_info(name, TensorProto.FLOAT, ["batch", class_count]))
    helper.set_model_props(model, metadata)
    onnx.checker.check_model(model)
    return model


def constant(array: np.ndarray | np.number[Any], name: str) -> Any:
    """A named constant of a graph."""
    return numpy_helper.from_array(np.asarray(array), name)


def _model(graph: Any) -> Any:
    model = helper.make_model(
        graph,
        opset_imports=[helper.make_opsetid("", OPSET)],
        producer_name="shapewright",
        ir_version=IR_VERSION,
    )
    onnx.checker.check_model(model)
    return model
