"""EfficientNet-Lite0 as a chain of convolutions: the one description that ONNX and torch both follow.

Architecture after Tan and Le 2019 and the Lite variants of the TensorFlow model garden: no squeeze and
excitation, ReLU6, stem and last convolution of fixed width. Batch normalisation is folded into the weights.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from shapewright.errors import ClassifierError
from shapewright.network.steps import PICTURES, Add, Convolve, Rectify, Step

IMAGE_SIZE = 224
FEATURE_COUNT = 1280
PIXEL_MEAN = 127.0
PIXEL_SCALE = 128.0
BATCH_NORM_EPSILON = 1e-3

# repeats, kernel, stride of the first, expansion, output channels
_STAGES = (
    (1, 3, 1, 1, 16),
    (2, 3, 2, 6, 24),
    (2, 5, 2, 6, 40),
    (3, 3, 2, 6, 80),
    (3, 5, 1, 6, 112),
    (4, 5, 2, 6, 192),
    (1, 3, 1, 6, 320),
)
_STEM_CHANNELS = 32


@dataclass(frozen=True, eq=False)
class Convolution:
    """One step of the network.

    Args:
        weight: kernels, batch normalisation folded in.
        bias: one number an output channel.
        stride: 1 or 2.
        groups: 1, or the number of channels for a depthwise convolution.
        relu6: whether the result is clipped to 0..6.
        opens_block: the input is remembered for ``adds_input``.
        adds_input: the remembered input is added to the result.
    """

    weight: Float[np.ndarray, "O I K K"]
    bias: Float[np.ndarray, " O"]
    stride: int
    groups: int
    relu6: bool
    opens_block: bool = False
    adds_input: bool = False

    @property
    def padding(self) -> tuple[int, int]:
        """Pixels before and after, as TensorFlow's SAME does it for even sizes: strides pad one side more."""
        total = self.weight.shape[-1] - self.stride
        return total // 2, total - total // 2


@dataclass(frozen=True)
class _Plan:
    kernel: str
    norm: str
    shape: tuple[int, int, int, int]
    stride: int
    groups: int
    relu6: bool
    opens_block: bool = False
    adds_input: bool = False


def _plan() -> list[_Plan]:
    steps = [_Plan("_conv_stem", "_bn0", (_STEM_CHANNELS, 3, 3, 3), 2, 1, relu6=True)]
    channels, number = _STEM_CHANNELS, 0
    for repeats, kernel, first_stride, expansion, width in _STAGES:
        for repeat in range(repeats):
            stride = first_stride if repeat == 0 else 1
            block, inner = f"_blocks.{number}.", channels * expansion
            if expansion > 1:
                shape = (inner, channels, 1, 1)
                steps.append(_Plan(f"{block}_expand_conv", f"{block}_bn0", shape, 1, 1, True, opens_block=True))
            shape = (inner, 1, kernel, kernel)
            opens = expansion == 1
            steps.append(_Plan(f"{block}_depthwise_conv", f"{block}_bn1", shape, stride, inner, True, opens))
            adds = stride == 1 and channels == width
            shape = (width, inner, 1, 1)
            steps.append(_Plan(f"{block}_project_conv", f"{block}_bn2", shape, 1, 1, False, False, adds))
            channels, number = width, number + 1
    steps.append(_Plan("_conv_head", "_bn1", (FEATURE_COUNT, channels, 1, 1), 1, 1, relu6=True))
    return steps


def layers_from_state(state: Mapping[str, np.ndarray]) -> tuple[Convolution, ...]:
    """Read the package's state dict and fold batch normalisation into the convolutions.

    Raises:
        ClassifierError: a weight is missing or has another shape.
    """
    layers = []
    for step in _plan():
        try:
            weight = state[f"{step.kernel}.weight"].astype(np.float64)
            gain, shift, mean, variance = (
                state[f"{step.norm}.{name}"].astype(np.float64)
                for name in ("weight", "bias", "running_mean", "running_var")
            )
        except KeyError as error:
            raise ClassifierError(f"the backbone's weights lack {error}") from error
        if weight.shape != step.shape:
            raise ClassifierError(f"{weight.shape} instead of {step.shape}", where=step.kernel)
        factor = gain / np.sqrt(variance + BATCH_NORM_EPSILON)
        layers.append(_layer(step, weight * factor[:, None, None, None], shift - mean * factor))
    return tuple(layers)


def network_steps(layers: Sequence[Convolution]) -> tuple[Step, ...]:
    """The chain as steps: ``conv<number>``, then ``relu<number>`` or ``sum<number>`` where there is one."""
    steps: list[Step] = []
    current = remembered = PICTURES
    for number, layer in enumerate(layers):
        if layer.opens_block:
            remembered = current
        before, after = layer.padding
        padding = (before, before, after, after)
        steps.append(Convolve(f"conv{number}", current, layer.weight, layer.bias, layer.stride, layer.groups, padding))
        if layer.relu6:
            steps.append(Rectify(f"relu{number}", steps[-1].name, highest=6.0))
        if layer.adds_input:
            steps.append(Add(f"sum{number}", (steps[-1].name, remembered)))
        current = steps[-1].name
    return tuple(steps)


def random_layers(rng: np.random.Generator) -> tuple[Convolution, ...]:
    """The same network with random weights (He et al. 2015): the control that shows what pretraining gives."""
    return tuple(
        _layer(
            step,
            rng.normal(scale=np.sqrt(2.0 / np.prod(step.shape[1:])), size=step.shape),
            np.zeros(step.shape[0]),
        )
        for step in _plan()
    )


def _layer(step: _Plan, weight: np.ndarray, bias: np.ndarray) -> Convolution:
    return Convolution(
        weight=weight.astype(np.float32),
        bias=bias.astype(np.float32),
        stride=step.stride,
        groups=step.groups,
        relu6=step.relu6,
        opens_block=step.opens_block,
        adds_input=step.adds_input,
    )
