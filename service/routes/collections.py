"""Collections: meshes that are indexed together, to be looked through."""

from typing import Any

from fastapi import APIRouter, BackgroundTasks, Depends, Response

from models_store import catalog
from models_store.errors import NotFoundError
from service.dependencies import CursorQuery, IdPath, LimitQuery, ServicesDep, now, require_json
from service.errors import reference_error
from service.routes import problems
from service.schemas.collections import CollectionDetailOut, CollectionIn, CollectionOut, CollectionPageOut
from service.schemas.jobs import AcceptedOut

router = APIRouter(prefix="/v1/collections", tags=["collections"])


@router.post(
    "",
    status_code=202,
    response_model=AcceptedOut,
    dependencies=[Depends(require_json)],
    responses=problems(409, 413, 415, 422, 503, 507),
)
def create_collection(services: ServicesDep, response: Response, after: BackgroundTasks, body: CollectionIn) -> Any:
    """Index meshes, so that they can be looked through; 409 if the classifier is not trained yet."""
    try:
        with services.database.writing() as session:
            row = catalog.request_collection(
                session,
                body.mesh_ids,
                body.classifier_id,
                name=body.name,
                now=now(),
                max_attempts=services.settings.max_attempts,
            )
    except NotFoundError as error:
        place = "classifier_id" if error.what == "classifier" else f"mesh_ids[{body.mesh_ids.index(error.identifier)}]"
        raise reference_error(error, place) from None
    after.add_task(services.announce, row.job)
    response.headers["Location"] = f"/v1/jobs/{row.job_id}"
    return AcceptedOut.from_row(row.job)


@router.get("", response_model=CollectionPageOut, responses=problems(422))
def list_collections(services: ServicesDep, limit: LimitQuery = 50, cursor: CursorQuery = None) -> Any:
    """List the collections, newest first."""
    with services.database.reading() as session:
        page = catalog.list_collections(session, limit=limit, cursor=cursor)
    return CollectionPageOut(items=[CollectionOut.from_row(row) for row in page.items], next_cursor=page.next_cursor)


@router.get("/{id}", response_model=CollectionDetailOut, responses=problems(404, 422))
def get_collection(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at a collection."""
    with services.database.reading() as session:
        return CollectionDetailOut.from_row(catalog.get_collection(session, id))
