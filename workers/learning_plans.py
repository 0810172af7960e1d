"""What a classifier's row asks to be learned, compiled and ready to be worked on."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from models_store import catalog
from models_store.tables import ClassifierRow
from shapewright.progress import Progress
from workers.context import JobContext, with_tuples
from workers.stored.classifiers import stored_base

if TYPE_CHECKING:
    from shapewright.modeling import CompiledModel
    from shapewright.network import FeatureExtractor
    from shapewright.training import TrainingSettings
    from shapewright.training.dataset import Plan
    from shapewright.training.extending import Extension


@dataclass(frozen=True, eq=False)
class LearningPlan:
    """The chunks that a training needs, and what computes them.

    Args:
        plan: the chunks.
        settings: by which they are drawn.
        extension: what is extended; ``None`` for a training from scratch.
    """

    plan: "Plan"
    settings: "TrainingSettings"
    extension: "Extension | None" = None

    @cached_property
    def extractor(self) -> "FeatureExtractor":
        """The backbone, loaded with the first use."""
        from shapewright.network import FeatureExtractor, load_backbone

        extension = self.extension
        backbone = load_backbone(self.settings.backbone) if extension is None else extension.backbone
        return FeatureExtractor(backbone, threads=1)


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
        ShapewrightError: a model, a setting or the base of the row is not fit for it.
    """
    if classifier_id not in _kept:
        from shapewright.modeling import compile_model

        with context.database.reading() as session:
            row = catalog.get_classifier(session, classifier_id)
        wanted = [*row.model_ids, *(row.negative_model_ids or ())]
        for model_id in set(_compiled) - set(wanted):
            del _compiled[model_id]
        for model_id in wanted:
            progress.report(0.0, "compiling models")
            if model_id not in _compiled:
                _compiled[model_id] = compile_model(context.load_model(model_id))
        _kept.clear()
        _kept[classifier_id] = _planned(context, row)
    return _kept[classifier_id]


def _planned(context: JobContext, row: ClassifierRow) -> LearningPlan:
    """Plan what the row asks for, with models that are compiled."""
    from shapewright.training import ExtensionSettings, TrainingSettings
    from shapewright.training.dataset import plan_learning
    from shapewright.training.extending import plan_extension

    base = None if row.base_classifier_id is None else stored_base(context, row.base_classifier_id)
    known = set() if base is None else {model["digest"] for model in base.metadata["models"]}
    classes: dict[str, list[CompiledModel]] = {}
    for model_id in row.model_ids:
        compiled = _compiled[model_id]
        if model_id not in known:
            classes.setdefault(compiled.model.class_name, []).append(compiled)
    negatives = [_compiled[model_id] for model_id in row.negative_model_ids or ()]
    if base is None:
        settings = TrainingSettings(**with_tuples(row.settings))
        return LearningPlan(plan_learning(classes, negatives, settings), settings)
    extension = plan_extension(
        base,
        classes,
        known=[_compiled[model_id] for model_id in row.model_ids if model_id in known],
        negatives=negatives,
        settings=ExtensionSettings(**row.settings),
    )
    return LearningPlan(extension.plan, extension.drawing, extension)
