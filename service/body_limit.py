"""Request bodies that are too large are refused while they stream in, before anything is kept."""

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.errors import Problem, ProblemError
from service.settings import ServiceSettings

_MULTIPART_OVERHEAD = 64 * 2**10


class BodyLimitMiddleware:
    """Raises a 413 problem as soon as a body is, or says that it is, over the limit of its path."""

    def __init__(self, app: ASGIApp, settings: ServiceSettings) -> None:
        self._app = app
        self._limits = {
            "/v1/meshes": settings.max_mesh_bytes + _MULTIPART_OVERHEAD,
            "/v1/models": settings.max_model_bytes,
        }
        self._default = settings.max_body_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Count the bytes of a request's body."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        limit = self._limits.get(scope["path"], self._default)
        stated = dict(scope["headers"]).get(b"content-length", b"")
        if stated.isdigit() and int(stated[:20]) > limit:
            raise too_large(limit)
        received = 0

        async def counted() -> Message:
            nonlocal received
            message = await receive()
            if message["type"] == "http.request":
                received += len(message.get("body", b""))
                if received > limit:
                    raise too_large(limit)
            return message

        await self._app(scope, counted, send)


def too_large(limit: int) -> ProblemError:
    """The refusal of a body of more than ``limit`` bytes."""
    return ProblemError(
        Problem(
            413,
            "too-large",
            "The body is too large",
            f"at most {limit} bytes are taken here",
            f"byte {limit}",
            headers=(("Connection", "close"),),
        )
    )
