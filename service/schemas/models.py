"""Procedural models and their instances."""

import json
from typing import Annotated, Any, Self

from pydantic import Field

from models_store.tables import ModelRow
from service.schemas.common import InBody, Moment, OutBody, PageOut, Seed


class ParameterOut(OutBody):
    """A named parameter; the displayed value is `x * base_value`."""

    name: str
    label: str
    unit: str | None
    base_value: float | None = Field(description="Displayed value of the base model; null if x itself is shown.")
    minimum: float = Field(description="Smallest x.")
    maximum: float = Field(description="Largest x.")
    default: float = Field(description="x of the base model: always 1.")


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


class InstanceIn(InBody):
    """Which instance to generate."""

    values: dict[str, float] = Field(
        default_factory=dict,
        max_length=10_000,
        description="x by parameter name; what is missing is 1, or random if there is a `seed`.",
    )
    seed: Seed | None = Field(
        default=None, description="A random variation: what `values` does not fix is uniform in its range."
    )
    subdivision_steps: Annotated[int, Field(ge=0, le=3)] = 2
