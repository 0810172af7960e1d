"""Classifiers: train, look at, download."""

from typing import Any

from fastapi import APIRouter, BackgroundTasks, Depends, Request, Response

from models_store import catalog
from models_store.errors import NotFoundError
from service.conditional import immutable_response
from service.dependencies import CursorQuery, IdPath, LimitQuery, ServicesDep, now, require_json
from service.errors import Problem, ProblemError, reference_error
from service.routes import NOT_MODIFIED, binary, problems
from service.schemas.classifiers import ClassifierIn, ClassifierOut, ClassifierPageOut
from service.schemas.jobs import AcceptedOut

router = APIRouter(prefix="/v1/classifiers", tags=["classifiers"])


@router.post(
    "",
    status_code=202,
    response_model=AcceptedOut,
    dependencies=[Depends(require_json)],
    responses=problems(409, 413, 415, 422, 503, 507),
)
def create_classifier(services: ServicesDep, response: Response, after: BackgroundTasks, body: ClassifierIn) -> Any:
    """Train a classifier on variations of procedural models, or add classes to one that is trained."""
    settings = body.settings.checked(extending=body.base_classifier_id is not None)
    try:
        with services.database.writing() as session:
            row = catalog.request_classifier(
                session,
                body.model_ids,
                settings,
                negative_model_ids=body.negative_model_ids,
                base_classifier_id=body.base_classifier_id,
                name=body.name,
                now=now(),
                max_attempts=services.settings.max_attempts,
            )
    except NotFoundError as error:
        if error.what == "classifier":
            raise reference_error(error, "base_classifier_id") from None
        name = "model_ids" if error.identifier in body.model_ids else "negative_model_ids"
        index = getattr(body, name).index(error.identifier)
        raise reference_error(error, f"{name}[{index}]") from None
    assert row.job is not None, "what is asked for has a job"
    after.add_task(services.announce, row.job)
    response.headers["Location"] = f"/v1/jobs/{row.job_id}"
    return AcceptedOut.from_row(row.job)


@router.get("", response_model=ClassifierPageOut, responses=problems(422))
def list_classifiers(services: ServicesDep, limit: LimitQuery = 50, cursor: CursorQuery = None) -> Any:
    """List the classifiers, newest first."""
    with services.database.reading() as session:
        page = catalog.list_classifiers(session, limit=limit, cursor=cursor)
    return ClassifierPageOut(items=[ClassifierOut.from_row(row) for row in page.items], next_cursor=page.next_cursor)


@router.get("/{id}", response_model=ClassifierOut, responses=problems(404, 422))
def get_classifier(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at a classifier."""
    with services.database.reading() as session:
        return ClassifierOut.from_row(catalog.get_classifier(session, id))


@router.get(
    "/{id}/onnx",
    response_class=Response,
    responses={
        **binary("application/octet-stream", "The ONNX file; it takes images and knows its classes."),
        **NOT_MODIFIED,
        **problems(404, 422),
    },
)
def get_classifier_onnx(request: Request, services: ServicesDep, id: IdPath) -> Response:  # noqa: A002
    """The classifier's ONNX file; 404 until the training has succeeded."""
    with services.database.reading() as session:
        row = catalog.get_classifier(session, id)
    key = row.onnx_key
    if key is None:
        state = row.state.value
        raise ProblemError(
            Problem(404, "not-ready", "It is not ready yet", f"the training of this classifier is {state}")
        )
    response = immutable_response(
        request, f"{id}-onnx", "application/octet-stream", lambda: services.artifacts.get(key)
    )
    response.headers["Content-Disposition"] = f'attachment; filename="classifier-{id[:12]}.onnx"'
    return response


@router.get(
    "/{id}/exemplars",
    response_class=Response,
    responses={
        **binary("application/octet-stream", "The exemplars (.npz); they go with the ONNX file."),
        **NOT_MODIFIED,
        **problems(404, 422),
    },
)
def get_classifier_exemplars(request: Request, services: ServicesDep, id: IdPath) -> Response:  # noqa: A002
    """The geometry of the variations that the classifier learned from; 404 until there is one."""
    with services.database.reading() as session:
        row = catalog.get_classifier(session, id)
    key = row.exemplars_key
    if key is None:
        state = row.state.value
        detail = "it has none" if row.onnx_key else f"the training of this classifier is {state}"
        raise ProblemError(Problem(404, "not-ready", "It is not ready yet", detail))
    response = immutable_response(
        request, f"{id}-exemplars", "application/octet-stream", lambda: services.artifacts.get(key)
    )
    response.headers["Content-Disposition"] = f'attachment; filename="classifier-{id[:12]}.exemplars.npz"'
    return response
