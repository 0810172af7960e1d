"""Procedural models: a base mesh, an ordered list of modelling operations, and named parameters.

Names are loaded when first used: whoever needs the units of a parameter does not load what evaluates models.
"""

from typing import TYPE_CHECKING

from shapewright.lazy_names import lazy_names

if TYPE_CHECKING:
    from shapewright.modeling.compiled import CompiledModel, compile_model
    from shapewright.modeling.component import Component
    from shapewright.modeling.dependence import Condition, Limit, when
    from shapewright.modeling.elements import Element, Mirror, Target, Turn, group, imaged, mirrored, turned
    from shapewright.modeling.parameter import Parameter, ParameterTarget
    from shapewright.modeling.part import Part
    from shapewright.modeling.procedural_model import ProceduralModel, json_schema
    from shapewright.modeling.recorder import Recorder
    from shapewright.modeling.symmetry import Symmetry

_HOMES = {
    "CompiledModel": "compiled",
    "Component": "component",
    "Condition": "dependence",
    "Element": "elements",
    "Limit": "dependence",
    "Mirror": "elements",
    "Parameter": "parameter",
    "ParameterTarget": "parameter",
    "Part": "part",
    "ProceduralModel": "procedural_model",
    "Recorder": "recorder",
    "Symmetry": "symmetry",
    "Target": "elements",
    "Turn": "elements",
    "compile_model": "compiled",
    "group": "elements",
    "imaged": "elements",
    "json_schema": "procedural_model",
    "mirrored": "elements",
    "turned": "elements",
    "when": "dependence",
}

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

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
