"""What a classifier's row asks to be learned, compiled and ready to be worked on."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from models_store import catalog
from workers.context import JobContext, with_tuples

if TYPE_CHECKING:
    from shapewright.classification import FeatureExtractor, TrainingSettings
    from shapewright.classification.dataset import Plan
    from shapewright.modeling import CompiledModel


@dataclass(frozen=True, eq=False)
class LearningPlan:
    """The chunks that a training needs, and what computes them."""

    plan: "Plan"
    settings: "TrainingSettings"

    @cached_property
    def extractor(self) -> "FeatureExtractor":
        """The backbone, loaded with the first use."""
        from shapewright.classification import FeatureExtractor, load_backbone

        return FeatureExtractor(load_backbone(self.settings.backbone), threads=1)


_kept: Final[dict[str, LearningPlan]] = {}
"""The plan of the last job by the classifier's id: a worker that helps takes one part of it after the other."""


def learning_plan(context: JobContext, classifier_id: str) -> LearningPlan:
    """The plan of a classifier, whose row never changes what is asked for.

    Raises:
        ShapewrightError: a model or a setting of the row is not fit for it.
    """
    if classifier_id not in _kept:
        from shapewright.classification import TrainingSettings
        from shapewright.classification.dataset import plan_learning

        with context.database.reading() as session:
            row = catalog.get_classifier(session, classifier_id)
        classes: dict[str, list[CompiledModel]] = {}
        for model_id in row.model_ids:
            model = context.load_model(model_id)
            classes.setdefault(model.class_name, []).append(model.compile())
        negatives = [context.load_model(model_id).compile() for model_id in row.negative_model_ids or ()]
        settings = TrainingSettings(**with_tuples(row.settings))
        _kept.clear()
        _kept[classifier_id] = LearningPlan(plan_learning(classes, negatives, settings), settings)
    return _kept[classifier_id]
