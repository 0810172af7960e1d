"""Classifying meshes by what :mod:`shapewright.training` has learned (paper section 3.2, and beyond).

Names are loaded when first used: :class:`Classifier` needs ONNX Runtime, but neither torch nor onnx.
"""

from typing import TYPE_CHECKING

from shapewright.lazy_names import lazy_names

if TYPE_CHECKING:
    from shapewright.classification.answer import Classification
    from shapewright.classification.class_instances import gather_instances, instances_of_each
    from shapewright.classification.classifier import Classifier, files_digest, load_classifier
    from shapewright.classification.evidence import UNKNOWN
    from shapewright.classification.exemplars import Exemplars
    from shapewright.classification.file_format import exemplars_file
    from shapewright.classification.ready import classify, load_ready_classifier
    from shapewright.classification.ready_files import ready_classifier_file
    from shapewright.classification.trade_off import TradeOffPoint

_HOMES = {
    "Classification": "answer",
    "Classifier": "classifier",
    "Exemplars": "exemplars",
    "TradeOffPoint": "trade_off",
    "UNKNOWN": "evidence",
    "classify": "ready",
    "exemplars_file": "file_format",
    "files_digest": "classifier",
    "gather_instances": "class_instances",
    "instances_of_each": "class_instances",
    "load_classifier": "classifier",
    "load_ready_classifier": "ready",
    "ready_classifier_file": "ready_files",
}

__all__ = [
    "UNKNOWN",
    "Classification",
    "Classifier",
    "Exemplars",
    "TradeOffPoint",
    "classify",
    "exemplars_file",
    "files_digest",
    "gather_instances",
    "instances_of_each",
    "load_classifier",
    "load_ready_classifier",
    "ready_classifier_file",
]

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
