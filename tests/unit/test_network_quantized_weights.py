"""Weights in 8 bits: no sum of two products can saturate, and rounding keeps what a kernel does to an even surface."""

import hypothesis.extra.numpy as arrays
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from shapewright.network.quantized_weights import LARGEST_PAIR, quantize_weights

KERNELS = st.tuples(st.integers(1, 4), st.integers(1, 8), st.integers(1, 5), st.integers(1, 5)).flatmap(
    lambda shape: arrays.arrays(np.float32, shape, elements=st.floats(-8, 8, width=32))
)


def test_two_products_of_the_largest_bytes_just_fit_into_16_bits() -> None:
    assert 255 * LARGEST_PAIR <= 2**15 - 1 < 255 * (LARGEST_PAIR + 1)
    assert -255 * LARGEST_PAIR >= -(2**15)


@given(KERNELS)
def test_no_two_weights_of_a_kernel_saturate_and_none_is_far_off(weight: np.ndarray) -> None:
    integers, scales = quantize_weights(weight, np.full(len(weight), 1e-6))
    kernels = integers.reshape(len(weight), -1).astype(int)
    for kernel in (kernels, -kernels):
        assert np.sort(np.maximum(kernel, 0), axis=1)[:, -2:].sum(axis=1).max() <= LARGEST_PAIR
    ideal = weight.reshape(len(weight), -1) / scales[:, None].astype(np.float64)
    assert np.abs(kernels - ideal).max() < 1.0 + 1e-9
    assert np.abs((kernels - ideal).sum(axis=1)).max() <= 0.5 + 1e-9


def test_the_range_is_used_and_most_weights_are_rounded_to_the_nearest() -> None:
    weight = np.random.default_rng(0).normal(size=(64, 32, 3, 3)).astype(np.float32)
    integers, scales = quantize_weights(weight, np.zeros(64))
    kernels = np.sort(integers.reshape(64, -1).astype(int), axis=1)
    widest = np.maximum(kernels[:, -2:].sum(axis=1), -kernels[:, :2].sum(axis=1))
    assert widest.min() >= LARGEST_PAIR - 3
    nearest = np.round(weight / scales[:, None, None, None])
    assert np.mean(integers == nearest) > 0.97


def test_a_scale_is_no_smaller_than_asked_and_a_channel_of_nothing_is_nothing() -> None:
    weight = np.zeros((2, 1, 3, 3), dtype=np.float32)
    weight[0] = 1e-3
    integers, scales = quantize_weights(weight, np.array([0.5, 0.0]))
    assert not integers.any()
    assert scales[0] == 0.5
    assert scales[1] > 0
