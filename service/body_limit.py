"""Request bodies that are too large are refused while they stream in, before anything is kept."""

from typing import Final

import anyio
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.errors import Problem, ProblemError
from service.settings import ServiceSettings

_MULTIPART_OVERHEAD: Final = 64 * 2**10
_DISCARDED_BYTES: Final = 256 * 2**20
_DISCARDING_S: Final = 20.0


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
            if b"expect" not in dict(scope["headers"]):  # who sends that waits for a word before the body
                await _discard(receive)
            raise too_large(limit)
        received = 0

        async def counted() -> Message:
            nonlocal received
            message = await receive()
            if message["type"] == "http.request":
                received += len(message.get("body", b""))
                if received > limit:
                    if message.get("more_body", False):
                        await _discard(receive)
                    raise too_large(limit)
            return message

        await self._app(scope, counted, send)


async def _discard(receive: Receive) -> None:
    """Read on without keeping anything: a client that is cut off while it sends never sees the refusal."""
    discarded = 0
    with anyio.move_on_after(_DISCARDING_S):
        while discarded < _DISCARDED_BYTES:
            message = await receive()
            discarded += len(message.get("body", b""))
            if message["type"] != "http.request" or not message.get("more_body", False):
                return


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
