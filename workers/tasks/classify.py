"""Tell what an uploaded mesh is."""

from collections.abc import Mapping
from functools import partial
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np
import structlog
from jaxtyping import UInt8

from models_store import catalog
from models_store.errors import ArtifactError
from workers.context import JobContext, Outcome
from workers.finite import finite
from workers.stored.classifiers import stored_classifier
from workers.stored.models import StoredModels

if TYPE_CHECKING:
    from shapewright.classification import Exemplars
    from shapewright.classification.neighbor import Neighbor
    from shapewright.modeling import CompiledModel

log = structlog.get_logger(__name__)


def classify(context: JobContext) -> Outcome:
    """Ask the classifier of the classification's row about its mesh."""
    identifier = str(context.claim.payload["classification_id"])
    with context.database.reading() as session:
        row = catalog.get_classification(session, identifier)
    context.progress.report(0.0, "reading the mesh")
    mesh = context.load_query(row.mesh_id)
    context.progress.report(0.3, "reading the classifier")
    classifier = stored_classifier(context, row.classifier_id).classifier
    models = StoredModels(context, row.classifier_id)
    context.progress.report(0.6, "looking at the mesh")
    answer = classifier.classify(
        mesh,
        views=row.settings.get("views", 10),
        rng=np.random.default_rng(row.settings.get("seed", 0)),
        models=models if row.settings.get("fit") else None,
    )
    neighbor = None
    if answer.neighbor is not None and classifier.exemplars is not None:
        neighbor = _with_values(answer.neighbor, classifier.exemplars, models)
    result = finite(answer.to_dict() | {"neighbor": neighbor, "seconds": context.seconds})
    key = _keep_pictures(context, identifier, answer.images)
    record = partial(catalog.record_classification, identifier=identifier, result=result, pictures_key=key)
    return Outcome(record, () if key is None else (key,))


def _with_values(neighbor: "Neighbor", exemplars: "Exemplars", models: "Mapping[str, CompiledModel]") -> dict[str, Any]:
    """Add the parameter values of the nearest variation; ``None`` if its model is not in the catalog."""
    model = models.get(neighbor.digest)
    return neighbor.to_dict() | {"values": None if model is None else exemplars.values(neighbor.row, model)}


def _keep_pictures(context: JobContext, identifier: str, images: UInt8[np.ndarray, "N H W 3"]) -> str | None:
    key = context.own_key(f"classifications/{identifier}", "png")
    try:
        context.artifacts.put(key, _png(images))
    except ArtifactError as error:  # the answer itself needs no room
        log.warning("pictures could not be kept", key=key, error=str(error))
        return None
    return key


def _png(images: UInt8[np.ndarray, "N H W 3"]) -> bytes:
    from PIL import Image

    from shapewright.rendering import compose_grid

    png = BytesIO()
    Image.fromarray(compose_grid(images)).save(png, format="PNG", optimize=True)
    return png.getvalue()
