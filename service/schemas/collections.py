"""Meshes that are looked through together."""

from typing import Annotated, Self

from pydantic import Field

from models_store.job_kinds import JobState
from models_store.tables import CollectionRow
from service.schemas.common import Identifier, InBody, Moment, OutBody, PageOut


class CollectionIn(InBody):
    """Meshes to index."""

    name: Annotated[str, Field(min_length=1, max_length=200)] | None = None
    mesh_ids: Annotated[list[Identifier], Field(min_length=1, max_length=10_000)]
    classifier_id: Identifier | None = Field(
        default=None,
        description="null: the ready classifier that ships; where there is none, the newest that succeeded.",
    )


class CollectionOut(OutBody):
    """A collection, asked for or indexed."""

    id: str
    name: str | None
    state: JobState = Field(description="Of its indexing; it can be looked through once that has succeeded.")
    classifier_id: str
    mesh_count: int
    skipped_count: int | None = Field(description="Meshes without a usable surface; null until it is indexed.")
    seconds: float | None = Field(description="How long the indexing took.")
    job_id: str
    created_at: Moment

    @classmethod
    def from_row(cls, row: CollectionRow) -> Self:
        """Write down a row."""
        return cls(
            id=row.id,
            name=row.name,
            state=row.job.state,
            classifier_id=row.classifier_id,
            mesh_count=len(row.mesh_ids),
            skipped_count=None if row.skipped is None else len(row.skipped),
            seconds=row.seconds,
            job_id=row.job_id,
            created_at=row.created_at,
        )


class SkippedMeshOut(OutBody):
    """A mesh that is not in the index, and why."""

    mesh_id: str
    reason: str


class CollectionDetailOut(CollectionOut):
    """A collection with its meshes."""

    mesh_ids: list[str]
    skipped: list[SkippedMeshOut] | None = Field(description="null until it is indexed.")

    @classmethod
    def from_row(cls, row: CollectionRow) -> Self:
        """Write down a row."""
        skipped = None if row.skipped is None else [SkippedMeshOut.model_validate(entry) for entry in row.skipped]
        known = CollectionOut.from_row(row).model_dump()
        return cls(**known, mesh_ids=row.mesh_ids, skipped=skipped)


class CollectionPageOut(PageOut[CollectionOut]):
    """A page of collections."""
