"""Inception v3 (Szegedy et al. 2016) as data: the network whose last layer the paper retrains (section 3.2).

Layers are those of Keras, and convolutions are numbered as there. Batch normalisation, which has no gain here, is
folded into the weights. Features can be taken after any block ``mixed0`` … ``mixed10``.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from shapewright.errors import ClassifierError
from shapewright.network.steps import PICTURES, Concatenate, Convolve, Pool, Rectify, Step

WEIGHTS_FILE = "inception_v3.npz"
"""Written by :mod:`shapewright.network.tfjs_weights`."""
IMAGE_SIZE = 299
PIXEL_MEAN = PIXEL_SCALE = 127.5
BATCH_NORM_EPSILON = 1e-3
MIDDLE, LAST = "mixed6", "mixed10"
"""Blocks to take features from: 768 and 2048 numbers."""

Folded = tuple[Float[np.ndarray, "O I H W"], Float[np.ndarray, " O"]]
"""Weight and bias of a convolution."""


@runtime_checkable
class Weights(Protocol):
    """Weights by their names in Keras: ``conv2d_1/kernel``, ``batch_normalization_1/beta``, …"""

    def __getitem__(self, name: str, /) -> Float[np.ndarray, "..."]:
        """One weight; kernels are (H, W, I, O)."""
        ...


@dataclass(frozen=True)
class _Conv:
    """A convolution to come: output channels, kernel, stride; valid ones pad nothing."""

    channels: int
    height: int = 1
    width: int = 1
    stride: int = 1
    valid: bool = False


_MEAN = "mean"
"""The mean of 3 × 3 pixels around each."""
_MAX = "max"
"""The largest of 3 × 3 pixels around every second."""

_Link = _Conv | str
_Branch = tuple[_Link | tuple[_Conv, ...], ...]
"""Links one after the other; a tuple of convolutions at the end reads the same and stands side by side."""

_STEM: _Branch = (
    _Conv(32, 3, 3, stride=2, valid=True),
    _Conv(32, 3, 3, valid=True),
    _Conv(64, 3, 3),
    _MAX,
    _Conv(80),
    _Conv(192, 3, 3, valid=True),
    _MAX,
)


def _at_35(pooled: int) -> tuple[_Branch, ...]:
    return (
        (_Conv(64),),
        (_Conv(48), _Conv(64, 5, 5)),
        (_Conv(64), _Conv(96, 3, 3), _Conv(96, 3, 3)),
        (_MEAN, _Conv(pooled)),
    )


def _at_17(inner: int) -> tuple[_Branch, ...]:
    row, column = _Conv(inner, 1, 7), _Conv(inner, 7, 1)
    return (
        (_Conv(192),),
        (_Conv(inner), row, _Conv(192, 7, 1)),
        (_Conv(inner), column, row, column, _Conv(192, 1, 7)),
        (_MEAN, _Conv(192)),
    )


_AT_8: tuple[_Branch, ...] = (
    (_Conv(320),),
    (_Conv(384), (_Conv(384, 1, 3), _Conv(384, 3, 1))),
    (_Conv(448), _Conv(384, 3, 3), (_Conv(384, 1, 3), _Conv(384, 3, 1))),
    (_MEAN, _Conv(192)),
)
_TO_17: tuple[_Branch, ...] = (
    (_Conv(384, 3, 3, stride=2, valid=True),),
    (_Conv(64), _Conv(96, 3, 3), _Conv(96, 3, 3, stride=2, valid=True)),
    (_MAX,),
)
_TO_8: tuple[_Branch, ...] = (
    (_Conv(192), _Conv(320, 3, 3, stride=2, valid=True)),
    (_Conv(192), _Conv(192, 1, 7), _Conv(192, 7, 1), _Conv(192, 3, 3, stride=2, valid=True)),
    (_MAX,),
)
_BLOCKS = (
    *(_at_35(32), _at_35(64), _at_35(64)),
    _TO_17,
    *(_at_17(128), _at_17(160), _at_17(160), _at_17(192)),
    _TO_8,
    *(_AT_8, _AT_8),
)


class _Builder:
    """Collects steps and numbers the convolutions."""

    def __init__(self, folded: Callable[[int, tuple[int, int, int, int]], Folded]) -> None:
        self.steps: list[Step] = []
        self._folded = folded
        self._channels = {PICTURES: 3}
        self._convolutions = self._pools = 0

    def branch(self, links: _Branch, current: str) -> list[str]:
        """Add links one after the other; returns what the last one gives."""
        ends = [current]
        for link in links:
            if isinstance(link, str):
                ends = [self._pool(link, *ends)]
            else:
                forks = link if isinstance(link, tuple) else (link,)
                ends = [self._convolution(fork, *ends) for fork in forks]
        return ends

    def block(self, name: str, branches: tuple[_Branch, ...], current: str) -> None:
        """Add branches side by side and put their channels together."""
        ends = [end for links in branches for end in self.branch(links, current)]
        self._add(Concatenate(name, tuple(ends)), sum(self._channels[end] for end in ends))

    def _convolution(self, link: _Conv, reads: str) -> str:
        self._convolutions += 1
        number = self._convolutions
        weight, bias = self._folded(number, (link.channels, self._channels[reads], link.height, link.width))
        above, left = (0, 0) if link.valid else (link.height // 2, link.width // 2)
        convolve = Convolve(
            f"conv2d_{number}", reads, weight, bias, stride=link.stride, padding=(above, left, above, left)
        )
        self._add(convolve, link.channels)
        return self._add(Rectify(f"activation_{number}", convolve.name), link.channels)

    def _pool(self, kind: str, reads: str) -> str:
        self._pools += 1
        name = f"pool_{self._pools}"
        pool = Pool(name, reads, "max", 3, 2) if kind == _MAX else Pool(name, reads, "mean", 3, 1, (1, 1, 1, 1))
        return self._add(pool, self._channels[reads])

    def _add(self, step: Step, channels: int) -> str:
        self.steps.append(step)
        self._channels[step.name] = channels
        return step.name


def _steps(folded: Callable[[int, tuple[int, int, int, int]], Folded], last: str) -> tuple[Step, ...]:
    builder = _Builder(folded)
    (current,) = builder.branch(_STEM, PICTURES)
    for number, branches in enumerate(_BLOCKS):
        builder.block(f"mixed{number}", branches, current)
        current = f"mixed{number}"
        if current == last:
            return tuple(builder.steps)
    raise ClassifierError(f"there is no block {last!r}", where="last")


def pretrained_steps(weights: Weights, last: str = MIDDLE) -> tuple[Step, ...]:
    """The network up to a block, batch normalisation folded into the weights.

    Raises:
        ClassifierError: a weight is missing or has another shape, or there is no such block.
    """

    def folded(number: int, shape: tuple[int, int, int, int]) -> Folded:
        kernel = weights[f"conv2d_{number}/kernel"].astype(np.float64)
        if kernel.ndim != 4 or kernel.transpose(3, 2, 0, 1).shape != shape:
            raise ClassifierError(f"{kernel.shape} does not fit {shape}", where=f"conv2d_{number}")
        norm = f"batch_normalization_{number}"
        shift, mean, variance = (weights[f"{norm}/{name}"] for name in ("beta", "moving_mean", "moving_variance"))
        if not shift.shape == mean.shape == variance.shape == shape[:1]:
            raise ClassifierError(f"not {shape[0]} numbers each", where=norm)
        factor = 1.0 / np.sqrt(variance.astype(np.float64) + BATCH_NORM_EPSILON)
        weight = kernel.transpose(3, 2, 0, 1) * factor[:, None, None, None]
        return weight.astype(np.float32), (shift - mean * factor).astype(np.float32)

    return _steps(folded, last)


def random_steps(rng: np.random.Generator, last: str = MIDDLE) -> tuple[Step, ...]:
    """The same network with random weights (He et al. 2015): the control that shows what pretraining gives.

    Raises:
        ClassifierError: there is no such block.
    """

    def folded(_: int, shape: tuple[int, int, int, int]) -> Folded:
        weight = rng.normal(scale=np.sqrt(2.0 / np.prod(shape[1:])), size=shape)
        return weight.astype(np.float32), np.zeros(shape[0], dtype=np.float32)

    return _steps(folded, last)
