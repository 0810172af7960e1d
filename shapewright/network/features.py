"""Features of pictures with ONNX Runtime, batch by batch."""

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.network.backbone import Backbone
from shapewright.network.ports import FEATURES, IMAGES
from shapewright.network.session import BATCH_SIZE, THREADS, make_session


class FeatureExtractor:
    """Runs a backbone over any number of pictures in batches, so memory stays bounded.

    Args:
        backbone: which network.
        threads: threads of ONNX Runtime.
        batch_size: pictures at once.
    """

    def __init__(self, backbone: Backbone, *, threads: int = THREADS, batch_size: int = BATCH_SIZE) -> None:
        self.backbone = backbone
        self.batch_size = batch_size
        self._session = make_session(backbone.graph, threads=threads)

    def __call__(self, images: UInt8[np.ndarray, "N H W 3"]) -> Float[np.ndarray, "N D"]:
        """Features (N, D), float32, of pictures (N, H, W, 3)."""
        out = np.empty((len(images), self.backbone.feature_count), dtype=np.float32)
        for start in range(0, len(images), self.batch_size):
            batch = images[start : start + self.batch_size]
            out[start : start + len(batch)] = self._session.run([FEATURES], {IMAGES: batch})[0]
        return out
