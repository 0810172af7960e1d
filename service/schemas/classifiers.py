"""Classifiers and their training."""

from typing import Annotated, Any, Self

from pydantic import Field

from models_store.job_kinds import JobState
from models_store.tables import ClassifierRow
from service.schemas.common import Identifier, InBody, Moment, OutBody, PageOut, Seed


class TrainingSettingsIn(InBody):
    """Settings of a training; what is left out keeps the library's default (paper section 3.2)."""

    variations: Annotated[int, Field(ge=1, le=100_000)] | None = Field(
        default=None, description="Random variations of each class."
    )
    images_per_variation: Annotated[int, Field(ge=1, le=1000)] | None = None
    image_size: Annotated[int, Field(ge=32, le=1024)] | None = Field(default=None, description="Pixels.")
    held_out: Annotated[float, Field(gt=0, lt=1)] | None = Field(
        default=None, description="Share of the variations that measure the accuracy."
    )
    epochs: Annotated[int, Field(ge=1, le=10_000)] | None = None
    batch_size: Annotated[int, Field(ge=1, le=4096)] | None = None
    seed: Seed | None = None


class ClassifierIn(InBody):
    """A training to start."""

    name: Annotated[str, Field(min_length=1, max_length=200)] | None = None
    model_ids: Annotated[list[Identifier], Field(min_length=1, max_length=10_000)] = Field(
        description="Models to learn from; those with one `class_name` make one class."
    )
    settings: TrainingSettingsIn = Field(default_factory=TrainingSettingsIn)


class ClassifierOut(OutBody):
    """A classifier: one ONNX file that takes images and knows its classes."""

    id: str
    name: str | None
    state: JobState
    class_names: list[str]
    model_ids: list[str]
    settings: dict[str, Any]
    metrics: dict[str, Any] | None
    job_id: str
    onnx_url: str | None = Field(description="The ONNX file; null until the training has succeeded.")
    seconds: float | None = Field(description="How long the training took.")
    created_at: Moment

    @classmethod
    def from_row(cls, row: ClassifierRow) -> Self:
        """Write down a row."""
        return cls(
            id=row.id,
            name=row.name,
            state=row.job.state,
            class_names=row.class_names,
            model_ids=row.model_ids,
            settings=row.settings,
            metrics=row.metrics,
            job_id=row.job_id,
            onnx_url=f"/v1/classifiers/{row.id}/onnx" if row.onnx_key else None,
            seconds=row.seconds,
            created_at=row.created_at,
        )


class ClassifierPageOut(PageOut[ClassifierOut]):
    """A page of classifiers."""
