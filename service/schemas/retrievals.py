"""Which meshes of a collection come first for a query."""

from typing import Annotated, Literal, Self

from pydantic import Field

from models_store.job_kinds import JobState
from models_store.tables import RetrievalRow
from service.schemas.common import Identifier, InBody, Moment, OutBody, PageOut, Seed

Evidence = Literal["probabilities", "panorama", "combined"]


class RetrievalIn(InBody):
    """A collection and exactly one query: a class, a model or a mesh."""

    collection_id: Identifier
    class_name: Annotated[str, Field(min_length=1, max_length=200)] | None = Field(
        default=None, description="Find meshes of this class, one that the collection's classifier knows;"
    )
    model_id: Identifier | None = Field(default=None, description="or meshes like instances of this model;")
    mesh_id: Identifier | None = Field(
        default=None, description="or meshes like this one, which need not be in the collection."
    )
    evidence: Evidence | None = Field(
        default=None,
        description="The classifier's probabilities, panorama distances, or both; null: both, but for a class "
        "the probabilities, in which the geometry counts already.",
    )
    limit: Annotated[int, Field(ge=1, le=500)] = Field(default=50, description="Most meshes of the result.")
    instances: Annotated[int, Field(ge=0, le=10_000)] = Field(
        default=500,
        description="Random instances that distances to a class or model are measured to, beside the base instances.",
    )
    seed: Seed = 0


class RetrievedMeshOut(OutBody):
    """One place of the ranking."""

    mesh_id: str
    file_name: str
    score: float = Field(description="What the ranking is ordered by; comparable within one retrieval only.")
    probability: float | None = Field(
        description="Of the class, or that mesh and query are of one class; null if only distances are asked for."
    )
    distance: float | None = Field(
        description="Panorama distance to the query; null if only probabilities are asked for."
    )


class RetrievalResultOut(OutBody):
    """The answer."""

    mesh_count: int = Field(description="Meshes that were ranked.")
    items: list[RetrievedMeshOut] = Field(description="The first of them, best first.")
    seconds: float


class RetrievalOut(OutBody):
    """A retrieval, asked for or done."""

    id: str
    state: JobState
    collection_id: str
    class_name: str | None
    model_id: str | None
    mesh_id: str | None
    evidence: Evidence
    limit: int
    instances: int
    seed: int
    result: RetrievalResultOut | None
    contact_sheet_url: str | None = Field(description="A PNG of the first meshes; null until there is one.")
    job_id: str
    created_at: Moment

    @classmethod
    def from_row(cls, row: RetrievalRow) -> Self:
        """Write down a row."""
        result = None if row.result is None else RetrievalResultOut.model_validate(row.result)
        return cls(
            id=row.id,
            state=row.job.state,
            collection_id=row.collection_id,
            class_name=row.class_name,
            model_id=row.model_id,
            mesh_id=row.mesh_id,
            **row.settings,
            result=result,
            contact_sheet_url=f"/v1/retrievals/{row.id}/contact-sheet" if row.sheet_key else None,
            job_id=row.job_id,
            created_at=row.created_at,
        )


class RetrievalPageOut(PageOut[RetrievalOut]):
    """A page of retrievals."""
