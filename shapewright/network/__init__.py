"""Frozen networks that turn pictures into features: backbones as ONNX graphs, and what runs them (paper section 3.2).

Names are loaded when first used: :class:`FeatureExtractor` needs ONNX Runtime, a backbone's weights need torch.
"""

from typing import TYPE_CHECKING

from shapewright.lazy_names import lazy_names

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

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
