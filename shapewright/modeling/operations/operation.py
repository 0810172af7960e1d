"""What every operation is: a value with fields, that changes a topology and tells how it moves vertices."""

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, Protocol, runtime_checkable

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.fields import FieldKind, shown
from shapewright.modeling.opcodes import MULTIPLY
from shapewright.modeling.program import Change, Changes, Program

Mode = tuple[Change, ...]
"""How a parameter x changes the procedure parameters of an operation (Table 1); x = 1 changes nothing."""


@runtime_checkable
class Step(Protocol):
    """The geometric half of an operation, bound to the topology in which it was made."""

    def write(self, program: Program, changes: Changes) -> None:
        """Write the instructions that move vertices.

        Args:
            program: what they are appended to.
            changes: what parameters do to the quantities of the operation: each change and the parameter's column.
        """


class NoMove:
    """The step of an operation that only changes the topology."""

    def write(self, program: Program, changes: Changes) -> None:
        """Write nothing."""


NO_MOVE = NoMove()


@dataclasses.dataclass(frozen=True)
class Operation(ABC):
    """A modelling operation as it stands in a procedural model.

    Attributes:
        kind: its name in a document.
        quantities: the fields that are procedure parameters in the sense of Table 1.
        modes: the ways in which an inserted parameter x can act on them.
    """

    kind: ClassVar[str]
    quantities: ClassVar[tuple[str, ...]] = ()
    modes: ClassVar[Mapping[str, Mode]] = {}

    @abstractmethod
    def apply(self, mesh: ControlMesh) -> Step:
        """Change the topology and return how vertices move.

        Raises:
            ModelError: an element does not exist, or the change is impossible there.
        """

    def amounts(self) -> dict[str, float]:
        """Return the procedure parameters as they are at x = 1."""
        return {name: float(getattr(self, name)) for name in self.quantities}

    @classmethod
    def field_kinds(cls) -> dict[str, FieldKind]:
        """Return the fields of the document in the order of their declaration."""
        return {f.name: f.metadata["kind"] for f in dataclasses.fields(cls)}

    @classmethod
    def from_document(cls, document: Mapping[str, Any], where: str) -> "Operation":
        """Make the operation from its JSON object (without ``op``).

        Raises:
            ModelError: a field is missing, unknown or wrong; ``where`` says which.
        """
        kinds = cls.field_kinds()
        for name in document:
            if name not in kinds:
                raise ModelError(f"{cls.kind} has no field {shown(name)}", where=where)
        for f in dataclasses.fields(cls):
            if f.default is dataclasses.MISSING and f.name not in document:
                raise ModelError(f"{cls.kind} needs the field {f.name!r}", where=where)
        values = {name: kinds[name].read(value, f"{where}.{name}") for name, value in document.items()}
        try:
            return cls(**values)
        except ModelError as error:
            raise ModelError(error.message, where=where) from None

    def to_document(self) -> dict[str, Any]:
        """Return the JSON object of the operation, every field written."""
        kinds = self.field_kinds()
        return {"op": self.kind, **{name: kind.write(getattr(self, name)) for name, kind in kinds.items()}}

    @classmethod
    def schema(cls) -> dict[str, Any]:
        """Return the JSON schema of the operation's object."""
        required = [f.name for f in dataclasses.fields(cls) if f.default is dataclasses.MISSING]
        return {
            "type": "object",
            "description": (cls.__doc__ or "").strip().splitlines()[0],
            "properties": {
                "op": {"const": cls.kind},
                **{name: kind.schema for name, kind in cls.field_kinds().items()},
            },
            "required": ["op", *required],
            "additionalProperties": False,
        }


def multiplies(*names: str) -> Mode:
    """Return the mode x times the named quantities."""
    return tuple(Change(name, MULTIPLY) for name in names)
