"""The composition root of the service."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib.metadata import version

import structlog
from fastapi import FastAPI
from fastapi.middleware.cors import CORSMiddleware
from fastapi.routing import APIRoute
from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool

from models_store.session import upgrade
from models_store.shipping import add_shipped
from service.body_limit import BodyLimitMiddleware
from service.dependencies import Services, now
from service.errors import install_handlers
from service.logs import configure_logs
from service.openapi import install_openapi
from service.request_context import RequestContextMiddleware
from service.routes import (
    classes,
    classifications,
    classifiers,
    collection_estimations,
    collections,
    dashboard,
    estimations,
    health,
    jobs,
    meshes,
    metrics,
    models,
    retrievals,
)
from service.settings import ServiceSettings
from shapewright.errors import ShapewrightError

log = structlog.stdlib.get_logger("shapewright.service")


def create_app(settings: ServiceSettings | None = None) -> FastAPI:
    """Make the service: ``uvicorn --factory service.app:create_app``.

    Args:
        settings: read from the environment if none are given.
    """
    settings = settings or ServiceSettings()
    configure_logs(settings.log_level)
    services = Services.build(settings)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        if settings.migrate_on_start:
            await run_in_threadpool(upgrade, services.database.engine)
        if settings.add_shipped_on_start:
            await run_in_threadpool(_add_shipped, services)
        try:
            yield
        finally:
            await run_in_threadpool(services.close)

    app = FastAPI(
        title="Shapewright",
        version=version("shapewright"),
        summary="What an unknown 3D mesh is, and which parameter values rebuild it.",
        lifespan=lifespan,
        docs_url=None,  # these pages load scripts from elsewhere
        redoc_url=None,
        generate_unique_id_function=_operation_id,
    )
    app.state.services = services
    install_handlers(app)
    install_openapi(app)
    parts = (
        models,
        classes,
        meshes,
        classifiers,
        classifications,
        estimations,
        collection_estimations,
        collections,
        retrievals,
        jobs,
        health,
        metrics,
    )
    for part in parts:
        app.include_router(part.router)
    app.include_router(dashboard.router)  # last: it takes any name at the top
    app.add_middleware(BodyLimitMiddleware, settings=settings)
    if settings.cors_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=list(settings.cors_origins),
            allow_methods=["GET", "POST"],
            allow_headers=["Content-Type", "Last-Event-ID", "If-None-Match", "X-Request-ID"],
            expose_headers=["ETag", "Location", "X-Request-ID", "X-Shapewright-Values"],
        )
    app.add_middleware(RequestContextMiddleware, metrics=services.metrics)
    return app


def _add_shipped(services: Services) -> None:
    """Add what ships; a service that cannot do so starts all the same, and tries again with its next start."""
    folder = services.settings.ready_classifier_dir
    try:
        added = add_shipped(services.database, services.artifacts, now=now(), ready_dir=folder)
    except (ShapewrightError, SQLAlchemyError, OSError) as error:
        log.error("what ships was not added", error=str(error))
    else:
        if added:
            log.info("what ships was added", count=len(added))


def _operation_id(route: APIRoute) -> str:
    return route.name
