"""Meshes and point clouds: upload and look at."""

from pathlib import PurePosixPath
from typing import Any

import anyio
from fastapi import APIRouter, Request, Response, UploadFile
from starlette.concurrency import run_in_threadpool

from models_store import catalog
from models_store.tables import MeshRow
from service.body_limit import too_large
from service.conditional import immutable_response
from service.dependencies import CursorQuery, IdPath, LimitQuery, Services, ServicesDep, now
from service.errors import Problem, ProblemError
from service.routes import NOT_MODIFIED, binary, problems
from service.schemas.meshes import MeshOut, MeshPageOut
from shapewright.mesh import glb
from shapewright.mesh.file import ReadLimits, parse_query
from shapewright.mesh.sniff import QUERY_TYPES

router = APIRouter(prefix="/v1/meshes", tags=["meshes"])


@router.post(
    "",
    status_code=201,
    response_model=MeshOut,
    responses={
        200: {"model": MeshOut, "description": "The same bytes are there already."},
        **problems(413, 415, 422, 503, 507),
    },
)
async def create_mesh(services: ServicesDep, response: Response, file: UploadFile) -> Any:
    """Upload a mesh: OBJ, OFF, PLY, STL, GLB or self-contained glTF. The same bytes are the same mesh.

    A file without faces is a point cloud, which classifications and retrievals take: any of these but STL, or LAS, LAZ,
    PCD, or text with a point on each line (XYZ, PTS, ASC, CSV, TXT).

    The file is read in a child process with limits; no link in it is followed.
    """
    file_name = PurePosixPath((file.filename or "").replace("\\", "/")).name
    file_type = _file_type(file_name)
    limit = services.settings.max_mesh_bytes
    if file.size is not None and file.size > limit:
        raise too_large(limit)
    data = await file.read()
    known = await run_in_threadpool(_known, services, data)
    if known is not None:
        row, is_new = known, False
    else:
        row, is_new = await anyio.to_thread.run_sync(
            _read_and_store, services, data, file_name, file_type, limiter=services.upload_limiter
        )
    response.status_code = 201 if is_new else 200
    response.headers["Location"] = f"/v1/meshes/{row.id}"
    return MeshOut.from_row(row)


def _file_type(file_name: str) -> str:
    file_type = PurePosixPath(file_name).suffix.lower().removeprefix(".")
    if file_type not in QUERY_TYPES:
        known = ", ".join(f".{known}" for known in QUERY_TYPES)
        raise ProblemError(
            Problem(
                415,
                "unsupported-media-type",
                "The file is of a type that is not read",
                f"the name of the file must end in one of {known}",
                "file.filename",
            )
        )
    return file_type


def _known(services: Services, data: bytes) -> MeshRow | None:
    with services.database.reading() as session:
        return session.get(MeshRow, catalog.mesh_id(data))


def _read_and_store(services: Services, data: bytes, file_name: str, file_type: str) -> tuple[MeshRow, bool]:
    with services.metrics.upload_seconds.time():
        limits = ReadLimits(size_bytes=services.settings.max_mesh_bytes)
        mesh = parse_query(data, file_type, limits=limits, reader=services.mesh_reader)
    return catalog.store_mesh(
        services.database,
        services.artifacts,
        data,
        file_name=file_name,
        file_type=file_type,
        mesh=mesh,
        now=now(),
    )


@router.get("", response_model=MeshPageOut, responses=problems(422))
def list_meshes(services: ServicesDep, limit: LimitQuery = 50, cursor: CursorQuery = None) -> Any:
    """List the meshes, newest first."""
    with services.database.reading() as session:
        page = catalog.list_meshes(session, limit=limit, cursor=cursor)
    return MeshPageOut(items=[MeshOut.from_row(row) for row in page.items], next_cursor=page.next_cursor)


@router.get("/{id}", response_model=MeshOut, responses=problems(404, 422))
def get_mesh(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at a mesh."""
    with services.database.reading() as session:
        return MeshOut.from_row(catalog.get_mesh(session, id))


@router.get(
    "/{id}/content",
    response_class=Response,
    responses={**binary(glb.MEDIA_TYPE, "The mesh as GLB."), **NOT_MODIFIED, **problems(404, 422)},
)
def get_mesh_content(request: Request, services: ServicesDep, id: IdPath) -> Response:  # noqa: A002
    """The mesh as it was read, in its own coordinates, as GLB; a point cloud as points."""
    with services.database.reading() as session:
        key = catalog.get_mesh(session, id).content_key
    return immutable_response(request, f"{id}-content", glb.MEDIA_TYPE, lambda: services.artifacts.get(key))
