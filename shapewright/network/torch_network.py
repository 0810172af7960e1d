"""The backbone in plain torch: what the ONNX graph is checked against, and where fine-tuning would begin."""

from collections.abc import Sequence

import torch
from torch import nn
from torch.nn import functional

from shapewright.network import efficientnet_lite
from shapewright.network.efficientnet_lite import Convolution


class TorchBackbone(nn.Module):
    """Features of pictures by a list of convolutions.

    Args:
        layers: from :mod:`shapewright.network.efficientnet_lite`.
    """

    def __init__(self, layers: Sequence[Convolution]) -> None:
        super().__init__()
        self.layers = tuple(layers)
        self.weights = nn.ParameterList(torch.from_numpy(layer.weight) for layer in layers)
        self.biases = nn.ParameterList(torch.from_numpy(layer.bias) for layer in layers)

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        """Features (N, D) of pictures (N, H, W, 3), uint8."""
        x = (images.float() - efficientnet_lite.PIXEL_MEAN) / efficientnet_lite.PIXEL_SCALE
        x = x.permute(0, 3, 1, 2)
        remembered = x
        for layer, weight, bias in zip(self.layers, self.weights, self.biases, strict=True):
            if layer.opens_block:
                remembered = x
            x = functional.pad(x, [*layer.padding, *layer.padding])
            x = functional.conv2d(x, weight, bias, stride=layer.stride, groups=layer.groups)
            if layer.relu6:
                x = functional.relu6(x)
            if layer.adds_input:
                x = x + remembered
        return x.mean(dim=(2, 3))
