"""Procedural models and their instances."""

import json
from typing import Annotated, Any, Literal, Self

from pydantic import Field

from models_store.tables import ModelRow
from service.schemas.common import InBody, Moment, OutBody, PageOut, Seed


class OptionOut(OutBody):
    """What a value of a choice or switch means."""

    value: float = Field(description="A whole number: x.")
    name: str


class ConditionOut(OutBody):
    """Holds where x of a parameter lies in a range; of a parameter that is not active it does not hold."""

    parameter: str = Field(description="A parameter that comes before.")
    minimum: float
    maximum: float


class LimitOut(OutBody):
    """A range that depends on another value: its end is at `offset + factor * x` of another parameter."""

    bound: Literal["minimum", "maximum"]
    parameter: str = Field(description="A parameter that comes before.")
    offset: float
    factor: float


class ParameterOut(OutBody):
    """A named parameter; the displayed value is `x * base_value`, or the name of an option."""

    name: str
    label: str
    unit: str | None
    base_value: float | None = Field(description="Displayed value of the base model; null if x itself is shown.")
    kind: Literal["length", "angle", "ratio"] | None = Field(
        default=None, description="What the displayed value is; null if the author does not say, and of choices."
    )
    minimum: float = Field(description="Smallest x.")
    maximum: float = Field(description="Largest x.")
    default: float = Field(description="x of the base model: always 1.")
    options: list[OptionOut] = Field(default=[], description="Of a choice or switch; empty if x is a measure.")
    active_when: list[ConditionOut] = Field(
        default=[], description="Conditions that must all hold, else x is 1 and changes nothing."
    )
    limits: list[LimitOut] = Field(default=[], description="What narrows the range of x further.")


class PartOut(OutBody):
    """An optional part of the model."""

    name: str
    present_when: list[ConditionOut] = Field(description="Conditions that must all hold, else it is left out.")


class SymmetryOut(OutBody):
    """What leaves every instance as it is."""

    mirrors: list[Literal["x", "y", "z"]] = Field(default=[], description="Normals of mirror planes.")
    axis: Literal["x", "y", "z"] | None = Field(default=None, description="It can be turned about this axis ...")
    order: int = Field(default=1, description="... by 360 degrees / order.")


class ModelOut(OutBody):
    """A procedural model."""

    id: str = Field(description="SHA-256 of the canonical document.")
    name: str
    class_name: str
    description: str
    closed: bool = Field(description="Whether every instance is a closed surface.")
    format_version: int
    operation_count: int
    parameters: list[ParameterOut]
    parts: list[PartOut] = Field(description="Optional parts.")
    symmetry: SymmetryOut
    thumbnail_url: str | None = Field(description="PNG; null until it is rendered.")
    created_at: Moment

    @classmethod
    def from_row(cls, row: ModelRow) -> Self:
        """Write down a row."""
        return cls(**cls._fields_of(row))

    @staticmethod
    def _fields_of(row: ModelRow) -> dict[str, Any]:
        return {
            "id": row.id,
            "name": row.name,
            "class_name": row.class_name,
            "description": row.description,
            "closed": row.closed,
            "format_version": row.format_version,
            "operation_count": row.operation_count,
            "parameters": [ParameterOut.model_validate(parameter) for parameter in row.parameters],
            "parts": [PartOut.model_validate(part) for part in row.parts or []],
            "symmetry": SymmetryOut.model_validate(row.symmetry or {}),
            "thumbnail_url": f"/v1/models/{row.id}/thumbnail" if row.thumbnail_key else None,
            "created_at": row.created_at,
        }


class ModelDetailOut(ModelOut):
    """A procedural model with its document."""

    document: dict[str, Any] = Field(description="The canonical document; see procedural-model.schema.json.")

    @classmethod
    def from_row(cls, row: ModelRow) -> Self:
        """Write down a row."""
        return cls(**cls._fields_of(row), document=json.loads(row.document))


class ModelPageOut(PageOut[ModelOut]):
    """A page of models."""


class ClassOut(OutBody):
    """A class of objects: the set of models that share its name."""

    name: str
    models: list[ModelOut] = Field(description="By name; of several versions of a model the newest.")


class ClassPageOut(OutBody):
    """A page of classes, by name."""

    items: list[ClassOut]
    next_cursor: str | None = Field(description="Give it as `cursor` to read on; null on the last page.")


class InstanceIn(InBody):
    """Which instance to generate."""

    values: dict[str, float] = Field(
        default_factory=dict,
        max_length=10_000,
        description="x by parameter name; what is missing is 1 (or as near as its range comes), or random if there is "
        "a `seed`. Values of parameters that are not active make no difference.",
    )
    seed: Seed | None = Field(
        default=None, description="A random variation: what `values` does not fix is uniform in its range."
    )
    subdivision_steps: Annotated[int, Field(ge=0, le=3)] = 2
