"""Retrievals: ask which meshes of a collection are of a class, like a model, like a mesh."""

from typing import Any

from fastapi import APIRouter, BackgroundTasks, Depends, Request, Response

from models_store import catalog
from models_store.errors import NotFoundError
from service.conditional import immutable_response
from service.dependencies import CursorQuery, IdPath, LimitQuery, ServicesDep, now, require_json
from service.errors import Problem, ProblemError, reference_error
from service.routes import NOT_MODIFIED, binary, problems
from service.schemas.jobs import AcceptedOut
from service.schemas.retrievals import RetrievalIn, RetrievalOut, RetrievalPageOut
from shapewright.retrieval.ranking import default_evidence

router = APIRouter(prefix="/v1/retrievals", tags=["retrievals"])


@router.post(
    "",
    status_code=202,
    response_model=AcceptedOut,
    dependencies=[Depends(require_json)],
    responses=problems(409, 413, 415, 422, 503, 507),
)
def create_retrieval(services: ServicesDep, response: Response, after: BackgroundTasks, body: RetrievalIn) -> Any:
    """Order the meshes of a collection by their likeness to a class, a model or a mesh; 409 if it has no index yet."""
    if sum(query is not None for query in (body.class_name, body.model_id, body.mesh_id)) != 1:
        detail = "name exactly one of class_name, model_id and mesh_id"
        raise ProblemError(
            Problem(422, "request-invalid", "The request does not fit the schema", detail, where="class_name")
        )
    try:
        with services.database.writing() as session:
            row = catalog.request_retrieval(
                session,
                body.collection_id,
                body.model_dump(include={"limit", "instances", "seed"})
                | {"evidence": body.evidence or default_evidence(body.class_name)},
                class_name=body.class_name,
                model_id=body.model_id,
                mesh_id=body.mesh_id,
                now=now(),
                max_attempts=services.settings.max_attempts,
            )
    except NotFoundError as error:
        raise reference_error(error, f"{error.what}_id") from None
    after.add_task(services.announce, row.job)
    response.headers["Location"] = f"/v1/jobs/{row.job_id}"
    return AcceptedOut.from_row(row.job)


@router.get("", response_model=RetrievalPageOut, responses=problems(422))
def list_retrievals(services: ServicesDep, limit: LimitQuery = 50, cursor: CursorQuery = None) -> Any:
    """List the retrievals, newest first."""
    with services.database.reading() as session:
        page = catalog.list_retrievals(session, limit=limit, cursor=cursor)
    return RetrievalPageOut(items=[RetrievalOut.from_row(row) for row in page.items], next_cursor=page.next_cursor)


@router.get("/{id}", response_model=RetrievalOut, responses=problems(404, 422))
def get_retrieval(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at a retrieval."""
    with services.database.reading() as session:
        return RetrievalOut.from_row(catalog.get_retrieval(session, id))


@router.get(
    "/{id}/contact-sheet",
    response_class=Response,
    responses={
        **binary("image/png", "Pictures of the first meshes, with names and scores."),
        **NOT_MODIFIED,
        **problems(404, 422),
    },
)
def get_contact_sheet(request: Request, services: ServicesDep, id: IdPath) -> Response:  # noqa: A002
    """Pictures of the first meshes; 404 until there are some."""
    with services.database.reading() as session:
        row = catalog.get_retrieval(session, id)
    key = row.sheet_key
    if key is None:
        detail = f"nothing is drawn: this retrieval is {row.job.state.value}"
        raise ProblemError(Problem(404, "not-ready", "It is not ready yet", detail))
    return immutable_response(request, f"{id}-sheet", "image/png", lambda: services.artifacts.get(key))
