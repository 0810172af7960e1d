"""Train a classifier on procedural models and keep it: one ONNX file, and exemplars beside it."""

import tempfile
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from models_store import catalog
from workers.array_store import ArtifactArrays
from workers.context import JobContext, Outcome, with_tuples
from workers.finite import finite

if TYPE_CHECKING:
    from shapewright.classification.exemplars import Exemplars
    from shapewright.modeling import CompiledModel


def train_classifier(context: JobContext) -> Outcome:
    """Train on all models of the classifier's row, grouped by class; what was computed before is read again."""
    from shapewright.classification import TrainingSettings
    from shapewright.classification import train_classifier as train

    classifier_id = str(context.claim.payload["classifier_id"])
    with context.database.reading() as session:
        row = catalog.get_classifier(session, classifier_id)
    context.progress.report(0.0, "compiling models")
    models_by_class: dict[str, list[CompiledModel]] = {}
    for model_id in row.model_ids:
        model = context.load_model(model_id)
        models_by_class.setdefault(model.class_name, []).append(model.compile())
    trained = train(
        models_by_class,
        TrainingSettings(**with_tuples(row.settings)),
        context.progress,
        negatives=[context.load_model(model_id).compile() for model_id in row.negative_model_ids or ()],
        store=ArtifactArrays(context.artifacts, context.settings.data_dir / "cache"),
    )
    onnx_key = context.own_key(f"classifiers/{classifier_id}", "onnx")
    keys = [onnx_key]
    exemplars_key = None
    if trained.exemplars is not None:
        exemplars_key = context.own_key(f"classifiers/{classifier_id}", "npz")
        keys.append(exemplars_key)
        context.artifacts.put(exemplars_key, _file_content(trained.exemplars))
    context.artifacts.put(onnx_key, trained.onnx)
    record = partial(
        catalog.record_classifier,
        identifier=classifier_id,
        onnx_key=onnx_key,
        exemplars_key=exemplars_key,
        class_names=list(trained.class_names),
        metrics=finite(dict(trained.metrics)),
        seconds=context.seconds,
    )
    return Outcome(record, tuple(keys))


def _file_content(exemplars: "Exemplars") -> bytes:
    with tempfile.TemporaryDirectory(prefix="shapewright-exemplars-") as folder:
        path = Path(folder) / "exemplars.npz"
        exemplars.save(path)
        return path.read_bytes()
