"""Classifiers and their training."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, PositiveFloat

from models_store.job_kinds import JobState
from models_store.tables import ClassifierRow
from service.schemas.common import Identifier, InBody, Moment, OutBody, PageOut, Seed
from shapewright.classification.trade_off import trade_off_of
from shapewright.errors import ClassifierError


class TrainingSettingsIn(InBody):
    """Settings of a training; what is left out keeps the library's default (paper section 3.2)."""

    variations: Annotated[int, Field(ge=2, le=100_000)] | None = Field(
        default=None, description="Random variations of each class."
    )
    images_per_variation: Annotated[int, Field(ge=1, le=1000)] | None = None
    rehearsed: Annotated[int, Field(ge=2, le=100_000)] | None = Field(
        default=None,
        description="Variations to draw again of each class that the base classifier knows; only with "
        "`base_classifier_id`.",
    )
    image_size: Annotated[int, Field(ge=32, le=1024)] | None = Field(
        default=None,
        description="Pixels a side; left out, what the backbone was trained for. EfficientNet takes multiples of 32, "
        "Inception 11 more than a multiple of 32 (75, 107, … 299, …).",
    )
    scale_range: tuple[PositiveFloat, PositiveFloat] | None = Field(
        default=None, description="Random scales of the object in its pictures: smallest and largest."
    )
    negatives: Annotated[int, Field(ge=0, le=100_000)] | None = Field(
        default=None,
        description="Objects that are of no class, of each kind: variations of the models in `negative_model_ids` "
        "together, and random assemblies. 0: what is unknown is not learned.",
    )
    exemplars: bool | None = Field(
        default=None, description="Whether the geometry of the variations is kept, as evidence beside the pictures."
    )
    exemplars_per_class: Annotated[int, Field(ge=0, le=100_000)] | None = Field(
        default=None, description="Keep the geometry of so many variations, those that represent the rest best; 0: all."
    )
    vary: bool | None = Field(default=None, description="false: learn from base models alone.")
    held_out: Annotated[float, Field(gt=0, lt=1)] | None = Field(
        default=None, description="Share of the variations that measure the accuracy."
    )
    hidden: Annotated[int, Field(ge=0, le=4096)] | None = Field(
        default=None, description="Values of the hidden layer; 0 trains a single layer, as the paper does."
    )
    epochs: Annotated[int, Field(ge=1, le=10_000)] | None = None
    patience: Annotated[int, Field(ge=1, le=10_000)] | None = Field(
        default=None, description="Epochs without a better held-out loss after which training stops."
    )
    learning_rate: Annotated[float, Field(gt=0)] | None = None
    weight_decay: Annotated[float, Field(ge=0)] | None = None
    batch_size: Annotated[int, Field(ge=1, le=65_536)] | None = None
    seed: Seed | None = None
    backbone: Annotated[str, Field(max_length=100)] | None = None
    style: Literal["edges", "shaded", "lambert", "depth", "normals", "fused", "splats"] | None = Field(
        default=None,
        description="Look of the pictures: of points (splats, which scans and point clouds need), or of triangles.",
    )
    framing: Literal["paper", "sphere"] | None = Field(
        default=None,
        description="How an object is put into its picture: by the mean and range of its vertices (paper), or by its "
        "bounding box and farthest point.",
    )
    window: Annotated[float, Field(gt=0)] | None = Field(
        default=None, description="Half the side of a picture, in units of the scaled object."
    )
    subdivision_steps: Annotated[int, Field(ge=0, le=3)] | None = None
    broken: Annotated[float, Field(ge=0, le=0.7)] | None = Field(
        default=None,
        description="Share of the variations that are broken as scans and careless exports are; 0 for pictures of "
        "triangles.",
    )
    breaks: (
        Annotated[
            list[Literal["noise", "holes", "one_sided", "rounded", "sparse", "blocks", "specks"]], Field(max_length=7)
        ]
        | None
    ) = Field(default=None, description="Ways to break them.")

    def checked(self, *, extending: bool = False) -> dict[str, Any]:
        """The settings that were given, held against the library's own rules.

        Args:
            extending: whether they are of an extension.

        Raises:
            ClassifierError: they make no sense together; ``where`` is the field of the body.
        """
        from shapewright.training.extension_settings import ExtensionSettings
        from shapewright.training.settings import TrainingSettings  # when first needed: a quick start

        given = self.model_dump(exclude_none=True)
        try:
            (ExtensionSettings if extending else TrainingSettings).from_dict(given)
        except ClassifierError as error:
            raise ClassifierError(error.message, where=f"settings.{error.where}") from None
        return given


class ClassifierIn(InBody):
    """A training to start."""

    name: Annotated[str, Field(min_length=1, max_length=200)] | None = None
    model_ids: Annotated[list[Identifier], Field(min_length=1, max_length=10_000)] = Field(
        description="Models to learn from; those with one `class_name` make one class. With `base_classifier_id`, "
        "models of the classes to add."
    )
    base_classifier_id: Identifier | None = Field(
        default=None,
        description="Add the classes to this trained classifier, in under a minute; the classes it knows stay as they "
        "are. An extension accepts the `settings` `variations`, `images_per_variation`, `rehearsed`, `negatives`, "
        "`held_out` and those of the optimizer, and takes the others from the base.",
    )
    negative_model_ids: Annotated[list[Identifier], Field(max_length=10_000)] = Field(
        default_factory=list,
        description="Models of objects that belong to none of the classes: they teach the classifier to answer "
        "`unknown`, as random assemblies always do. If empty with `base_classifier_id`, those of the base are used.",
    )
    settings: TrainingSettingsIn = Field(default_factory=TrainingSettingsIn)


class TradeOffPointOut(OutBody):
    """The shares that one threshold of `known` accepts and refuses."""

    threshold: float = Field(description="A mesh with a lower `known` is unknown.")
    accepted_known: float = Field(
        description="Share of the trial variations that are accepted. Most come from models that were learned, the "
        "others from models that were left out."
    )
    refused_other: float = Field(description="Share of the objects of no class that are answered with `unknown`.")


class ClassifierOut(OutBody):
    """A classifier: one ONNX file that takes images and knows its classes, and exemplars of their geometry."""

    id: str
    name: str | None
    state: JobState
    base_classifier_id: str | None = Field(description="The classifier that this one extends.")
    class_names: list[str]
    model_ids: list[str]
    negative_model_ids: list[str]
    settings: dict[str, Any]
    metrics: dict[str, Any] | None
    trade_off: list[TradeOffPointOut] | None = Field(
        description="Shares that thresholds of `known` accept and refuse, lowest threshold first; null until the "
        "training has succeeded, and if no model could be left out."
    )
    job_id: str | None = Field(description="The training; null for the ready classifier, which ships trained.")
    onnx_url: str | None = Field(description="The ONNX file; null until the training has succeeded.")
    exemplars_url: str | None = Field(
        description="The geometry of the variations (.npz); null until the training has succeeded, and without any."
    )
    seconds: float | None = Field(description="How long the training took; null until then, and if it ships.")
    created_at: Moment

    @classmethod
    def from_row(cls, row: ClassifierRow) -> Self:
        """Write down a row."""
        return cls(
            id=row.id,
            name=row.name,
            state=row.state,
            base_classifier_id=row.base_classifier_id,
            class_names=row.class_names,
            model_ids=row.model_ids,
            negative_model_ids=row.negative_model_ids or [],
            settings=row.settings,
            metrics=row.metrics,
            trade_off=_trade_off(row),
            job_id=row.job_id,
            onnx_url=f"/v1/classifiers/{row.id}/onnx" if row.onnx_key else None,
            exemplars_url=f"/v1/classifiers/{row.id}/exemplars" if row.exemplars_key else None,
            seconds=row.seconds,
            created_at=row.created_at,
        )


def _trade_off(row: ClassifierRow) -> list[TradeOffPointOut] | None:
    points = trade_off_of(row.metrics or {}, geometry=row.exemplars_key is not None)
    return None if points is None else [TradeOffPointOut(**point.to_dict()) for point in points]


class ClassifierPageOut(PageOut[ClassifierOut]):
    """A page of classifiers."""
