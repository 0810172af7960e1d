"""Whether the service is alive and ready."""

from typing import Literal

from service.schemas.common import OutBody


class HealthOut(OutBody):
    """The process answers."""

    status: Literal["ok"]
    version: str


class ReadinessOut(OutBody):
    """What the service leans on; the broker is reported, but jobs are accepted without it."""

    ready: bool
    database: bool
    artifacts: bool
    broker: bool
