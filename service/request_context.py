"""Around every request: its id, its line in the log, its figures, safe headers, and the last safety net."""

import re
import time
from typing import Any, Final
from uuid import uuid4

import structlog
from fastapi import Request
from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.errors import problem_of
from service.metrics import Metrics

log = structlog.stdlib.get_logger("shapewright.service")
access_log = structlog.stdlib.get_logger("shapewright.access")

_SAFE_ID: Final = re.compile(r"[A-Za-z0-9._-]{1,64}")
_QUIET: Final = frozenset({"/healthz", "/readyz", "/metrics"})
_PAGE_POLICY: Final = (
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self' data: blob:; worker-src 'self' blob:; "
    "object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
"""Of the dashboard: own scripts only; three.js decodes textures and meshes from blob: and data: addresses."""
_DATA_POLICY: Final = "default-src 'none'; frame-ancestors 'none'"
_HEADERS: Final = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
}


class RequestContextMiddleware:
    """The outermost layer of ours. An ``X-Request-ID`` that comes in is kept if it is harmless."""

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self._app = app
        self._metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope, receive)
        request_id = request.headers.get("x-request-id", "")
        if not _SAFE_ID.fullmatch(request_id):
            request_id = uuid4().hex
        request.state.request_id = request_id
        method: str = scope["method"]
        bodiless = method == "HEAD" and not scope["path"].endswith("/events")
        if bodiless:
            # the same headers as GET (RFC 9110, section 9.3.2), without the body; the server keeps its own scope
            scope = {**scope, "method": "GET"}
        status, started_at, sent = 500, time.perf_counter(), 0

        async def send_on(message: Message) -> None:
            nonlocal status, sent
            if message["type"] == "http.response.start":
                status = message["status"]
                _add_headers(message, request_id)
            elif message["type"] == "http.response.body":
                if bodiless:
                    message = {**message, "body": b""}
                sent += len(message.get("body", b""))
            await send(message)

        with self._metrics.in_flight.track_inprogress():
            try:
                await self._app(scope, receive, send_on)
            except Exception as error:
                if status != 500 or sent:  # the response has begun: nothing else can be said
                    log.exception("failed in the middle of a response", request_id=request_id)
                    raise
                problem = problem_of(error)
                if problem.status >= 500:
                    log.exception(problem.slug, request_id=request_id)
                await problem.response(request)(scope, receive, send_on)
            finally:
                self._note(scope, method, status, time.perf_counter() - started_at, request_id, sent)

    def _note(self, scope: Scope, method: str, status: int, seconds: float, request_id: str, sent: int) -> None:
        route = _route_of(scope)
        known_method = method if method in {"GET", "HEAD", "POST", "OPTIONS"} else "other"
        self._metrics.requests.labels(known_method, route, str(status)).inc()
        self._metrics.seconds.labels(known_method, route).observe(seconds)
        write = access_log.debug if scope["path"] in _QUIET else access_log.info
        write(
            "request",
            method=method,
            path=scope["path"],
            status=status,
            ms=round(seconds * 1000, 1),
            bytes=sent,
            request_id=request_id,
        )


def _route_of(scope: Scope) -> str:
    """The route's pattern, so that figures are not split by id."""
    route: Any = scope.get("route")
    return str(getattr(route, "path_format", getattr(route, "path", "none")))


def _add_headers(message: Message, request_id: str) -> None:
    headers = MutableHeaders(scope=message)
    headers["X-Request-ID"] = request_id
    for name, value in _HEADERS.items():
        headers.setdefault(name, value)
    is_page = headers.get("content-type", "").startswith("text/html")
    headers.setdefault("Content-Security-Policy", _PAGE_POLICY if is_page else _DATA_POLICY)
