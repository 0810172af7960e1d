"""Shapewright: what an unknown 3D mesh is, and which parameter values rebuild it.

Names are loaded when first used, so ``import shapewright`` takes milliseconds.
"""

from typing import TYPE_CHECKING

from shapewright.lazy_names import lazy_names

if TYPE_CHECKING:
    from shapewright.classification import Classification, Classifier, classify
    from shapewright.errors import Cancelled, ShapewrightError
    from shapewright.estimation import Estimation, EstimationSettings, Query, estimate
    from shapewright.mesh import PointCloud, TriangleMesh
    from shapewright.mesh.file import load_mesh, load_query, parse_mesh
    from shapewright.modeling import CompiledModel, Parameter, ProceduralModel, Recorder, compile_model
    from shapewright.rendering import render_images, render_mesh
    from shapewright.training import (
        ExtensionSettings,
        TrainedClassifier,
        TrainingSettings,
        extend_classifier,
        train_classifier,
    )

_HOMES = {
    "Cancelled": "errors",
    "Classification": "classification",
    "Classifier": "classification",
    "CompiledModel": "modeling",
    "Estimation": "estimation",
    "EstimationSettings": "estimation",
    "ExtensionSettings": "training",
    "Parameter": "modeling",
    "PointCloud": "mesh",
    "ProceduralModel": "modeling",
    "Query": "estimation",
    "Recorder": "modeling",
    "ShapewrightError": "errors",
    "TrainedClassifier": "training",
    "TrainingSettings": "training",
    "TriangleMesh": "mesh",
    "classify": "classification",
    "compile_model": "modeling",
    "estimate": "estimation",
    "extend_classifier": "training",
    "load_mesh": "mesh.file",
    "load_query": "mesh.file",
    "parse_mesh": "mesh.file",
    "render_images": "rendering",
    "render_mesh": "rendering",
    "train_classifier": "training",
}

__all__ = [
    "Cancelled",
    "Classification",
    "Classifier",
    "CompiledModel",
    "Estimation",
    "EstimationSettings",
    "ExtensionSettings",
    "Parameter",
    "PointCloud",
    "ProceduralModel",
    "Query",
    "Recorder",
    "ShapewrightError",
    "TrainedClassifier",
    "TrainingSettings",
    "TriangleMesh",
    "classify",
    "compile_model",
    "estimate",
    "extend_classifier",
    "load_mesh",
    "load_query",
    "parse_mesh",
    "render_images",
    "render_mesh",
    "train_classifier",
]

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
