"""Which parameter values rebuild a mesh."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field

from models_store.job_kinds import JobState
from models_store.tables import EstimationRow
from service.schemas.common import Identifier, InBody, Moment, OutBody, PageOut, Seed
from service.schemas.meshes import Coordinates
from shapewright.errors import EstimationError

Unit = Literal["mm", "cm", "m", "in"]
Axis = Literal["+x", "-x", "+y", "-y", "+z", "-z"]
ParameterStatus = Literal["determined", "determined_up_to_scale", "not_determined", "inactive", "at_range_end"]
Interval = Annotated[list[float], Field(min_length=2, max_length=2)]


class EstimationSettingsIn(InBody):
    """Settings of an estimation; what is left out keeps the library's default (paper section 3.3).

    Those of random instances, points, pictures and steps are the reference's.
    """

    samples: Annotated[int, Field(ge=1, le=1_000_000)] | None = Field(
        default=None, description="Random instances of layer 1."
    )
    surface_points: Annotated[int, Field(ge=1, le=100_000)] | None = Field(
        default=None, description="Poisson-disk points on the query."
    )
    image_size: Annotated[int, Field(ge=2, le=1024, multiple_of=2)] | None = Field(
        default=None, description="Pixels of a depth view's side."
    )
    subdivision_steps: Annotated[int, Field(ge=0, le=4)] | None = Field(
        default=None, description="Catmull–Clark steps of the instances that are compared."
    )
    model_points: Literal["surface", "vertices"] | None = Field(
        default=None,
        description="Where the surface distance measures an instance: evenly over its surface, or at its vertices.",
    )
    surface_threshold: Annotated[float, Field(ge=0)] | None = None
    zbuffer_threshold: Annotated[float, Field(ge=0)] | None = None
    step_sizes: Annotated[list[Annotated[float, Field(gt=0)]], Field(min_length=1, max_length=20)] | None = Field(
        default=None, description="Steps of the hill climbing, largest first."
    )
    refined_models: Annotated[int, Field(ge=1, le=1000)] | None = Field(
        default=None, description="Of several models, how many the reference takes through all layers."
    )
    seed: Seed | None = None
    estimator: Literal["fast", "reference"] | None = Field(
        default=None,
        description="Which estimator works: `fast` (the default), or `reference`, the paper step by step.",
    )

    def checked(self) -> dict[str, Any]:
        """The settings that were given, held against the library's own rules.

        Raises:
            EstimationError: they make no sense together; ``where`` is the field of the body.
        """
        from shapewright.estimation.settings import EstimationSettings  # when first needed: a quick start

        given = self.model_dump(exclude_none=True)
        try:
            EstimationSettings.from_dict(given)
        except EstimationError as error:
            raise EstimationError(error.message, where=f"settings.{error.where}") from None
        return given


class EstimationIn(InBody):
    """A mesh to rebuild with a model, or with the best of a class's models."""

    mesh_id: Identifier
    model_id: Identifier | None = Field(default=None, description="A model; leave it out to name a class instead.")
    class_name: Annotated[str, Field(min_length=1, max_length=200)] | None = Field(
        default=None, description="A class; its models are all tried, and the result says which one fits."
    )
    units: Unit | None = Field(
        default=None,
        description="Unit of the mesh's coordinates: lengths come in it, and the scale of the fit is known.",
    )
    up: Axis | None = Field(default=None, description="The axis of the mesh's file that points up.")
    time_limit_s: Annotated[float, Field(gt=0, le=86_400)] | None = Field(
        default=None, description="Seconds of work after which the best answer until then is taken."
    )
    settings: EstimationSettingsIn = Field(default_factory=EstimationSettingsIn)


class ParameterEstimateOut(OutBody):
    """A parameter's estimate; `value` is x, shown as `x * base_value` or by the name of its option."""

    name: str
    label: str
    unit: str | None
    value: float
    base_value: float | None
    minimum: float = Field(description="Smallest x, given the other values.")
    maximum: float = Field(description="Largest x, given the other values.")
    active: bool = Field(default=True, description="False if another value makes this one meaningless; x is 1 then.")
    option: str | None = Field(default=None, description="Name of the option, of a choice or switch.")
    status: ParameterStatus | None = Field(
        default=None, description="What the query says about it; null where the estimator does not judge."
    )
    interval: Interval | None = Field(
        default=None, description="Where x lies with a probability of 90 %, given this structure; null if unknown."
    )


class DistancesOut(OutBody):
    """How far query and fitted mesh are apart; null where a stage did not measure it."""

    panorama: float | None
    surface: float | None
    zbuffer: float | None
    zbuffer_raw: float | None


class PoseOut(OutBody):
    """From the model's space to the query's own coordinates: `scale * rotation @ point + translation`."""

    rotation: Annotated[list[Coordinates], Field(min_length=3, max_length=3)]
    translation: Coordinates
    scale: float


class StageOut(OutBody):
    """What one of the optimisations found (paper figure 4)."""

    name: str
    layer: Literal[1, 2, 3]
    values: list[float] = Field(description="x in the order of the model's parameters.")
    pose: PoseOut
    distances: DistancesOut
    complete: bool = Field(description="False if it was cancelled in the middle.")


class FoundModelOut(OutBody):
    """A model that an estimation speaks of."""

    id: str
    name: str


class ModelTriedOut(OutBody):
    """How near a model of the class came."""

    model: FoundModelOut
    distances: DistancesOut | None = Field(description="Of its best fit; null if others were nearer before one.")
    panorama: float | None = Field(description="Smallest panorama distance of its random instances, if it has any.")


class RatioOut(OutBody):
    """Two lengths beside each other, which a mesh determines whatever its scale is."""

    numerator: str = Field(description="Name of a parameter.")
    denominator: str = Field(description="Name of another one.")
    label: str
    value: float
    interval: Interval | None = Field(description="Where it lies with a probability of 90 %, given this structure.")
    status: ParameterStatus | None


class CombinationOut(OutBody):
    """What the mesh determines although it does not determine the parameters in it."""

    label: str
    weights: dict[str, float] = Field(description="Share of each parameter, by name.")
    interval_share: float = Field(description="Width of its 90 % interval as a share of what the ranges allow.")


class AlternativeOut(OutBody):
    """Another answer that fits nearly as well."""

    kind: Literal["pose", "option", "model"] = Field(description="What is different.")
    label: str
    model: FoundModelOut
    values: list[float] = Field(description="x in the order of the model's parameters.")
    parameters: list[ParameterEstimateOut]
    pose: PoseOut
    distances: DistancesOut


class FailedThresholdOut(OutBody):
    """A distance that was not below its threshold."""

    name: Literal["surface", "zbuffer"]
    value: float | None
    threshold: float


class PartResidualOut(OutBody):
    """How far a part of the fitted model is from the mesh, in units in which the mesh reaches from -1 to 1."""

    name: str
    share_of_area: float
    mean: float
    p95: float
    invented_share: float = Field(description="Share of its area farther from the mesh than the tolerance.")


class ResidualsOut(OutBody):
    """Where the surfaces of mesh and fit part, in units in which the mesh reaches from -1 to 1."""

    tolerance: float
    mean: float
    followed_share: float = Field(description="Share of the mesh's area that is within the tolerance of the fit.")
    invented_share: float = Field(description="Share of the fit's area farther from the mesh than the tolerance.")
    by_part: list[PartResidualOut]


class VerdictOut(OutBody):
    """How well the answer rebuilds the mesh."""

    layer: Literal[1, 2, 3]
    failed: list[FailedThresholdOut] = Field(description="Thresholds that higher layers missed, the highest first.")
    residuals: ResidualsOut | None


class EstimationResultOut(OutBody):
    """The answer."""

    estimator: str = Field(description="Which estimator found it.")
    model: FoundModelOut = Field(description="The model that fits best.")
    layer: Literal[1, 2, 3]
    complete: bool = Field(description="False if it was cancelled: the best so far.")
    values: list[float] = Field(description="x in the order of the model's parameters.")
    parameters: list[ParameterEstimateOut]
    distances: DistancesOut
    stages: list[StageOut]
    pose: PoseOut
    seconds: float
    verdict: VerdictOut | None = None
    ratios: list[RatioOut] = Field(default=[])
    combinations: list[CombinationOut] = Field(default=[])
    alternatives: list[AlternativeOut] = Field(default=[])
    tried: list[ModelTriedOut] = Field(default=[], description="Every model that was tried, best first.")


class EstimationOut(OutBody):
    """An estimation, asked for or done."""

    id: str
    state: JobState
    mesh_id: str
    model_id: str | None = Field(description="The model; of an estimation for a class null until it is found.")
    class_name: str | None = Field(description="The class that was asked for; null if a model was.")
    model_ids: list[str] = Field(description="The models that are tried.")
    units: str | None = Field(description="Unit of the mesh's coordinates, if it was given.")
    up: str | None = Field(description="Axis of the mesh's file that points up, if it was given.")
    time_limit_s: float | None = Field(description="Seconds of work that it may take, if that was limited.")
    settings: dict[str, Any]
    result: EstimationResultOut | None
    mesh_url: str | None = Field(description="The fitted mesh as GLB, in the query's coordinates.")
    residuals_url: str | None = Field(
        description="Mesh and fit as GLB, colored by how far each part of them is from the other."
    )
    job_id: str
    created_at: Moment

    @classmethod
    def from_row(cls, row: EstimationRow) -> Self:
        """Write down a row."""
        result = None if row.result is None else EstimationResultOut.model_validate(row.result)
        return cls(
            id=row.id,
            state=row.job.state,
            mesh_id=row.mesh_id,
            model_id=row.model_id,
            class_name=row.class_name,
            model_ids=[row.model_id] if row.model_ids is None and row.model_id is not None else row.model_ids or [],
            units=row.units,
            up=row.up,
            time_limit_s=row.time_limit_s,
            settings=row.settings,
            result=result,
            mesh_url=f"/v1/estimations/{row.id}/mesh" if row.mesh_key else None,
            residuals_url=f"/v1/estimations/{row.id}/residuals" if row.residuals_key else None,
            job_id=row.job_id,
            created_at=row.created_at,
        )


class EstimationPageOut(PageOut[EstimationOut]):
    """A page of estimations."""
