"""Procedural models: upload, look at, generate instances."""

import json
import time
from typing import Annotated, Any

import anyio
from fastapi import APIRouter, BackgroundTasks, Depends, Query, Request, Response

from models_store import catalog
from models_store.tables import JobRow, ModelRow
from service.compiled_models import InstanceWriter
from service.conditional import immutable_response
from service.dependencies import CursorQuery, IdPath, LimitQuery, Services, ServicesDep, now, require_json
from service.errors import Problem, ProblemError
from service.routes import NOT_MODIFIED, binary, problems
from service.schemas.models import InstanceIn, ModelDetailOut, ModelOut, ModelPageOut
from shapewright.errors import ModelError
from shapewright.mesh import glb
from shapewright.modeling import ProceduralModel

router = APIRouter(prefix="/v1/models", tags=["models"])

_DOCUMENT_BODY = {
    "requestBody": {
        "required": True,
        "description": "The document of a procedural model (procedural-model.schema.json).",
        "content": {"application/json": {"schema": {"$ref": "#/components/schemas/ProceduralModelDocument"}}},
    }
}


@router.post(
    "",
    status_code=201,
    response_model=ModelOut,
    dependencies=[Depends(require_json)],
    openapi_extra=_DOCUMENT_BODY,
    responses={
        200: {"model": ModelOut, "description": "The same model is there already."},
        **problems(413, 415, 422, 503, 507),
    },
)
async def create_model(request: Request, response: Response, services: ServicesDep, after: BackgroundTasks) -> Any:
    """Add a procedural model. The same content is the same model, so this can be repeated."""
    body = await request.body()
    row, job = await anyio.to_thread.run_sync(_add, services, body, limiter=services.instance_limiter)
    response.status_code = 200 if job is None else 201
    response.headers["Location"] = f"/v1/models/{row.id}"
    if job is not None:
        after.add_task(services.announce, job)
    return ModelOut.from_row(row)


def _add(services: Services, body: bytes) -> tuple[ModelRow, JobRow | None]:
    try:
        model = ProceduralModel.from_json(body)
        identifier = model.digest
    except UnicodeEncodeError as error:
        raise ModelError("half of a surrogate pair is no text", where=f"character {error.start}") from None
    generator = InstanceWriter(model, services.settings.max_instance_corners)
    generator.check_base_instance()
    with services.database.writing() as session:
        row, is_new = catalog.add_model(session, model, now=now())
        job = None
        if is_new:
            job = catalog.request_thumbnail(session, identifier, now=now(), max_attempts=services.settings.max_attempts)
    services.models.keep(identifier, generator)
    return row, job


@router.get("", response_model=ModelPageOut, responses=problems(422))
def list_models(
    services: ServicesDep,
    class_name: Annotated[str | None, Query(max_length=200, description="Only the models of this class.")] = None,
    limit: LimitQuery = 50,
    cursor: CursorQuery = None,
) -> Any:
    """List the models, newest first."""
    with services.database.reading() as session:
        page = catalog.list_models(session, class_name=class_name, limit=limit, cursor=cursor)
    return ModelPageOut(items=[ModelOut.from_row(row) for row in page.items], next_cursor=page.next_cursor)


@router.get("/{id}", response_model=ModelDetailOut, responses=problems(404, 422))
def get_model(services: ServicesDep, id: IdPath) -> Any:  # noqa: A002 - the name in the path
    """Look at a model and its document."""
    with services.database.reading() as session:
        return ModelDetailOut.from_row(catalog.get_model(session, id))


@router.get(
    "/{id}/thumbnail",
    response_class=Response,
    responses={**binary("image/png", "A picture of the base model."), **NOT_MODIFIED, **problems(404, 422)},
)
def get_model_thumbnail(request: Request, services: ServicesDep, id: IdPath) -> Response:  # noqa: A002
    """The model's thumbnail; 404 until a worker has drawn it."""
    with services.database.reading() as session:
        key = catalog.get_model(session, id).thumbnail_key
    if key is None:
        raise ProblemError(
            Problem(404, "not-ready", "It is not ready yet", "the thumbnail of this model is not drawn yet")
        )
    return immutable_response(request, f"{id}-thumbnail", "image/png", lambda: services.artifacts.get(key))


@router.post(
    "/{id}/instances",
    response_class=Response,
    dependencies=[Depends(require_json)],
    responses={
        **binary(glb.MEDIA_TYPE, "The instance as GLB.", X_Shapewright_Values="JSON object: the x of every parameter."),
        **problems(404, 413, 415, 422),
    },
)
async def create_instance(services: ServicesDep, id: IdPath, body: InstanceIn) -> Response:  # noqa: A002
    """Generate an instance of the model: given values, a random variation, or both."""

    def generate() -> tuple[bytes, dict[str, float]]:
        generator = services.models.get(id, lambda: _load(services, id))
        values = generator.values(body.values, body.seed)
        return generator.glb(values, body.subdivision_steps), values

    started_at = time.perf_counter()
    content, values = await anyio.to_thread.run_sync(generate, limiter=services.instance_limiter)
    services.metrics.instance_seconds.observe(time.perf_counter() - started_at)
    headers = {"X-Shapewright-Values": json.dumps(values), "Cache-Control": "no-store"}
    return Response(content, media_type=glb.MEDIA_TYPE, headers=headers)


def _load(services: Services, model_id: str) -> InstanceWriter:
    with services.database.reading() as session:
        document = catalog.get_model(session, model_id).document
    return InstanceWriter(ProceduralModel.from_json(document), services.settings.max_instance_corners)
