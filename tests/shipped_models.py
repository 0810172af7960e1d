"""Shipped models, compiled once for all tests of a process."""

from functools import cache

from models_store.library.shipped import load_shipped
from shapewright.modeling import CompiledModel, compile_model


@cache
def compiled_shipped(name: str) -> CompiledModel:
    """Return a shipped model, compiled; tests leave it as it is."""
    return compile_model(load_shipped(name))
