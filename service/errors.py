"""Problem documents (RFC 9457): every refusal of the service, in one form, made in one place."""

import errno
from collections.abc import Sequence
from dataclasses import dataclass, replace
from http import HTTPStatus
from typing import Any, Final

import structlog
from fastapi import FastAPI, HTTPException, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from sqlalchemy.exc import DBAPIError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError
from starlette.exceptions import HTTPException as StarletteHTTPException
from starlette.routing import Match

from models_store.errors import (
    ArtifactError,
    CursorError,
    JobFinishedError,
    NotFoundError,
    NotReadyError,
    StoreError,
)
from service.schemas.common import ProblemOut, ProblemPlaceOut
from shapewright.errors import MeshError, MeshFileError, ModelError, ParameterError, ShapewrightError

log = structlog.stdlib.get_logger("shapewright.service")

MEDIA_TYPE: Final = "application/problem+json"
TYPE_PREFIX: Final = "urn:problem-type:shapewright:"
_FULL: Final = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})


@dataclass(frozen=True)
class Problem:
    """What is wrong, before it is known which request asked for it."""

    status: int
    slug: str
    title: str
    detail: str
    where: str | None = None
    errors: tuple[ProblemPlaceOut, ...] = ()
    headers: tuple[tuple[str, str], ...] = ()

    def response(self, request: Request) -> JSONResponse:
        """Make the response to a request."""
        document = ProblemOut(
            type=TYPE_PREFIX + self.slug,
            title=self.title,
            status=self.status,
            detail=self.detail,
            instance=request.url.path,
            request_id=getattr(request.state, "request_id", ""),
            where=self.where,
            errors=list(self.errors) or None,
        )
        content = document.model_dump(mode="json", exclude_none=True)
        headers = {"Cache-Control": "no-store", **dict(self.headers)}
        return JSONResponse(content, self.status, headers, media_type=MEDIA_TYPE)


class ProblemError(HTTPException):
    """Raised where a route or a middleware knows the problem itself."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem.status, problem.detail)
        self.problem = problem


class UnknownReferenceError(ShapewrightError):
    """A body names a thing that is not there; ``where`` is the field."""


_KINDS: Final[Sequence[tuple[type[ShapewrightError], int, str, str]]] = (
    (NotFoundError, 404, "not-found", "There is no such thing"),
    (NotReadyError, 409, "not-ready", "It is not ready yet"),
    (JobFinishedError, 409, "job-finished", "The job has ended"),
    (CursorError, 422, "cursor-invalid", "The page cannot be found"),
    (UnknownReferenceError, 422, "reference-unknown", "The request names something that is not there"),
    (MeshFileError, 422, "mesh-file-invalid", "The mesh file cannot be used"),
    (MeshError, 422, "mesh-invalid", "The mesh cannot be used"),
    (ModelError, 422, "model-invalid", "The procedural model is not valid"),
    (ParameterError, 422, "values-invalid", "The parameter values do not fit the model"),
    (StoreError, 422, "request-refused", "The request cannot be carried out"),
    (ShapewrightError, 422, "request-refused", "The request cannot be carried out"),
)
_STORAGE_FULL: Final = Problem(
    507, "storage-full", "There is no space left", "the service has no room to store this; nothing was kept"
)
_STORE_AWAY: Final = Problem(
    503, "store-away", "A store does not answer", "try again in a moment", headers=(("Retry-After", "5"),)
)
UNEXPECTED: Final = Problem(
    500, "unexpected", "Something went wrong inside", "the log of the service knows this request by its id"
)


def problem_of(error: Exception) -> Problem:
    """The problem that an error means to the one who asked."""
    if isinstance(error, ProblemError):
        return error.problem
    if _means_full(error):
        return _STORAGE_FULL
    if isinstance(error, (ArtifactError, DBAPIError, PoolTimeoutError)):
        return _STORE_AWAY if not isinstance(error, DBAPIError) or _is_away(error) else UNEXPECTED
    if isinstance(error, ShapewrightError):
        for kind, status, slug, title in _KINDS:
            if isinstance(error, kind):
                return Problem(status, slug, title, error.message, error.where)
    return UNEXPECTED


def reference_error(error: NotFoundError, where: str) -> UnknownReferenceError:
    """Turn "not there" into "your body names something that is not there"."""
    return UnknownReferenceError(error.message, where=where)


def _means_full(error: Exception) -> bool:
    if isinstance(error, OSError):
        return error.errno in _FULL
    if isinstance(error, ArtifactError):
        return "no space left" in error.message
    # SQLite ends the transaction by itself then, so that what is seen first is a savepoint that is gone.
    cause: BaseException | None = error
    while isinstance(cause, DBAPIError):
        if "disk is full" in str(cause.orig) or "DiskFull" in type(cause.orig).__name__:
            return True
        cause = cause.__context__ if isinstance(cause.__context__, DBAPIError) else cause.__cause__
    return False


def _is_away(error: DBAPIError) -> bool:
    words = ("locked", "connection", "connect", "unable to open", "readonly", "disk i/o")
    return error.connection_invalidated or any(word in str(error.orig).lower() for word in words)


def _place(location: Sequence[Any]) -> str:
    """``("body", "model_ids", 2)`` as ``model_ids[2]``; what is not in the body keeps its part's name."""
    parts = list(location)
    if len(parts) > 1 and parts[0] == "body":
        parts = parts[1:]
    place = ""
    for part in parts:
        place += f"[{part}]" if isinstance(part, int) else f".{part}" if place else str(part)
    return place


def validation_problem(error: RequestValidationError) -> Problem:
    """Every place where a request does not fit the schema."""
    places = []
    for entry in error.errors():
        where, detail = _place(entry["loc"]), str(entry["msg"])
        if entry["type"] == "json_invalid":
            where, detail = f"byte {entry['loc'][-1]}", f"broken JSON: {entry['ctx']['error']}"
        places.append(ProblemPlaceOut(where=where[:200], detail=detail[:500]))
    first = places[0]
    more = f" (and {len(places) - 1} more)" if len(places) > 1 else ""
    return Problem(
        422,
        "request-invalid",
        "The request does not fit the schema",
        f"{first.where}: {first.detail}{more}",
        first.where,
        tuple(places[:100]),
    )


def http_problem(request: Request, error: StarletteHTTPException) -> Problem:
    """404, 405 and what else the framework says of its own accord."""
    try:
        title = HTTPStatus(error.status_code).phrase
    except ValueError:
        title = "Refused"
    slug = title.lower().replace(" ", "-").replace("'", "")
    detail = str(error.detail)
    problem = Problem(error.status_code, slug, title, detail, headers=tuple((error.headers or {}).items()))
    if error.status_code == 400:  # what the framework says of a body that it cannot take apart
        unreadable = isinstance(error.__cause__, (UnicodeDecodeError, RecursionError))
        detail = "the body is not JSON in UTF-8" if unreadable else f"the body cannot be read: {error.detail}"
        return Problem(422, "request-invalid", "The request does not fit the schema", detail, "body")
    if error.status_code == 404:
        return replace(problem, detail=f"there is nothing at {request.url.path[:500]}")
    if error.status_code == 405:
        allow = ", ".join(_allowed_methods(request))
        detail = f"{request.method[:20]} is not possible here"
        return replace(problem, detail=detail, headers=(("Allow", allow),))
    return problem


def _allowed_methods(request: Request) -> list[str]:
    """What is possible at this path; the framework names only the methods of one of its routes."""
    routes = request.app.routes
    found = [
        method
        for method in ("GET", "POST")
        if any(route.matches({**request.scope, "method": method})[0] is Match.FULL for route in routes)
    ]
    if "GET" in found and not request.url.path.endswith("/events"):  # an endless stream has no HEAD
        found.insert(1, "HEAD")
    return found


def install_handlers(app: FastAPI) -> None:
    """Translate every error at the edge of the app."""

    async def on_problem(request: Request, error: Exception) -> JSONResponse:
        problem = problem_of(error)
        if problem.status >= 500:
            log.error(
                problem.slug, request_id=getattr(request.state, "request_id", ""), exc_info=error, status=problem.status
            )
        return problem.response(request)

    async def on_http(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, StarletteHTTPException)
        if isinstance(error.__cause__, OSError):  # of the temporary file of an upload; the framework says 400
            return await on_problem(request, error.__cause__)
        return http_problem(request, error).response(request)

    async def on_validation(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, RequestValidationError)
        return validation_problem(error).response(request)

    app.add_exception_handler(ProblemError, on_problem)
    app.add_exception_handler(ShapewrightError, on_problem)
    app.add_exception_handler(DBAPIError, on_problem)
    app.add_exception_handler(PoolTimeoutError, on_problem)
    app.add_exception_handler(OSError, on_problem)
    app.add_exception_handler(RequestValidationError, on_validation)
    app.add_exception_handler(StarletteHTTPException, on_http)
