"""Estimations: ask which parameter values rebuild a mesh."""

from typing import Any

from fastapi import APIRouter, BackgroundTasks, Depends, Request, Response

from models_store import catalog
from models_store.errors import NotFoundError
from models_store.tables import EstimationRow
from service.conditional import immutable_response
from service.dependencies import CursorQuery, IdPath, LimitQuery, ServicesDep, now, require_json
from service.errors import Problem, ProblemError, reference_error
from service.routes import NOT_MODIFIED, binary, problems
from service.schemas.estimations import EstimationIn, EstimationOut, EstimationPageOut
from service.schemas.jobs import AcceptedOut
from shapewright.mesh import glb

router = APIRouter(prefix="/v1/estimations", tags=["estimations"])


@router.post(
    "",
    status_code=202,
    response_model=AcceptedOut,
    dependencies=[Depends(require_json)],
    responses=problems(413, 415, 422, 503, 507),
)
def create_estimation(services: ServicesDep, response: Response, after: BackgroundTasks, body: EstimationIn) -> Any:
    """Estimate the parameter values with which a model, or the best one of a class, rebuilds a mesh."""
    settings = body.settings.checked()
    if (body.model_id is None) == (body.class_name is None):
        detail = "name either a model or a class"
        raise ProblemError(
            Problem(422, "request-invalid", "The request does not fit the schema", detail, where="model_id")
        )
    try:
        with services.database.writing() as session:
            row = catalog.request_estimation(
                session,
                body.mesh_id,
                body.model_id,
                settings,
                class_name=body.class_name,
                units=body.units,
                up=body.up,
                time_limit_s=body.time_limit_s,
                now=now(),
                max_attempts=services.settings.max_attempts,
            )
    except NotFoundError as error:
        raise reference_error(error, "class_name" if error.what == "class" else f"{error.what}_id") from None
    after.add_task(services.announce, row.job)
    response.headers["Location"] = f"/v1/jobs/{row.job_id}"
    return AcceptedOut.from_row(row.job)


@router.get("", response_model=EstimationPageOut, responses=problems(422))
def list_estimations(services: ServicesDep, limit: LimitQuery = 50, cursor: CursorQuery = None) -> Any:
    """List the estimations, newest first."""
    with services.database.reading() as session:
        page = catalog.list_estimations(session, limit=limit, cursor=cursor)
    return EstimationPageOut(items=[EstimationOut.from_row(row) for row in page.items], next_cursor=page.next_cursor)


@router.get("/{id}", response_model=EstimationOut, responses=problems(404, 422))
def get_estimation(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at an estimation."""
    with services.database.reading() as session:
        return EstimationOut.from_row(catalog.get_estimation(session, id))


@router.get(
    "/{id}/mesh",
    response_class=Response,
    responses={**binary(glb.MEDIA_TYPE, "The fitted mesh as GLB."), **NOT_MODIFIED, **problems(404, 422)},
)
def get_estimation_mesh(request: Request, services: ServicesDep, id: IdPath) -> Response:  # noqa: A002
    """The fitted mesh in the query's own coordinates; 404 until there is one."""
    with services.database.reading() as session:
        row = catalog.get_estimation(session, id)
    key = _key(row, row.mesh_key)
    return immutable_response(request, f"{id}-mesh", glb.MEDIA_TYPE, lambda: services.artifacts.get(key))


@router.get(
    "/{id}/residuals",
    response_class=Response,
    responses={
        **binary(glb.MEDIA_TYPE, "A scene with the nodes `fit` and `query`, colored."),
        **NOT_MODIFIED,
        **problems(404, 422),
    },
)
def get_estimation_residuals(request: Request, services: ServicesDep, id: IdPath) -> Response:  # noqa: A002
    """Where the query and the fitted mesh part, as vertex colors; 404 until there is a fitted mesh.

    Yellow lies on the other surface; dark violet is four times the tolerance away from it, or more. Both meshes are in
    the query's own coordinates.
    """
    with services.database.reading() as session:
        row = catalog.get_estimation(session, id)
    key = _key(row, row.residuals_key)
    return immutable_response(request, f"{id}-residuals", glb.MEDIA_TYPE, lambda: services.artifacts.get(key))


def _key(row: EstimationRow, key: str | None) -> str:
    """The key of an artefact of an estimation, or the problem that it is not there."""
    if key is None:
        detail = f"no mesh is fitted: this estimation is {row.job.state.value}"
        if row.mesh_key is not None:
            detail = "this estimation was made before residuals were kept"
        raise ProblemError(Problem(404, "not-ready", "It is not ready yet", detail))
    return key
