"""Weights as 8-bit integers that give the same sums on every processor.

x86 processors without VNNI instructions multiply unsigned bytes (activations) by signed ones (weights) with
``VPMADDUBSW``, which adds two products in 16 bits and saturates. Which two depends on the kernel that ONNX Runtime
chooses. So the scale of a kernel keeps every pair of its weights small enough: whatever the activations and the order,
two products fit into 16 bits.

A kernel also keeps its sum. Rounding each weight to the nearest integer shifts that sum, and a shifted sum changes
every pixel of an even surface in the same direction; layer by layer this costs more than the rounding itself.
"""

from typing import Final

import numpy as np
from jaxtyping import Float, Int8

LARGEST_PAIR: Final = (2**15 - 1) // 255
"""What two weights of a kernel may add up to, so that two products with activations of 255 fit into 16 bits: 128."""


def quantize_weights(
    weight: Float[np.ndarray, "O I H W"], smallest_scale: Float[np.ndarray, " O"]
) -> tuple[Int8[np.ndarray, "O I H W"], Float[np.ndarray, " O"]]:
    """Return integers and the scale of each output channel; integer · scale is less than one scale off the weight.

    Args:
        weight: kernels in floating point.
        smallest_scale: lower limits of the scales.
    """
    kernels = weight.reshape(len(weight), -1).astype(np.float64)
    # Rounding moves each of two weights by less than 1, so what is 1.5 below 128.5 ends at 128 or less.
    largest = np.maximum(_largest_pair(kernels), _largest_pair(-kernels))
    scales = np.where(largest > 0, largest / (LARGEST_PAIR - 1.5), 1.0)
    scales = np.maximum(scales, smallest_scale).astype(np.float32)
    rounded = _rounded_with_sums(kernels / scales[:, None])
    return rounded.astype(np.int8).reshape(weight.shape), scales


def _largest_pair(kernels: Float[np.ndarray, "O N"]) -> Float[np.ndarray, " O"]:
    """The largest sum of two weights of each kernel, or its largest weight, or 0."""
    return np.sort(np.maximum(kernels, 0.0), axis=1)[:, -2:].sum(axis=1)


def _rounded_with_sums(kernels: Float[np.ndarray, "O N"]) -> Float[np.ndarray, "O N"]:
    """Round down or up, mostly to the nearest integer, so that the sum of each row changes by 0.5 at most."""
    rounded = np.round(kernels)
    error = rounded - kernels
    excess = np.round(error.sum(axis=1, keepdims=True))
    direction = np.sign(excess)
    order = np.argsort(-error * direction, axis=1, kind="stable")
    turned = np.empty_like(rounded)
    np.put_along_axis(turned, order, np.arange(kernels.shape[1]) < np.abs(excess), axis=1)
    return rounded - direction * turned
