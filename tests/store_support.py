"""What the tests of the store and of the workers share: databases of both kinds, and jobs without a service."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

import pytest

from models_store.jobs import JobKind, create_job, new_id
from models_store.session import Database, upgrade
from models_store.settings import StoreSettings

LEASE = timedelta(seconds=30)


@dataclass
class FakeClock:
    """A time that moves when it is told to."""

    now: datetime = field(default_factory=lambda: datetime(2030, 1, 1, tzinfo=UTC))

    def __call__(self) -> datetime:
        return self.now

    def forward(self, seconds: float) -> datetime:
        self.now += timedelta(seconds=seconds)
        return self.now


@pytest.fixture
def clock() -> FakeClock:
    return FakeClock()


@pytest.fixture(params=["sqlite", pytest.param("postgres", marks=pytest.mark.services)])
def database(request: pytest.FixtureRequest, tmp_path) -> Iterator[Database]:
    """An upgraded, empty database; each test runs on both kinds."""
    url = request.getfixturevalue("postgres_url") if request.param == "postgres" else ""
    made = Database.connect(StoreSettings(data_dir=tmp_path / "data", database_url=url))
    upgrade(made.engine)
    yield made
    made.close()


def queue_job(database: Database, now: datetime, kind: JobKind = JobKind.ESTIMATE, max_attempts: int = 3) -> str:
    """Add a queued job that belongs to nothing; returns its id."""
    with database.writing() as session:
        return create_job(session, kind, new_id(), {}, now=now, max_attempts=max_attempts).id
