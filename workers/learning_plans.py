"""What a classifier's row asks to be learned, compiled and ready to be worked on."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from models_store import catalog
from shapewright.progress import Progress
from workers.context import JobContext, with_tuples

if TYPE_CHECKING:
    from shapewright.modeling import CompiledModel
    from shapewright.network import FeatureExtractor
    from shapewright.training import TrainingSettings
    from shapewright.training.dataset import Plan


@dataclass(frozen=True, eq=False)
class LearningPlan:
    """The chunks that a training needs, and what computes them."""

    plan: "Plan"
    settings: "TrainingSettings"

    @cached_property
    def extractor(self) -> "FeatureExtractor":
        """The backbone, loaded with the first use."""
        from shapewright.network import FeatureExtractor, load_backbone

        return FeatureExtractor(load_backbone(self.settings.backbone), threads=1)


_kept: Final[dict[str, LearningPlan]] = {}
"""The plan of the last job by the classifier's id: a worker that helps takes one part of it after the other."""
_compiled: "Final[dict[str, CompiledModel]]" = {}
"""Models of the last plan by their ids, also of one that was broken off."""


def learning_plan(context: JobContext, classifier_id: str, progress: Progress) -> LearningPlan:
    """The plan of a classifier, whose row never changes what is asked for.

    Args:
        context: of the job.
        classifier_id: of the row.
        progress: hears of every model.

    Raises:
        ShapewrightError: a model or a setting of the row is not fit for it.
    """
    if classifier_id not in _kept:
        from shapewright.modeling import compile_model
        from shapewright.training import TrainingSettings
        from shapewright.training.dataset import plan_learning

        with context.database.reading() as session:
            row = catalog.get_classifier(session, classifier_id)
        wanted = [*row.model_ids, *(row.negative_model_ids or ())]
        for model_id in set(_compiled) - set(wanted):
            del _compiled[model_id]
        for model_id in wanted:
            progress.report(0.0, "compiling models")
            if model_id not in _compiled:
                _compiled[model_id] = compile_model(context.load_model(model_id))
        classes: dict[str, list[CompiledModel]] = {}
        for model_id in row.model_ids:
            compiled = _compiled[model_id]
            classes.setdefault(compiled.model.class_name, []).append(compiled)
        negatives = [_compiled[model_id] for model_id in row.negative_model_ids or ()]
        settings = TrainingSettings(**with_tuples(row.settings))
        _kept.clear()
        _kept[classifier_id] = LearningPlan(plan_learning(classes, negatives, settings), settings)
    return _kept[classifier_id]
