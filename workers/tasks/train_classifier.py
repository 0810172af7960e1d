"""Train a classifier on procedural models and keep it as one ONNX file."""

from functools import partial

from models_store import catalog
from workers.context import JobContext, Outcome, with_tuples
from workers.finite import finite


def train_classifier(context: JobContext) -> Outcome:
    """Train on all models of the classifier's row, grouped by class."""
    from shapewright.classification import TrainingSettings
    from shapewright.classification import train_classifier as train
    from shapewright.modeling import CompiledModel

    classifier_id = str(context.claim.payload["classifier_id"])
    with context.database.reading() as session:
        row = catalog.get_classifier(session, classifier_id)
    context.progress.report(0.0, "compiling models")
    models_by_class: dict[str, list[CompiledModel]] = {}
    for model_id in row.model_ids:
        model = context.load_model(model_id)
        models_by_class.setdefault(model.class_name, []).append(model.compile())
    trained = train(models_by_class, TrainingSettings(**with_tuples(row.settings)), context.progress)
    key = context.own_key(f"classifiers/{classifier_id}", "onnx")
    context.artifacts.put(key, trained.onnx)
    record = partial(
        catalog.record_classifier,
        identifier=classifier_id,
        onnx_key=key,
        class_names=list(trained.class_names),
        metrics=finite(dict(trained.metrics)),
        seconds=context.seconds,
    )
    return Outcome(record, (key,))
