"""Classifications: ask what a mesh is."""

from typing import Any

from fastapi import APIRouter, BackgroundTasks, Depends, Response

from models_store import catalog
from models_store.errors import NotFoundError
from service.dependencies import CursorQuery, IdPath, LimitQuery, ServicesDep, now, require_json
from service.errors import reference_error
from service.routes import problems
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
                {"views": body.views, "seed": body.seed},
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
