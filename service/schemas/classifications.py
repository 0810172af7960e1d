"""What a mesh is."""

from typing import Annotated, Self

from pydantic import Field

from models_store.job_kinds import JobState
from models_store.tables import ClassificationRow
from service.schemas.common import Identifier, InBody, Moment, OutBody, PageOut, Seed


class ClassificationIn(InBody):
    """A mesh to classify."""

    mesh_id: Identifier
    classifier_id: Identifier | None = Field(
        default=None,
        description="null: the ready classifier that ships; where there is none, the newest that succeeded.",
    )
    views: Annotated[int, Field(ge=1, le=200)] = Field(
        default=10, description="Images to average over; three times as many of a scan of one side."
    )
    seed: Seed = 0
    fit: bool = Field(
        default=False,
        description="Also fit the models of the most probable classes to the mesh: the distance that is reached counts "
        "instead of that of the nearest exemplar. Takes about a second; the classifier needs exemplars.",
    )


class ClassProbabilityOut(OutBody):
    """The probability of one class."""

    class_name: str
    probability: float


class ClassDistanceOut(OutBody):
    """How near a mesh comes to one class."""

    class_name: str
    distance: float


class ClassFitOut(OutBody):
    """How a short fit has rebuilt a mesh."""

    class_name: str
    model_id: str
    values: list[float] = Field(description="In the order of the model's parameters.")
    distance: float
    exemplar_distance: float = Field(description="Where the fit began.")


class NeighborOut(OutBody):
    """The stored variation of the most probable class that is nearest to a mesh."""

    class_name: str
    model_id: str
    exemplar: int = Field(description="Its row among the exemplars of the classifier.")
    values: list[float] | None = Field(
        default=None,
        description="Parameter values, in the order of the model's parameters; null if the catalog lacked the model, "
        "and in older answers.",
    )
    distance: float = Field(description="Panorama distance of the mesh.")
    usual_distance: float | None = Field(description="Nine of ten trial variations of the class were nearer to it.")


class ClassificationResultOut(OutBody):
    """The answer; what older ones lack is null."""

    class_name: str = Field(description="The most probable class, also where the mesh may be of none.")
    answer: str | None = Field(default=None, description="The class, or `unknown`.")
    known: float | None = Field(
        default=None,
        description="Probability that the mesh belongs to any of the classes; null if the classifier was trained "
        "without objects of no class. Below 0.5, `answer` is `unknown`; `trade_off` of the classifier lists what other "
        "thresholds accept and refuse.",
    )
    probabilities: list[ClassProbabilityOut] = Field(
        description="By all evidence, given that it is one of them; most probable class first."
    )
    picture_probabilities: list[ClassProbabilityOut] | None = Field(
        default=None, description="By the pictures alone; most probable class first."
    )
    distances: list[ClassDistanceOut] | None = Field(
        default=None,
        description="Panorama distance of the nearest exemplar of each class, nearest first; null without exemplars.",
    )
    fits: list[ClassFitOut] | None = Field(default=None, description="Of the classes that were fitted, if asked for.")
    neighbor: NeighborOut | None = Field(
        default=None, description="The nearest exemplar of the most probable class; null without exemplars."
    )
    per_view: list[list[float]] = Field(
        description="A row a view; columns in the order of the classifier's `class_names`."
    )
    seconds: float


class ClassificationOut(OutBody):
    """A classification, asked for or done."""

    id: str
    state: JobState
    mesh_id: str
    classifier_id: str
    views: int
    seed: int
    fit: bool
    result: ClassificationResultOut | None
    pictures_url: str | None = Field(description="The pictures that were looked at, as one PNG file; null until then.")
    job_id: str
    created_at: Moment

    @classmethod
    def from_row(cls, row: ClassificationRow) -> Self:
        """Write down a row."""
        result = None if row.result is None else ClassificationResultOut.model_validate(row.result)
        return cls(
            id=row.id,
            state=row.job.state,
            mesh_id=row.mesh_id,
            classifier_id=row.classifier_id,
            views=row.settings["views"],
            seed=row.settings["seed"],
            fit=row.settings.get("fit", False),
            result=result,
            pictures_url=f"/v1/classifications/{row.id}/pictures" if row.pictures_key else None,
            job_id=row.job_id,
            created_at=row.created_at,
        )


class ClassificationPageOut(PageOut[ClassificationOut]):
    """A page of classifications."""
