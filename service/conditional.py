"""Responses whose content never changes: an entity tag, a long life in caches, 304 to who has it."""

from collections.abc import Callable

from fastapi import Request, Response

CACHE_CONTROL = "public, max-age=31536000, immutable"


def immutable_response(request: Request, tag: str, media_type: str, load: Callable[[], bytes]) -> Response:
    """Answer with content that is written once.

    Args:
        request: its ``If-None-Match`` is compared (RFC 9110, section 13.1.2).
        tag: what tells this content from all other, without quotes.
        media_type: of the content.
        load: gives the bytes; not called for a 304.
    """
    etag = f'"{tag}"'
    headers = {"ETag": etag, "Cache-Control": CACHE_CONTROL}
    known = {entry.strip().removeprefix("W/") for entry in request.headers.get("if-none-match", "").split(",")}
    if etag in known or "*" in known:
        return Response(status_code=304, headers=headers)
    return Response(load(), media_type=media_type, headers=headers)
