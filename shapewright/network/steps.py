"""A network as a list of named steps: the one description that whoever writes or runs a graph follows.

A step reads the results of steps before it by their names; the last one's result is the network's.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

PICTURES = "input"
"""Name of what the first step reads: preprocessed pictures of 3 channels."""

Padding = tuple[int, int, int, int]
"""Pixels of nothing above, on the left, below, on the right."""


@dataclass(frozen=True, eq=False)
class Convolve:
    """A convolution.

    Args:
        name: of the result.
        reads: what is convolved.
        weight: kernels, batch normalisation folded in.
        bias: one number an output channel.
        stride: in both directions.
        groups: 1, or the number of channels for a depthwise convolution.
        padding: zeros around.
    """

    name: str
    reads: str
    weight: Float[np.ndarray, "O I H W"]
    bias: Float[np.ndarray, " O"]
    stride: int = 1
    groups: int = 1
    padding: Padding = (0, 0, 0, 0)


@dataclass(frozen=True)
class Rectify:
    """Negative numbers become 0, those above ``highest`` become that."""

    name: str
    reads: str
    highest: float | None = None


@dataclass(frozen=True)
class Pool:
    """The largest or the mean number of each square window; what is padded does not count."""

    name: str
    reads: str
    kind: Literal["max", "mean"]
    side: int
    stride: int
    padding: Padding = (0, 0, 0, 0)


@dataclass(frozen=True)
class Add:
    """The sum of results of one shape."""

    name: str
    reads: tuple[str, str]


@dataclass(frozen=True)
class Concatenate:
    """The channels of several results, one after the other."""

    name: str
    reads: tuple[str, ...]


Step = Convolve | Rectify | Pool | Add | Concatenate


def output_channels(steps: Sequence[Step]) -> int:
    """Number of channels of the last step's result."""
    channels = {PICTURES: 3}
    for step in steps:
        match step:
            case Convolve():
                channels[step.name] = len(step.bias)
            case Concatenate():
                channels[step.name] = sum(channels[name] for name in step.reads)
            case Add():
                channels[step.name] = channels[step.reads[0]]
            case _:
                channels[step.name] = channels[step.reads]
    return channels[steps[-1].name]
