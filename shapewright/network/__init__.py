"""Frozen networks that turn pictures into features: backbones as ONNX graphs, and what runs them (paper section 3.2).

Names are loaded when first used: :class:`FeatureExtractor` needs ONNX Runtime, a backbone's weights need torch.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from shapewright.network.backbone import BACKBONES, Backbone, load_backbone
    from shapewright.network.features import FeatureExtractor

_HOMES = {
    "BACKBONES": "backbone",
    "Backbone": "backbone",
    "FeatureExtractor": "features",
    "load_backbone": "backbone",
}

__all__ = ["BACKBONES", "Backbone", "FeatureExtractor", "load_backbone"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
