"""The modelling operations; one file an operation. A new one is added to ``OPERATIONS``."""

from shapewright.modeling.operations.base import Base
from shapewright.modeling.operations.connect import Connect
from shapewright.modeling.operations.drag import Drag
from shapewright.modeling.operations.extrude import Extrude
from shapewright.modeling.operations.insert_vertex import InsertVertex
from shapewright.modeling.operations.mark_sharp import MarkSharp
from shapewright.modeling.operations.operation import Operation
from shapewright.modeling.operations.remove import Remove
from shapewright.modeling.operations.rotate import Rotate
from shapewright.modeling.operations.rotation_extrude import RotationExtrude
from shapewright.modeling.operations.scale import Scale

OPERATIONS: dict[str, type[Operation]] = {
    operation.kind: operation
    for operation in (
        Base,
        Extrude,
        RotationExtrude,
        InsertVertex,
        Drag,
        Scale,
        Rotate,
        Connect,
        Remove,
        MarkSharp,
    )
}

__all__ = [
    "OPERATIONS",
    "Base",
    "Connect",
    "Drag",
    "Extrude",
    "InsertVertex",
    "MarkSharp",
    "Operation",
    "Remove",
    "Rotate",
    "RotationExtrude",
    "Scale",
]
