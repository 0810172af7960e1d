"""Classifications: ask what a mesh is."""

from typing import Any

from fastapi import APIRouter, BackgroundTasks, Depends, Request, Response

from models_store import catalog
from models_store.errors import NotFoundError
from service.conditional import immutable_response
from service.dependencies import CursorQuery, IdPath, LimitQuery, ServicesDep, now, require_json
from service.errors import Problem, ProblemError, reference_error
from service.routes import NOT_MODIFIED, binary, problems
from service.schemas.classifications import ClassificationIn, ClassificationOut, ClassificationPageOut
from service.schemas.jobs import AcceptedOut

router = APIRouter(prefix="/v1/classifications", tags=["classifications"])


@router.post(
    "",
    status_code=202,
    response_model=AcceptedOut,
    dependencies=[Depends(require_json)],
    responses=problems(409, 413, 415, 422, 503, 507),
)
def create_classification(
    services: ServicesDep, response: Response, after: BackgroundTasks, body: ClassificationIn
) -> Any:
    """Classify a mesh; 409 if the classifier is not trained yet."""
    try:
        with services.database.writing() as session:
            row = catalog.request_classification(
                session,
                body.mesh_id,
                body.classifier_id,
                {"views": body.views, "seed": body.seed, "fit": body.fit},
                now=now(),
                max_attempts=services.settings.max_attempts,
            )
    except NotFoundError as error:
        raise reference_error(error, f"{error.what}_id") from None
    after.add_task(services.announce, row.job)
    response.headers["Location"] = f"/v1/jobs/{row.job_id}"
    return AcceptedOut.from_row(row.job)


@router.get("", response_model=ClassificationPageOut, responses=problems(422))
def list_classifications(services: ServicesDep, limit: LimitQuery = 50, cursor: CursorQuery = None) -> Any:
    """List the classifications, newest first."""
    with services.database.reading() as session:
        page = catalog.list_classifications(session, limit=limit, cursor=cursor)
    return ClassificationPageOut(
        items=[ClassificationOut.from_row(row) for row in page.items], next_cursor=page.next_cursor
    )


@router.get("/{id}", response_model=ClassificationOut, responses=problems(404, 422))
def get_classification(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at a classification."""
    with services.database.reading() as session:
        return ClassificationOut.from_row(catalog.get_classification(session, id))


@router.get(
    "/{id}/pictures",
    response_class=Response,
    responses={
        **binary("image/png", "The pictures that were looked at, beside and below each other."),
        **NOT_MODIFIED,
        **problems(404, 422),
    },
)
def get_classification_pictures(request: Request, services: ServicesDep, id: IdPath) -> Response:  # noqa: A002
    """What the classifier saw of the mesh; 404 until there is an answer."""
    with services.database.reading() as session:
        row = catalog.get_classification(session, id)
    key = row.pictures_key
    if key is None:
        state = row.job.state.value
        raise ProblemError(
            Problem(404, "not-ready", "It is not ready yet", f"there are no pictures: this classification is {state}")
        )
    return immutable_response(request, f"{id}-pictures", "image/png", lambda: services.artifacts.get(key))
