"""Whether the service is alive and ready."""

import logging
from importlib.metadata import version
from typing import Any

from fastapi import APIRouter, Response
from sqlalchemy.exc import SQLAlchemyError

from models_store.broker import broker_answers
from models_store.errors import ArtifactError
from service.dependencies import ServicesDep
from service.schemas.health import HealthOut, ReadinessOut

router = APIRouter(tags=["health"])
log = logging.getLogger("shapewright.service")


@router.get("/healthz", response_model=HealthOut)
async def healthz() -> Any:
    """The process answers."""
    return HealthOut(status="ok", version=version("shapewright"))


@router.get(
    "/readyz",
    response_model=ReadinessOut,
    responses={503: {"model": ReadinessOut, "description": "The database or the artefacts do not answer."}},
)
def readyz(services: ServicesDep, response: Response) -> Any:
    """Database and artefacts answer. The broker is reported; without it jobs wait in the queue."""
    database = artifacts = True
    try:
        services.database.ping()
    except SQLAlchemyError as error:
        database = False
        log.warning("database away: %s", type(error).__name__)
    try:
        services.artifacts.check()
    except ArtifactError as error:
        artifacts = False
        log.warning("artefacts away: %s", error)
    ready = database and artifacts
    response.status_code = 200 if ready else 503
    response.headers["Cache-Control"] = "no-store"
    return ReadinessOut(ready=ready, database=database, artifacts=artifacts, broker=broker_answers(services.celery))
