"""Networks as ONNX graphs, written node by node: no exporter, the same bytes each time."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Any

import numpy as np
import onnx
from jaxtyping import Float
from onnx import TensorProto, helper, numpy_helper

from shapewright.errors import ClassifierError
from shapewright.network.ports import FEATURES, IMAGES, OPEN_PROBABILITIES, PROBABILITIES
from shapewright.network.steps import (
    PICTURES,
    Add,
    Concatenate,
    Convolve,
    Pool,
    Rectify,
    Step,
    output_channels,
)

OPSET = 17
IR_VERSION = 8
"""Old enough for any ONNX Runtime since 1.14."""


def features_graph(steps: Sequence[Step], *, pixel_mean: float, pixel_scale: float) -> Any:
    """``images`` (uint8, NHWC) to ``features``: preprocessing, the network, mean over the picture.

    Returns:
        An ``onnx.ModelProto``.
    """
    constants = [
        constant(np.float32(pixel_mean), "pixel_mean"),
        constant(np.float32(1.0 / pixel_scale), "pixel_factor"),
    ]
    nodes = [
        helper.make_node("Cast", [IMAGES], ["pixels"], to=TensorProto.FLOAT),
        helper.make_node("Sub", ["pixels", "pixel_mean"], ["centred"]),
        helper.make_node("Mul", ["centred", "pixel_factor"], ["scaled"]),
        helper.make_node("Transpose", ["scaled"], [PICTURES], perm=[0, 3, 1, 2]),
    ]
    for step in steps:
        node, own = _node(step)
        nodes.append(node)
        constants += own
    nodes += [
        helper.make_node("GlobalAveragePool", [steps[-1].name], ["pooled"]),
        helper.make_node("Flatten", ["pooled"], [FEATURES], axis=1),
    ]
    return features_model(nodes, constants, output_channels(steps))


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


def _node(step: Step) -> tuple[Any, list[Any]]:
    """The node of one step and the constants that only it reads."""
    own: dict[str, np.ndarray | np.float32] = {}
    attributes: dict[str, Any] = {}
    match step:
        case Convolve():
            kind, reads = "Conv", [step.reads]
            own = {f"{step.name}_weight": step.weight, f"{step.name}_bias": step.bias}
            attributes = {
                "kernel_shape": list(step.weight.shape[2:]),
                "strides": [step.stride] * 2,
                "group": step.groups,
                "pads": list(step.padding),
            }
        case Rectify(highest=None):
            kind, reads = "Relu", [step.reads]
        case Rectify(highest=highest):
            kind, reads = "Clip", [step.reads]
            own = {f"{step.name}_lowest": np.float32(0.0), f"{step.name}_highest": np.float32(highest)}
        case Pool():
            kind, reads = {"max": "MaxPool", "mean": "AveragePool"}[step.kind], [step.reads]
            attributes = {"kernel_shape": [step.side] * 2, "strides": [step.stride] * 2, "pads": list(step.padding)}
        case Add():
            kind, reads = "Add", list(step.reads)
        case Concatenate():
            kind, reads, attributes = "Concat", list(step.reads), {"axis": 1}
    node = helper.make_node(kind, [*reads, *own], [step.name], **attributes)
    return node, [constant(array, name) for name, array in own.items()]


def classifier_graph(
    features: bytes,
    layers: Sequence[tuple[Float[np.ndarray, "_ _"], Float[np.ndarray, " _"]]],
    class_count: int,
    temperature: float,
    *,
    image_size: int,
    metadata: dict[str, str],
) -> Any:
    """A backbone's graph with a head: ``probabilities`` = softmax(values / temperature).

    Each layer of the head, a weight and a bias, gives inputs · Wᵀ + b; negative values of all but the last are set to
    zero. Two more outputs stay beside the probabilities: ``open_probabilities``, where the value of ``none`` (a row
    beyond the classes in the last W, if there is one) has its share, and ``features``, for distances between pictures.

    Returns:
        An ``onnx.ModelProto`` whose input is fixed to the size of the learning images.
    """
    model = onnx.load_model_from_string(features)
    graph = model.graph
    graph.name = "classifier"
    graph.initializer.extend(
        [
            constant(np.float32(temperature), "temperature"),
            constant(np.array([0], dtype=np.int64), "first_class"),
            constant(np.array([class_count], dtype=np.int64), "class_count"),
            constant(np.array([1], dtype=np.int64), "class_axis"),
        ]
    )
    of_classes = ["first_class", "class_count", "class_axis"]
    values = FEATURES
    for number, (weight, bias) in enumerate(layers, start=1):
        names = [f"head{number}_weight", f"head{number}_bias"]
        graph.initializer.extend(
            constant(array.astype(np.float32), name) for array, name in zip((weight, bias), names, strict=True)
        )
        is_last = number == len(layers)
        gives = "logits" if is_last else f"head{number}"
        graph.node.append(helper.make_node("Gemm", [values, *names], [gives], transB=1))
        if not is_last:
            values = f"{gives}_positive"
            graph.node.append(helper.make_node("Relu", [gives], [values]))
    graph.node.extend(
        [
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


@dataclass(frozen=True, eq=False)
class ClassifierParts:
    """What :func:`classifier_graph` put together.

    Args:
        features: the backbone's graph.
        layers: weight and bias of each layer of the head.
        class_count: number of classes.
        temperature: of the class values.
    """

    features: bytes
    layers: tuple[tuple[Float[np.ndarray, "_ _"], Float[np.ndarray, " _"]], ...]
    class_count: int
    temperature: float


def classifier_parts(classifier: bytes) -> ClassifierParts:
    """Take a classifier's graph apart again: the inverse of :func:`classifier_graph`.

    Layers are found by their place in the graph, as files of earlier versions have other names for them.

    Raises:
        ClassifierError: the graph is of another kind.
    """
    try:
        model = onnx.load_model_from_string(classifier)
        nodes = list(model.graph.node)
        constants = {one.name: one for one in model.graph.initializer}
        place = next(number for number, node in enumerate(nodes, start=1) if FEATURES in node.output)
        layers = tuple(
            (numpy_helper.to_array(constants[node.input[1]]), numpy_helper.to_array(constants[node.input[2]]))
            for node in takewhile(lambda node: node.op_type in ("Gemm", "Relu"), nodes[place:])
            if node.op_type == "Gemm"
        )
        read = {name for node in nodes[:place] for name in node.input}
        features = features_model(
            nodes[:place], [one for one in model.graph.initializer if one.name in read], layers[0][0].shape[1]
        )
        return ClassifierParts(
            features=features.SerializeToString(deterministic=True),
            layers=layers,
            class_count=int(numpy_helper.to_array(constants["class_count"])[0]),
            temperature=float(numpy_helper.to_array(constants["temperature"])),
        )
    except (StopIteration, KeyError, IndexError, ValueError) as error:
        raise ClassifierError(f"the graph cannot be taken apart: {error!r}") from error


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
