"""The endpoints, one file a resource."""

from typing import Any, Final

from service.errors import MEDIA_TYPE

Responses = dict[int | str, dict[str, Any]]

_WORDS: Final = {
    404: "There is no such thing.",
    409: "Not in this state.",
    413: "The body is too large.",
    415: "The body is of a type that is not taken.",
    422: "The request is not valid; `where` says the place.",
    503: "A store does not answer.",
    507: "There is no space left; nothing was kept.",
}


def problems(*statuses: int) -> Responses:
    """Describe the problem documents that an endpoint may answer with."""
    schema = {"$ref": "#/components/schemas/ProblemOut"}
    return {status: {"description": _WORDS[status], "content": {MEDIA_TYPE: {"schema": schema}}} for status in statuses}


NOT_MODIFIED: Final[Responses] = {304: {"description": "Not modified."}}


def binary(media_type: str, description: str, **headers: str) -> Responses:
    """Describe a response of bytes; ``headers`` are described by name, with ``_`` for ``-``."""
    response: dict[str, Any] = {
        "description": description,
        "content": {media_type: {"schema": {"type": "string", "format": "binary"}}},
    }
    if headers:
        response["headers"] = {
            name.replace("_", "-"): {"description": text, "schema": {"type": "string"}}
            for name, text in headers.items()
        }
    return {200: response}
