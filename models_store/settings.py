"""Where things are kept; shared by the service and the workers, read from ``SHAPEWRIGHT_*``."""

from pathlib import Path
from typing import Self

from pydantic import Field, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

EMBEDDED_BROKER_SCHEME = "embedded"


class StoreSettings(BaseSettings):
    """Settings of the store. Without any, everything lives in one folder and needs no server.

    Attributes:
        data_dir: folder of the embedded default; made absolute, created when first needed.
        database_url: SQLAlchemy address; default an SQLite file in ``data_dir``. ``postgresql://`` and
            ``postgres://`` mean psycopg 3.
        artifacts_url: a folder, ``file:///…``, ``memory://`` or ``s3://bucket/prefix`` (keys and endpoint come
            from the usual ``AWS_*`` variables); default a folder in ``data_dir``.
        broker_url: Celery broker (``redis://…``, ``amqp://…``); default ``embedded://<folder>``, which needs no
            server.
        lease_s: a running job whose worker has not been heard of for so long goes back to the queue.
        max_attempts: a job that was claimed so often without an end has failed.
        wakeup_after_s: a queued job is announced again when it has waited so long; doubled each time.
        broker_timeout_s: a broker that does not answer for so long counts as away.
    """

    model_config = SettingsConfigDict(env_prefix="SHAPEWRIGHT_", env_ignore_empty=True, extra="ignore")

    data_dir: Path = Path("shapewright-data")
    database_url: str = Field(default="", repr=False)
    artifacts_url: str = ""
    broker_url: str = Field(default="", repr=False)
    lease_s: float = Field(default=30.0, gt=0)
    max_attempts: int = Field(default=3, ge=1)
    wakeup_after_s: float = Field(default=5.0, gt=0)
    broker_timeout_s: float = Field(default=2.0, gt=0)

    @model_validator(mode="after")
    def _fill_in(self) -> Self:
        self.data_dir = self.data_dir.expanduser().absolute()
        self.database_url = self.database_url or f"sqlite:///{self.data_dir / 'shapewright.db'}"
        for scheme in ("postgres://", "postgresql://"):
            if self.database_url.startswith(scheme):
                self.database_url = "postgresql+psycopg://" + self.database_url.removeprefix(scheme)
        self.artifacts_url = self.artifacts_url or (self.data_dir / "artifacts").as_uri()
        self.broker_url = self.broker_url or f"{EMBEDDED_BROKER_SCHEME}://{self.data_dir / 'broker'}"
        return self

    @property
    def embedded_broker_folder(self) -> Path | None:
        """The folder of the embedded broker; ``None`` when a broker server is used."""
        scheme, _, rest = self.broker_url.partition("://")
        return Path(rest) if scheme == EMBEDDED_BROKER_SCHEME else None
