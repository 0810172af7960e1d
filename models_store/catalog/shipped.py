"""What ships with a release: each version is added to a database once, and what was deleted stays deleted."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.catalog.models import add_model
from models_store.catalog.rows import insert_once
from models_store.tables import ClassifierRow, ModelRow, ShippedRow

if TYPE_CHECKING:
    from shapewright.modeling import ProceduralModel

_CLASSIFIER_ID_LENGTH = 32


class ShippedKind(StrEnum):
    """The kinds of things that ship."""

    MODEL = "model"
    CLASSIFIER = "classifier"


@dataclass(frozen=True)
class ShippedItem:
    """One version of something that ships.

    Args:
        kind: what it is.
        name: shared by all versions of it.
        digest: SHA-256 of its content.
    """

    kind: ShippedKind
    name: str
    digest: str


def missing_shipped(session: Session, items: Sequence[ShippedItem]) -> list[ShippedItem]:
    """Return the items that are to be added.

    An item is left out if this version was added before, or if every earlier version of it has been deleted.
    """
    added: dict[tuple[str, str], list[str]] = {}
    for row in session.scalars(select(ShippedRow)):
        added.setdefault((row.kind, row.name), []).append(row.id)
    digests = [digest for versions in added.values() for digest in versions]
    present = {
        *session.scalars(select(ModelRow.id).where(ModelRow.id.in_(digests))),
        *session.scalars(select(ClassifierRow.id).where(ClassifierRow.id.in_(map(classifier_id_of, digests)))),
    }

    def is_missing(item: ShippedItem) -> bool:
        versions = added.get((item.kind, item.name))
        if versions is None:
            return True
        ids = versions if item.kind is ShippedKind.MODEL else map(classifier_id_of, versions)
        return item.digest not in versions and not present.isdisjoint(ids)

    return [item for item in items if is_missing(item)]


def add_shipped_model(
    session: Session, item: ShippedItem, model: "ProceduralModel", document: str, *, thumbnail_key: str, now: datetime
) -> bool:
    """Add a model that ships; return whether this version had not been added before.

    Args:
        session: a writing session.
        item: what it is.
        model: the model itself.
        document: its canonical text.
        thumbnail_key: where its picture is.
        now: the time, with a zone.
    """
    if not _mark(session, item, now):
        return False
    row, _ = add_model(session, model, now=now, document=document)
    row.thumbnail_key = row.thumbnail_key or thumbnail_key
    return True


def add_shipped_classifier(
    session: Session,
    item: ShippedItem,
    *,
    onnx_key: str,
    exemplars_key: str | None,
    model_ids: Sequence[str],
    class_names: Sequence[str],
    settings: dict[str, Any],
    metrics: dict[str, Any],
    now: datetime,
) -> bool:
    """Add a classifier that ships; return whether this version had not been added before.

    Args:
        session: a writing session.
        item: what it is.
        onnx_key: where its file is.
        exemplars_key: where its exemplars are, if it has any.
        model_ids: the models that it learned from; they need not be in the catalog.
        class_names: in the order of its outputs.
        settings: of its training.
        metrics: of its training.
        now: the time, with a zone.
    """
    if not _mark(session, item, now):
        return False
    row = ClassifierRow(
        id=classifier_id_of(item.digest),
        name=item.name,
        model_ids=list(model_ids),
        negative_model_ids=[],
        class_names=list(class_names),
        settings=settings,
        metrics=metrics,
        onnx_key=onnx_key,
        exemplars_key=exemplars_key,
        created_at=now,
    )
    insert_once(session, row)
    return True


def shipped_classifier(session: Session) -> ClassifierRow | None:
    """The newest classifier that ships and has not been deleted."""
    marks = select(ShippedRow.id).where(ShippedRow.kind == ShippedKind.CLASSIFIER.value)
    for digest in session.scalars(marks.order_by(ShippedRow.created_at.desc(), ShippedRow.id)):
        row = session.get(ClassifierRow, classifier_id_of(digest))
        if row is not None:
            return row
    return None


def classifier_id_of(digest: str) -> str:
    """The id of a classifier that ships: the beginning of its digest, as ids of classifiers are short."""
    return digest[:_CLASSIFIER_ID_LENGTH]


def _mark(session: Session, item: ShippedItem, now: datetime) -> bool:
    """Note that a version is added. Of several processes that start at once, one alone is told that it is new."""
    _, is_new = insert_once(session, ShippedRow(id=item.digest, kind=item.kind.value, name=item.name, created_at=now))
    return is_new
