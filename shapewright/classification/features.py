"""Features of pictures with ONNX Runtime, batch by batch."""

from typing import Any

import numpy as np
import onnxruntime
from jaxtyping import Float, UInt8

from shapewright.classification.backbone import Backbone
from shapewright.classification.file_format import FEATURES, IMAGES

BATCH_SIZE = 10
"""The views of one object. Larger batches were slower and took more memory: 8, 16 and 32 pictures needed 4.8, 5.0
and 5.8 ms of processor each."""
THREADS = 2


def make_session(graph: bytes, *, threads: int = THREADS) -> Any:
    """An ``onnxruntime.InferenceSession`` on the CPU that keeps quiet.

    Raises:
        Exception: whatever ONNX Runtime raises for a graph it cannot load.
    """
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    options.inter_op_num_threads = 1
    options.log_severity_level = 4
    # Threads that spin between batches would take the cores from the renderer.
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    return onnxruntime.InferenceSession(graph, options, providers=["CPUExecutionProvider"])


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
