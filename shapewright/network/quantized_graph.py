"""The backbone in 8 bits: weights per channel, activations by ranges that were measured once (static QDQ).

ONNX Runtime fuses each ``DequantizeLinear → Conv → QuantizeLinear`` into an integer convolution (Jacob et al. 2018).
Its sums are exact on every processor, see :mod:`shapewright.network.quantized_weights`.
The pictures are bytes already: with the scale 1 / 128 and the zero point 127 they are the first activation as they
are, and nothing is converted.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from onnx import helper

from shapewright.network.efficientnet_lite import Convolution
from shapewright.network.graphs import constant, features_model
from shapewright.network.ports import FEATURES, IMAGES
from shapewright.network.quantized_weights import quantize_weights

Ranges = Mapping[str, tuple[float, float]]
"""Smallest and largest activation of each tensor ``conv<number>`` and ``sum<number>`` of the float graph."""


class _Writer:
    """Collects nodes and constants."""

    def __init__(self) -> None:
        self.nodes: list[Any] = []
        self.constants: list[Any] = []

    def dequantized(self, name: str) -> str:
        """The float value of a quantised tensor; each reader has its own, as the fusion wants it."""
        result = f"{name}_float{len(self.nodes)}"
        inputs = [f"{name}_bytes", f"{name}_scale", f"{name}_zero"]
        self.nodes.append(helper.make_node("DequantizeLinear", inputs, [result]))
        return result

    def activation(self, name: str, low: float, high: float) -> float:
        """Quantise ``name`` to unsigned bytes that reach from ``low`` to ``high``; returns the scale."""
        low, high = min(low, 0.0), max(high, 0.0)
        scale = np.float32((high - low) / 255.0 or 1.0)
        self._scale(name, scale, int(np.clip(np.round(-low / scale), 0, 255)))
        inputs = [name, f"{name}_scale", f"{name}_zero"]
        self.nodes.append(helper.make_node("QuantizeLinear", inputs, [f"{name}_bytes"]))
        return float(scale)

    def pixels(self, mean: float, scale: float) -> float:
        """Take the pictures as they are for quantised activations."""
        self.nodes.append(helper.make_node("Transpose", [IMAGES], ["input_bytes"], perm=[0, 3, 1, 2]))
        self._scale("input", np.float32(1.0 / scale), round(mean))
        return 1.0 / scale

    def convolution(self, number: int, layer: Convolution, current: str, input_scale: float) -> str:
        """Add one convolution without its clipping, which the quantisation of its result does."""
        # a channel of (nearly) nothing but its bias must not push that out of the 32-bit integers
        smallest = np.abs(layer.bias.astype(np.float64)) / (input_scale * 2.0**30)
        weight, scales = quantize_weights(layer.weight, smallest)
        bias = np.round(layer.bias / (input_scale * scales.astype(np.float64))).astype(np.int32)
        for name, values, factors in (
            (f"w{number}", weight, scales),
            (f"b{number}", bias, (input_scale * scales).astype(np.float32)),
        ):
            zero = np.zeros(len(scales), dtype=values.dtype)
            self.constants += [
                constant(values, f"{name}_int"),
                constant(factors, f"{name}_scale"),
                constant(zero, f"{name}_zero"),
            ]
            inputs = [f"{name}_int", f"{name}_scale", f"{name}_zero"]
            self.nodes.append(helper.make_node("DequantizeLinear", inputs, [name], axis=0))
        before, after = layer.padding
        self.nodes.append(
            helper.make_node(
                "Conv",
                [self.dequantized(current), f"w{number}", f"b{number}"],
                [f"conv{number}"],
                kernel_shape=list(layer.weight.shape[2:]),
                strides=[layer.stride] * 2,
                group=layer.groups,
                pads=[before, before, after, after],
            )
        )
        return f"conv{number}"

    def _scale(self, name: str, scale: np.float32, zero: int) -> None:
        self.constants += [constant(scale, f"{name}_scale"), constant(np.uint8(zero), f"{name}_zero")]


def quantized_features_graph(
    layers: Sequence[Convolution], ranges: Ranges, *, pixel_mean: float, pixel_scale: float
) -> Any:
    """As :func:`shapewright.network.graphs.features_graph`, in 8-bit integers up to the mean at the end.

    Returns:
        An ``onnx.ModelProto``.
    """
    writer = _Writer()
    scales = {"input": writer.pixels(pixel_mean, pixel_scale)}
    current, remembered = "input", "input"
    for number, layer in enumerate(layers):
        if layer.opens_block:
            remembered = current
        current = writer.convolution(number, layer, current, scales[current])
        low, high = ranges[current]
        low, high = (max(low, 0.0), min(high, 6.0)) if layer.relu6 else (low, high)
        scales[current] = writer.activation(current, low, high)
        if layer.adds_input:
            summed = f"sum{number}"
            terms = [writer.dequantized(current), writer.dequantized(remembered)]
            writer.nodes.append(helper.make_node("Add", terms, [summed]))
            scales[summed] = writer.activation(summed, *ranges[summed])
            current = summed
    writer.nodes += [
        helper.make_node("GlobalAveragePool", [writer.dequantized(current)], ["pooled"]),
        helper.make_node("Flatten", ["pooled"], [FEATURES], axis=1),
    ]
    return features_model(writer.nodes, writer.constants, len(layers[-1].bias))


def range_names(layers: Sequence[Convolution]) -> list[str]:
    """The tensors of the float graph whose ranges are needed."""
    return [
        name
        for number, layer in enumerate(layers)
        for name in ((f"conv{number}", f"sum{number}") if layer.adds_input else (f"conv{number}",))
    ]
