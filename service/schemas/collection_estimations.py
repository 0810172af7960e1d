"""Which parameter values rebuild each of many meshes."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field

from models_store.catalog import DoneCounts, RankedMesh
from models_store.job_kinds import JobState
from models_store.tables import CollectionEstimationRow
from service.schemas.common import Identifier, InBody, Moment, OutBody, PageOut
from service.schemas.estimations import (
    Axis,
    DistancesOut,
    EstimationSettingsIn,
    FoundModelOut,
    ParameterEstimateOut,
    PoseOut,
    RatioOut,
    Unit,
)


class CollectionEstimationIn(InBody):
    """Meshes to rebuild, each with a model or with the best of a class's models."""

    collection_id: Identifier | None = Field(
        default=None, description="A collection, indexed or not; leave it out to name meshes instead."
    )
    mesh_ids: Annotated[list[Identifier], Field(min_length=1, max_length=10_000)] | None = None
    model_id: Identifier | None = Field(default=None, description="A model; leave it out to name a class instead.")
    class_name: Annotated[str, Field(min_length=1, max_length=200)] | None = Field(
        default=None, description="A class; for each mesh its models are all tried."
    )
    units: Unit | None = Field(
        default=None,
        description="Unit of the meshes' coordinates: lengths come in it, and the scale of the fits is known.",
    )
    up: Axis | None = Field(default=None, description="The axis of the meshes' files that points up.")
    settings: EstimationSettingsIn = Field(default_factory=EstimationSettingsIn)


class CollectionEstimationOut(OutBody):
    """An estimation of many meshes, asked for or done."""

    id: str
    state: JobState
    collection_id: str | None = Field(description="The collection that was asked for; null if meshes were.")
    mesh_count: int
    done_count: int = Field(description="Meshes that have a row; they keep it if the job is cancelled.")
    failed_count: int = Field(description="Those among them that could not be estimated.")
    model_id: str | None = Field(description="The model that was asked for; null if a class was.")
    class_name: str | None = Field(description="The class that was asked for; null if a model was.")
    model_ids: list[str] = Field(description="The models that are tried.")
    units: str | None = Field(description="Unit of the meshes' coordinates, if it was given.")
    up: str | None = Field(description="Axis of the meshes' files that points up, if it was given.")
    settings: dict[str, Any]
    rows_url: str = Field(description="What was found for each mesh, in any order.")
    table_url: str = Field(description="The same as comma-separated values, a column for each parameter.")
    job_id: str
    created_at: Moment

    @classmethod
    def from_row(cls, row: CollectionEstimationRow, counts: DoneCounts) -> Self:
        """Write down a row."""
        return cls(
            id=row.id,
            state=row.job.state,
            collection_id=row.collection_id,
            mesh_count=len(row.mesh_ids),
            done_count=counts.done,
            failed_count=counts.failed,
            model_id=row.model_id,
            class_name=row.class_name,
            model_ids=row.model_ids,
            units=row.units,
            up=row.up,
            settings=row.settings,
            rows_url=f"/v1/collection-estimations/{row.id}/rows",
            table_url=f"/v1/collection-estimations/{row.id}/table",
            job_id=row.job_id,
            created_at=row.created_at,
        )


class CollectionEstimationPageOut(PageOut[CollectionEstimationOut]):
    """A page of estimations of many meshes."""


class MeshAnswerOut(OutBody):
    """What was found for a mesh."""

    estimator: str = Field(description="Which estimator found it.")
    model: FoundModelOut = Field(description="The model that fits best.")
    layer: Literal[1, 2, 3]
    complete: bool
    values: list[float] = Field(description="x in the order of the model's parameters.")
    parameters: list[ParameterEstimateOut]
    pose: PoseOut
    distances: DistancesOut
    ratios: list[RatioOut]


class EstimatedMeshOut(OutBody):
    """The row of a mesh: its answer, or why there is none."""

    position: int = Field(description="Number of the mesh in what was asked for, from 0.")
    mesh_id: str
    file_name: str
    sorted_by: float | None = Field(description="The value that the rows are sorted by; null comes last.")
    answer: MeshAnswerOut | None
    error: str | None = Field(description="Why there is no answer.")
    seconds: float | None

    @classmethod
    def from_ranked(cls, ranked: RankedMesh) -> Self:
        """Write down a row."""
        row = ranked.row
        return cls(
            position=row.position,
            mesh_id=row.mesh_id,
            file_name=ranked.file_name,
            sorted_by=ranked.value,
            answer=None if row.answer is None else MeshAnswerOut.model_validate(row.answer),
            error=row.error,
            seconds=row.seconds,
        )


class EstimatedMeshPageOut(OutBody):
    """A page of rows, in the order that was asked for."""

    items: list[EstimatedMeshOut]
    next_cursor: str | None = Field(description="Give it as `cursor` to read on; null on the last page.")
