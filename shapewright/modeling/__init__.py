"""Procedural models: a base mesh, an ordered list of modelling operations, and named parameters."""

from shapewright.modeling.compiled import CompiledModel
from shapewright.modeling.elements import Element, Mirror, Target, Turn
from shapewright.modeling.parameter import Parameter, ParameterTarget
from shapewright.modeling.procedural_model import ProceduralModel, json_schema
from shapewright.modeling.recorder import Component, Recorder, group, imaged, mirrored, turned

__all__ = [
    "CompiledModel",
    "Component",
    "Element",
    "Mirror",
    "Parameter",
    "ParameterTarget",
    "ProceduralModel",
    "Recorder",
    "Target",
    "Turn",
    "group",
    "imaged",
    "json_schema",
    "mirrored",
    "turned",
]
