"""Train a classifier on procedural models and keep it: one ONNX file, and exemplars beside it."""

from functools import partial

from models_store import catalog
from models_store.job_kinds import JobKind
from shapewright.progress import PartialProgress, Progress
from workers.context import JobContext, Outcome
from workers.finite import finite
from workers.learning_plans import LearningPlan, learning_plan
from workers.shared_parts import SharedParts
from workers.stored.arrays import ArtifactArrays
from workers.stored.classifiers import store_classifier


def train_classifier(context: JobContext) -> Outcome:
    """Train on all models of the classifier's row, grouped by class, or extend its base by the new ones.

    What was computed before is read again.
    """
    from shapewright.training.extending import learn_extension
    from shapewright.training.learning import IMAGES_SHARE, learn

    classifier_id = str(context.claim.payload["classifier_id"])
    work = learning_plan(context, classifier_id, context.progress)
    store = ArtifactArrays.of(context)
    _draw_and_describe(context, work, store, PartialProgress(context.progress, 0.0, IMAGES_SHARE))
    learning = PartialProgress(context.progress, IMAGES_SHARE, 1.0)
    if work.extension is None:
        trained = learn(work.plan, work.settings, store, learning)
    else:
        trained = learn_extension(work.extension, store, learning)
    keys = store_classifier(context, classifier_id, trained)
    record = partial(
        catalog.record_classifier,
        identifier=classifier_id,
        onnx_key=keys.onnx,
        exemplars_key=keys.exemplars,
        class_names=list(trained.class_names),
        metrics=finite(dict(trained.metrics)),
        seconds=context.seconds,
    )
    return Outcome(record, keys.all)


def _draw_and_describe(context: JobContext, work: LearningPlan, store: ArtifactArrays, progress: Progress) -> None:
    """Compute what the store lacks, together with workers that have nothing else to do."""
    from shapewright.training.chunks import is_stored, store_chunk

    def missing() -> list[int]:
        backbone = work.extractor.backbone
        return [
            number
            for number, (chunk, described) in enumerate(work.plan.chunks)
            if not is_stored(chunk, work.settings, backbone, store, described)
        ]

    def compute(number: int, part: Progress) -> None:
        chunk, described = work.plan.chunks[number]
        store_chunk(chunk, work.settings, work.extractor, store, described=described, progress=part)

    numbers = missing()
    identifier = context.claim.payload["classifier_id"]
    payloads = [{"classifier_id": identifier, "chunk": number} for number in numbers]
    for index, done in SharedParts(context, JobKind.DESCRIBE_VARIATIONS, payloads).mine(progress):
        compute(numbers[index], PartialProgress(progress, done, done + 1 / len(numbers)))
    for number in missing():  # what failed at another worker, where this one says why if it fails again
        compute(number, PartialProgress(progress, 1.0, 1.0))
