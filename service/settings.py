"""Settings of the service, read from ``SHAPEWRIGHT_*``; the store's settings are among them."""

from pathlib import Path
from typing import Annotated

from pydantic import Field, field_validator
from pydantic_settings import NoDecode

from models_store.settings import StoreSettings

_DASHBOARD = Path(__file__).parent / "dashboard" / "dist"


class ServiceSettings(StoreSettings):
    """Settings of the API process.

    Attributes:
        migrate_on_start: bring the database to the newest revision at start. Switch it off where a deployment
            does that in a step of its own.
        add_shipped_on_start: add the models that ship and the ready classifier at start, each version once. What
            was deleted since stays deleted.
        ready_classifier_dir: folder of another ready classifier (``classifier.onnx`` and, beside it,
            ``classifier.exemplars.npz``); default the one that ships.
        max_mesh_bytes: largest mesh file that can be uploaded.
        max_model_bytes: largest document of a procedural model.
        max_body_bytes: largest body of any other request.
        max_instance_corners: most face corners of an instance's surface; finer ones are refused.
        compiled_models: how many compiled models are kept in memory.
        parallel_uploads: how many mesh files are read at the same time, each in a child process.
        parallel_instances: how many instances are generated at the same time.
        event_poll_s: how often a followed job is looked at.
        event_ping_s: how often a silent event stream shows that it is alive.
        cors_origins: pages of these origins may call the API; a list, or comma-separated. None by default.
        dashboard_dir: the dashboard's built files.
        log_level: of the service's own log on stderr.
    """

    migrate_on_start: bool = True
    add_shipped_on_start: bool = True
    ready_classifier_dir: Path | None = None
    max_mesh_bytes: int = Field(default=64 * 2**20, ge=1)
    max_model_bytes: int = Field(default=16 * 2**20, ge=1)
    max_body_bytes: int = Field(default=2**20, ge=1)
    max_instance_corners: int = Field(default=2_000_000, ge=1)
    compiled_models: int = Field(default=16, ge=1)
    parallel_uploads: int = Field(default=2, ge=1)
    parallel_instances: int = Field(default=4, ge=1)
    event_poll_s: float = Field(default=0.1, gt=0)
    event_ping_s: float = Field(default=15.0, gt=0)
    cors_origins: Annotated[tuple[str, ...], NoDecode] = ()
    dashboard_dir: Path = _DASHBOARD
    log_level: str = "INFO"

    @field_validator("cors_origins", mode="before")
    @classmethod
    def _split(cls, value: object) -> object:
        if isinstance(value, str):
            return tuple(origin.strip() for origin in value.split(",") if origin.strip())
        return value
