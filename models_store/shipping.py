"""Seeding of a database with the shipped models, their thumbnails and the ready classifier."""

import hashlib
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path

from models_store import catalog
from models_store.artifacts import ArtifactStore
from models_store.catalog import ShippedItem, ShippedKind
from models_store.library.shipped import list_shipped, thumbnail_png
from models_store.session import Database
from shapewright.classification.file_format import exemplars_file, read_metadata
from shapewright.classification.ready_files import READY_FILE, ready_classifier_place
from shapewright.errors import ClassifierError

READY_NAME = "ready"


def add_shipped(
    database: Database, artifacts: ArtifactStore, *, now: datetime, ready_dir: Path | None = None
) -> list[str]:
    """Add the shipped models and the ready classifier that this database was never given; return the names of these.

    Several processes may do so at once. A new version of a model is added beside the older one, unless that was
    deleted. Where nothing is new, files are read and compared, and nothing is parsed or written.

    Args:
        database: upgraded to the newest revision.
        artifacts: where thumbnails and the classifier are kept.
        now: the time, with a zone.
        ready_dir: folder of the ready classifier; ``None`` is the one that ships, which may be missing.

    Raises:
        ArtifactError: the artefacts cannot be written; nothing is added.
        ClassifierError: the ready classifier is missing where it was said to be, or damaged; the models are added.
    """
    documents = {name: document.read_bytes() for name, document in list_shipped().items()}
    added = _add_models(database, artifacts, documents, now)
    classifier = ready_classifier_place() if ready_dir is None else ready_dir / READY_FILE
    if classifier.is_file():
        added += _add_classifier(database, artifacts, classifier, now)
    elif ready_dir is not None:
        raise ClassifierError("the file does not exist", where=str(classifier))
    return added


def _add_models(
    database: Database, artifacts: ArtifactStore, documents: Mapping[str, bytes], now: datetime
) -> list[str]:
    # Documents ship in their canonical form, so their digests are the ids of their models.
    items = [ShippedItem(ShippedKind.MODEL, name, _sha256(document)) for name, document in documents.items()]
    with database.reading() as session:
        missing = catalog.missing_shipped(session, items)
    if not missing:
        return []
    from shapewright.modeling import ProceduralModel

    models = {item: ProceduralModel.from_json(documents[item.name]) for item in missing}
    keys = {item: f"thumbnails/{item.digest}-shipped.png" for item in missing}
    for item, key in keys.items():
        artifacts.put(key, thumbnail_png(item.name))
    with database.writing() as session:
        return [
            item.name
            for item, model in models.items()
            if catalog.add_shipped_model(
                session, item, model, documents[item.name].decode(), thumbnail_key=keys[item], now=now
            )
        ]


def _add_classifier(database: Database, artifacts: ArtifactStore, file: Path, now: datetime) -> list[str]:
    onnx, beside = file.read_bytes(), exemplars_file(file)
    exemplars = beside.read_bytes() if beside.is_file() else None
    item = ShippedItem(ShippedKind.CLASSIFIER, READY_NAME, _sha256(onnx + (exemplars or b"")))
    with database.reading() as session:
        if not catalog.missing_shipped(session, [item]):
            return []
    metadata = read_metadata(onnx)
    onnx_key = f"classifiers/{item.digest}-shipped.onnx"
    artifacts.put(onnx_key, onnx)
    exemplars_key = None
    if exemplars is not None:
        exemplars_key = f"classifiers/{item.digest}-shipped.npz"
        artifacts.put(exemplars_key, exemplars)
    with database.writing() as session:
        is_new = catalog.add_shipped_classifier(
            session,
            item,
            onnx_key=onnx_key,
            exemplars_key=exemplars_key,
            model_ids=[model["digest"] for model in metadata["models"]],
            class_names=metadata["class_names"],
            settings=metadata["settings"],
            metrics=metadata["metrics"],
            now=now,
        )
    return [READY_NAME] if is_new else []


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
