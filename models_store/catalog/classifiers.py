"""Classifiers: asked for with a training job, complete once their ONNX file is there."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.catalog.models import get_model, known_models
from models_store.catalog.rows import get_row
from models_store.catalog.shipped import shipped_classifier
from models_store.errors import NotReadyError, StoreError
from models_store.jobs import JobKind, create_job, new_id
from models_store.paging import Page, fetch_page
from models_store.tables import ClassifierRow
from models_store.text import storable


def request_classifier(
    session: Session,
    model_ids: Sequence[str],
    settings: dict[str, Any],
    *,
    negative_model_ids: Sequence[str] = (),
    base_classifier_id: str | None = None,
    name: str | None = None,
    now: datetime,
    max_attempts: int = 3,
) -> ClassifierRow:
    """Queue the training of a classifier on these models; the row's ``job`` is the job.

    Args:
        session: a writing session.
        model_ids: the models; several may share a class. Repeated ids count once.
        settings: fields of :class:`shapewright.training.TrainingSettings` that differ from the default, or of
            :class:`shapewright.training.ExtensionSettings` if a base is given.
        negative_model_ids: models of things that are of none of the classes. Repeated ids count once. Without any, a
            classifier that is extended gives those that it was trained with.
        base_classifier_id: the classifier that is extended by the classes of the models.
        name: a name for people.
        now: the time, with a zone.
        max_attempts: of the job.

    Raises:
        NotFoundError: a model or the base is not there.
        NotReadyError: the base is not trained.
        StoreError: the models are of fewer than two classes, so there is nothing to tell apart; a negative model is
            of one of them; the base knows one of the classes, or models of the base are not there.
    """
    unique_ids = list(dict.fromkeys(model_ids))
    classes = {model_id: get_model(session, model_id).class_name for model_id in unique_ids}
    class_names = sorted(set(classes.values()))
    if base_classifier_id is not None:
        base = _base(session, base_classifier_id)
        for model_id, class_name in classes.items():
            if class_name in base.class_names:
                raise StoreError(
                    f"the base classifier knows the class {class_name!r} already",
                    where=f"model_ids[{list(model_ids).index(model_id)}]",
                )
        negative_model_ids = negative_model_ids or [
            row.id for row in known_models(session, base.negative_model_ids or []) if row.class_name not in class_names
        ]
        class_names, unique_ids = [*base.class_names, *class_names], [*base.model_ids, *unique_ids]
    if len(class_names) < 2:
        raise StoreError("a classifier needs models of at least two classes", where="model_ids")
    negative_ids = list(dict.fromkeys(negative_model_ids))
    for model_id in negative_ids:
        class_name = get_model(session, model_id).class_name
        if class_name in class_names:
            place = list(negative_model_ids).index(model_id)
            raise StoreError(
                f"the model is of the class {class_name!r}, which the classifier learns",
                where=f"negative_model_ids[{place}]",
            )
    identifier = new_id()
    payload = {"classifier_id": identifier}
    job = create_job(session, JobKind.TRAIN_CLASSIFIER, identifier, payload, now=now, max_attempts=max_attempts)
    row = ClassifierRow(
        id=identifier,
        job=job,
        name=None if name is None else storable(name, limit=200),
        base_classifier_id=base_classifier_id,
        model_ids=unique_ids,
        negative_model_ids=negative_ids,
        class_names=class_names,
        settings=settings,
        created_at=now,
    )
    session.add(row)
    session.flush()
    return row


def _base(session: Session, identifier: str) -> ClassifierRow:
    """Return a classifier that can be extended."""
    row = get_classifier(session, identifier)
    where = "base_classifier_id"
    if row.onnx_key is None:
        raise NotReadyError(f"this classifier is not trained (its job is {row.state.value})", where=where)
    there = {model.id for model in known_models(session, row.model_ids)}
    if missing := [model_id for model_id in row.model_ids if model_id not in there]:
        raise StoreError(
            f"{len(missing)} of the models that this classifier has learned from are not here, "
            f"for example {missing[0]!r}; upload them to extend it",
            where=where,
        )
    return row


def record_classifier(
    session: Session,
    identifier: str,
    *,
    onnx_key: str,
    class_names: Sequence[str],
    metrics: dict[str, Any],
    seconds: float,
    exemplars_key: str | None = None,
) -> None:
    """Write the outcome of a training; in the transaction that ends the job."""
    row = get_classifier(session, identifier)
    row.onnx_key = onnx_key
    row.exemplars_key = exemplars_key
    row.class_names = list(class_names)
    row.metrics = metrics
    row.seconds = seconds


def get_classifier(session: Session, identifier: str) -> ClassifierRow:
    """The classifier with this id, whatever its state.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, ClassifierRow, "classifier", identifier)


def newest_classifier(session: Session) -> ClassifierRow | None:
    """The newest classifier whose training has succeeded."""
    query = select(ClassifierRow).where(ClassifierRow.onnx_key.is_not(None))
    order = (ClassifierRow.created_at.desc(), ClassifierRow.id.desc())
    return session.scalars(query.order_by(*order).limit(1)).one_or_none()


def ready_classifier(session: Session, identifier: str | None) -> ClassifierRow:
    """The classifier that is to be asked; ``None`` is the one that ships, or without it the newest that is trained.

    Raises:
        NotFoundError: there is none with this id.
        NotReadyError: it is not trained yet, or there is none at all.
    """
    if identifier is None:
        found = shipped_classifier(session) or newest_classifier(session)
        if found is None:
            raise NotReadyError("no classifier is ready; train one with POST /v1/classifiers", where="classifier_id")
        return found
    row = get_classifier(session, identifier)
    if row.onnx_key is None:
        raise NotReadyError(f"this classifier is not trained (its job is {row.state.value})", where="classifier_id")
    return row


def list_classifiers(session: Session, *, limit: int = 50, cursor: str | None = None) -> Page[ClassifierRow]:
    """One page of classifiers, newest first.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    return fetch_page(session, select(ClassifierRow), ClassifierRow, limit=limit, cursor=cursor)
