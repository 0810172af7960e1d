"""Graphs in ONNX Runtime."""

from typing import Any

import onnxruntime

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
