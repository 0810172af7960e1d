"""Tell what an uploaded mesh is."""

from functools import partial
from io import BytesIO
from typing import Final

import numpy as np
import structlog
from jaxtyping import UInt8

from models_store import catalog
from models_store.errors import ArtifactError
from workers.classifiers import stored_classifier
from workers.context import JobContext, Outcome
from workers.finite import finite

log = structlog.get_logger(__name__)

_PICTURES_IN_A_ROW: Final = 5


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
    result = finite(
        {
            "class_name": answer.class_name,
            "answer": answer.answer,
            "known": answer.known,
            "probabilities": _listed(answer.probabilities, "probability"),
            "picture_probabilities": _listed(answer.picture_probabilities, "probability"),
            "distances": None if answer.distances is None else _listed(answer.distances, "distance"),
            "per_view": np.asarray(answer.per_view).tolist(),
            "seconds": context.seconds,
        }
    )
    key = _keep_pictures(context, identifier, answer.images)
    record = partial(catalog.record_classification, identifier=identifier, result=result, pictures_key=key)
    return Outcome(record, () if key is None else (key,))


def _keep_pictures(context: JobContext, identifier: str, images: UInt8[np.ndarray, "N H W 3"]) -> str | None:
    key = context.own_key(f"classifications/{identifier}", "png")
    try:
        context.artifacts.put(key, _png(images))
    except ArtifactError as error:  # the answer itself needs no room
        log.warning("pictures could not be kept", key=key, error=str(error))
        return None
    return key


def _listed(values: dict[str, float], what: str) -> list[dict[str, str | float]]:
    return [{"class_name": name, what: float(value)} for name, value in values.items()]


def _png(images: UInt8[np.ndarray, "N H W 3"]) -> bytes:
    """The pictures in rows of five, what is left of the last row in white."""
    from PIL import Image

    count, height, width, _ = images.shape
    columns = min(count, _PICTURES_IN_A_ROW)
    rows = -(-count // columns)
    cells = np.full((rows * columns, height, width, 3), 255, dtype=np.uint8)
    cells[:count] = images
    sheet = cells.reshape(rows, columns, height, width, 3).transpose(0, 2, 1, 3, 4)
    png = BytesIO()
    Image.fromarray(sheet.reshape(rows * height, columns * width, 3)).save(png, format="PNG", optimize=True)
    return png.getvalue()
