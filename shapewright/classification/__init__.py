"""Classifying meshes by what :mod:`shapewright.training` has learned (paper section 3.2, and beyond).

Names are loaded when first used: :class:`Classifier` needs ONNX Runtime, but neither torch nor onnx.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from shapewright.classification.class_instances import gather_instances, instances_of_each
    from shapewright.classification.classifier import (
        Classification,
        Classifier,
        exemplars_file,
        files_digest,
        load_classifier,
    )
    from shapewright.classification.evidence import UNKNOWN
    from shapewright.classification.exemplars import Exemplars

_HOMES = {
    "Classification": "classifier",
    "Classifier": "classifier",
    "Exemplars": "exemplars",
    "UNKNOWN": "evidence",
    "exemplars_file": "classifier",
    "files_digest": "classifier",
    "gather_instances": "class_instances",
    "instances_of_each": "class_instances",
    "load_classifier": "classifier",
}

__all__ = [
    "UNKNOWN",
    "Classification",
    "Classifier",
    "Exemplars",
    "exemplars_file",
    "files_digest",
    "gather_instances",
    "instances_of_each",
    "load_classifier",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
