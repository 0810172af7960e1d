"""Tell what an uploaded mesh is."""

from functools import partial

import numpy as np

from models_store import catalog
from workers.classifiers import stored_classifier
from workers.context import JobContext, Outcome
from workers.finite import finite


def classify(context: JobContext) -> Outcome:
    """Ask the classifier of the classification's row about its mesh."""
    identifier = str(context.claim.payload["classification_id"])
    with context.database.reading() as session:
        row = catalog.get_classification(session, identifier)
    context.progress.report(0.0, "reading the mesh")
    mesh = context.load_query(row.mesh_id)
    context.progress.report(0.3, "reading the classifier")
    classifier = stored_classifier(context, row.classifier_id).classifier
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
