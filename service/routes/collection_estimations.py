"""Estimations of many meshes as one job, and the table that it fills in."""

from collections.abc import Iterator
from typing import Annotated, Any

from fastapi import APIRouter, BackgroundTasks, Depends, Query, Response
from fastapi.responses import StreamingResponse
from sqlalchemy.orm import Session

from models_store import catalog
from models_store.errors import NotFoundError
from models_store.tables import CollectionEstimationRow
from service.dependencies import CursorQuery, IdPath, LimitQuery, Services, ServicesDep, now, require_json
from service.errors import Problem, ProblemError, reference_error
from service.routes import problems
from service.schemas.collection_estimations import (
    CollectionEstimationIn,
    CollectionEstimationOut,
    CollectionEstimationPageOut,
    EstimatedMeshOut,
    EstimatedMeshPageOut,
)
from service.schemas.jobs import AcceptedOut
from shapewright.errors import EstimationError

router = APIRouter(prefix="/v1/collection-estimations", tags=["collection estimations"])

SortQuery = Annotated[
    str | None,
    Query(
        max_length=200,
        description="A parameter, a distance, or a ratio of two: `stem_length`, `zbuffer`, `stem_length/bowl_depth`. "
        "Without it rows come in the order of the meshes.",
    ),
]
DescendingQuery = Annotated[bool, Query(description="The largest first; rows without the value come last anyway.")]


@router.post(
    "",
    status_code=202,
    response_model=AcceptedOut,
    dependencies=[Depends(require_json)],
    responses=problems(413, 415, 422, 503, 507),
)
def create_collection_estimation(
    services: ServicesDep, response: Response, after: BackgroundTasks, body: CollectionEstimationIn
) -> Any:
    """Estimate many meshes as one job, whose parts any worker takes."""
    settings = body.settings.checked()
    _one_of(body.collection_id, body.mesh_ids, "name either a collection or meshes", "collection_id")
    _one_of(body.model_id, body.class_name, "name either a model or a class", "model_id")
    try:
        with services.database.writing() as session:
            row = catalog.request_collection_estimation(
                session,
                settings,
                **body.model_dump(exclude={"settings"}),
                now=now(),
                max_attempts=services.settings.max_attempts,
            )
    except NotFoundError as error:
        raise reference_error(error, _place(error, body)) from None
    after.add_task(services.announce, row.job)
    response.headers["Location"] = f"/v1/jobs/{row.job_id}"
    return AcceptedOut.from_row(row.job)


@router.get("", response_model=CollectionEstimationPageOut, responses=problems(422))
def list_collection_estimations(services: ServicesDep, limit: LimitQuery = 50, cursor: CursorQuery = None) -> Any:
    """List the estimations of many meshes, newest first."""
    with services.database.reading() as session:
        page = catalog.list_collection_estimations(session, limit=limit, cursor=cursor)
        counts = catalog.count_estimated(session, (row.id for row in page.items))
    items = [CollectionEstimationOut.from_row(row, counts[row.id]) for row in page.items]
    return CollectionEstimationPageOut(items=items, next_cursor=page.next_cursor)


@router.get("/{id}", response_model=CollectionEstimationOut, responses=problems(404, 422))
def get_collection_estimation(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at an estimation of many meshes."""
    with services.database.reading() as session:
        row = catalog.get_collection_estimation(session, id)
        counts = catalog.count_estimated(session, [row.id])
    return CollectionEstimationOut.from_row(row, counts[row.id])


@router.get("/{id}/rows", response_model=EstimatedMeshPageOut, responses=problems(404, 422))
def list_estimated_meshes(
    services: ServicesDep,
    id: IdPath,  # noqa: A002
    sort: SortQuery = None,
    descending: DescendingQuery = False,
    limit: LimitQuery = 50,
    cursor: CursorQuery = None,
) -> Any:
    """List what is found for each mesh so far, sorted by a parameter or a ratio."""
    with services.database.reading() as session:
        row = catalog.get_collection_estimation(session, id)
        order = _order(session, row, sort, descending)
        found, next_cursor = catalog.page_of_estimated(session, row.id, order, limit=limit, cursor=cursor)
    return EstimatedMeshPageOut(items=[EstimatedMeshOut.from_ranked(one) for one in found], next_cursor=next_cursor)


@router.get(
    "/{id}/table",
    response_class=Response,
    responses={
        200: {
            "description": "One line a mesh: its file, model, distances, and each parameter by name with the ends of "
            "its 90 % interval, its status and its unit.",
            "content": {"text/csv": {"schema": {"type": "string"}}},
        },
        **problems(404, 422),
    },
)
def get_estimated_table(
    services: ServicesDep,
    id: IdPath,  # noqa: A002
    sort: SortQuery = None,
    descending: DescendingQuery = False,
) -> Response:
    """Download all rows as comma-separated values."""
    with services.database.reading() as session:
        row = catalog.get_collection_estimation(session, id)
        order = _order(session, row, sort, descending)
    headers = {"Content-Disposition": f'attachment; filename="estimations-{row.id}.csv"'}
    lines = _csv(services, row.id, order)
    return StreamingResponse(lines, media_type="text/csv; charset=utf-8", headers=headers)


def _csv(services: Services, identifier: str, order: catalog.RowOrder) -> Iterator[str]:
    """Read the rows twice, first for the columns, so that few are in memory at a time."""
    from shapewright.estimation.table.rows import TableRow
    from shapewright.estimation.table.table import Layout, csv_line

    def rows(session: Session) -> Iterator[TableRow]:
        for one in catalog.all_estimated(session, identifier, order):
            yield TableRow(one.file_name, one.row.answer, one.row.error, one.row.seconds)

    numerator, *denominator = order.columns or ("",)
    layout = Layout([(numerator, denominator[0])] if denominator else [])
    with services.database.reading() as session:
        for row in rows(session):
            layout.include(row)
        yield csv_line(layout.types)
        for row in rows(session):
            yield csv_line(layout.cells(row).values())


def _order(session: Session, row: CollectionEstimationRow, sort: str | None, descending: bool) -> catalog.RowOrder:
    """Check what rows are to be sorted by against the parameters of the models."""
    if sort is None:
        return catalog.RowOrder((), descending)
    from shapewright.estimation.table.sorting import SortKey

    parameters = [one for identifier in row.model_ids for one in catalog.get_model(session, identifier).parameters]
    try:
        key = SortKey.parse(sort)
        key.check(one["name"] for one in parameters if not one.get("options"))
    except EstimationError as error:
        raise EstimationError(error.message, where="sort") from None
    return catalog.RowOrder(key.columns, descending)


def _one_of(first: object, second: object, detail: str, where: str) -> None:
    if (first is None) == (second is None):
        raise ProblemError(Problem(422, "request-invalid", "The request does not fit the schema", detail, where=where))


def _place(error: NotFoundError, body: CollectionEstimationIn) -> str:
    """Say which field names what is not there."""
    if error.what == "mesh" and body.mesh_ids is not None:
        return f"mesh_ids[{body.mesh_ids.index(error.identifier)}]"
    return "class_name" if error.what == "class" else f"{error.what}_id"
