"""Fixtures that every test may use: real servers, real meshes, the shipped procedural models."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import pytest
from hypothesis import HealthCheck, settings
from runtime_types import check_library
from services import PostgresServer, RedisServer, ServiceMissingError, find_chromium

if TYPE_CHECKING:
    from shapewright.modeling import ProceduralModel

REPOSITORY = Path(__file__).resolve().parent.parent
T = TypeVar("T")

check_library(REPOSITORY / "shapewright")

# An example may take long on a busy machine.
settings.register_profile("patient", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("patient")


def _or_skip(start: Callable[[], T]) -> T:
    """A missing service is skipped on a laptop and fails in CI."""
    try:
        return start()
    except ServiceMissingError as error:
        if os.environ.get("CI") == "true":
            pytest.fail(f"CI must have every service: {error}")
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def repository() -> Path:
    """The root folder of the repository."""
    return REPOSITORY


@pytest.fixture(scope="session")
def postgres_server() -> Iterator[PostgresServer]:
    """A real PostgreSQL server, started when the first test asks for it."""
    server = _or_skip(PostgresServer.start)
    yield server
    server.stop()


@pytest.fixture
def new_postgres_url(postgres_server: PostgresServer) -> Iterator[Callable[[], str]]:
    """A function that makes a fresh, empty database; all of them are dropped after the test."""
    made: list[str] = []

    def create() -> str:
        made.append(postgres_server.create_database())
        return made[-1]

    yield create
    for url in made:
        postgres_server.drop_database(url)


@pytest.fixture
def postgres_url(new_postgres_url: Callable[[], str]) -> str:
    """SQLAlchemy address (``postgresql+psycopg://…``) of a fresh, empty PostgreSQL database."""
    return new_postgres_url()


@pytest.fixture(scope="session")
def redis_server() -> Iterator[RedisServer]:
    """A real Redis server, started when the first test asks for it."""
    server = _or_skip(RedisServer.start)
    yield server
    server.stop()


@pytest.fixture
def redis_url(redis_server: RedisServer) -> str:
    """Address (``redis://…``) of an empty Redis server."""
    redis_server.flush()
    return redis_server.url


@pytest.fixture(scope="session")
def chromium_path() -> Path:
    """The system's Chromium program."""
    return _or_skip(find_chromium)


@pytest.fixture(scope="session")
def real_data(repository: Path) -> Path:
    """The folder of real meshes (``labels.csv``, ``meshes/``) that may lie beside the repository."""
    folder = repository.parent / "shared" / "data"
    if not (folder / "labels.csv").is_file():
        pytest.skip("no real meshes: ../shared/data is not there (they are licensed for academic use only)")
    return folder


@pytest.fixture(scope="session")
def library_models() -> "dict[str, ProceduralModel]":
    """The procedural models that ship, by name."""
    from models_store.library.shipped import list_shipped, load_shipped

    return {name: load_shipped(name) for name in list_shipped()}
