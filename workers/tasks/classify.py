"""Tell what an uploaded mesh is."""

from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from models_store import catalog
from workers.context import JobContext, Outcome
from workers.finite import finite

if TYPE_CHECKING:
    from shapewright.classification import Classifier


_kept: "Final[dict[str, Classifier]]" = {}
"""The classifier of the last job by its key, as most jobs ask the same one; keys never change their content."""


def classify(context: JobContext) -> Outcome:
    """Ask the classifier of the classification's row about its mesh."""
    identifier = str(context.claim.payload["classification_id"])
    with context.database.reading() as session:
        row = catalog.get_classification(session, identifier)
        onnx_key = catalog.get_classifier(session, row.classifier_id).onnx_key
    context.progress.report(0.0, "reading the mesh")
    mesh = context.load_query(row.mesh_id)
    context.progress.report(0.3, "reading the classifier")
    classifier = _classifier(context, str(onnx_key))
    context.progress.report(0.6, "looking at the mesh")
    rng = np.random.default_rng(row.settings.get("seed", 0))
    answer = classifier.classify(mesh, views=row.settings.get("views", 10), rng=rng)
    ranked = sorted(answer.probabilities.items(), key=lambda pair: -pair[1])
    result = finite(
        {
            "class_name": answer.class_name,
            "probabilities": [{"class_name": name, "probability": float(p)} for name, p in ranked],
            "per_view": np.asarray(answer.per_view).tolist(),
            "seconds": context.seconds,
        }
    )
    return Outcome(partial(catalog.record_classification, identifier=identifier, result=result))


def _classifier(context: JobContext, onnx_key: str) -> "Classifier":
    from shapewright.classification import Classifier

    if onnx_key not in _kept:
        _kept.clear()
        _kept[onnx_key] = Classifier(context.artifacts.get(onnx_key))
    return _kept[onnx_key]
