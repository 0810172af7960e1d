"""Procedural models: a base mesh, an ordered list of modelling operations, and named parameters."""

from shapewright.modeling.compiled import CompiledModel, compile_model
from shapewright.modeling.component import Component
from shapewright.modeling.dependence import Condition, Limit, when
from shapewright.modeling.elements import Element, Mirror, Target, Turn, group, imaged, mirrored, turned
from shapewright.modeling.parameter import Parameter, ParameterTarget
from shapewright.modeling.part import Part
from shapewright.modeling.procedural_model import ProceduralModel, json_schema
from shapewright.modeling.recorder import Recorder
from shapewright.modeling.symmetry import Symmetry

__all__ = [
    "CompiledModel",
    "Component",
    "Condition",
    "Element",
    "Limit",
    "Mirror",
    "Parameter",
    "ParameterTarget",
    "Part",
    "ProceduralModel",
    "Recorder",
    "Symmetry",
    "Target",
    "Turn",
    "compile_model",
    "group",
    "imaged",
    "json_schema",
    "mirrored",
    "turned",
    "when",
]
