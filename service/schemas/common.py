"""What every resource shares: strict input, pages, problem documents."""

from datetime import UTC, datetime
from typing import Annotated, Generic, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

ItemT = TypeVar("ItemT")


def _as_utc(moment: datetime) -> datetime:
    return moment.replace(tzinfo=UTC) if moment.tzinfo is None else moment.astimezone(UTC)


Moment = Annotated[datetime, AfterValidator(_as_utc)]
"""A moment in UTC, written as RFC 3339 with its zone."""

Identifier = Annotated[str, Field(min_length=1, max_length=128, pattern=r"^[0-9A-Za-z_-]+$")]
"""An id as the service hands it out: a SHA-256 in hexadecimal, or a random one."""

Seed = Annotated[int, Field(ge=0, le=2**32 - 1)]
"""Seed of a random generator."""


class InBody(BaseModel):
    """A request body: a name that we do not know is an error, not a silence; NaN is no number."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class OutBody(BaseModel):
    """A response body. Every field is always there; what is unknown is null."""

    model_config = ConfigDict(from_attributes=True, json_schema_serialization_defaults_required=True)


class PageOut(OutBody, Generic[ItemT]):
    """One page of a list, newest first."""

    items: list[ItemT]
    next_cursor: str | None = Field(description="Give it as `cursor` to read on; null on the last page.")


class ProblemPlaceOut(OutBody):
    """One of the things that are wrong with a request."""

    where: str
    detail: str


class ProblemOut(BaseModel):
    """A problem document (RFC 9457)."""

    type: str = Field(description="Tells the kind of problem to programs; does not change.")
    title: str
    status: int
    detail: str
    instance: str = Field(description="The path that was asked for.")
    request_id: str = Field(description="The id under which the service's log knows this request.")
    where: str | None = Field(default=None, description="The place in the input, e.g. `operations[3].faces`.")
    errors: list[ProblemPlaceOut] | None = Field(default=None, description="Every place, if it is known.")
