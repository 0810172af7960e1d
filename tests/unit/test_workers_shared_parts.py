"""How the worker of a job shares its parts with others, on a database of its own and without a broker."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.exc import OperationalError
from store_support import LEASE, queue_job

from models_store import claims
from models_store.jobs import JobKind, JobState, list_jobs
from models_store.session import Database, upgrade
from models_store.settings import StoreSettings
from shapewright.progress import CallbackProgress
from workers import shared_parts
from workers.context import utc_now
from workers.shared_parts import INVITATIONS, SharedParts

KIND = JobKind.DESCRIBE_VARIATIONS


class ShakyDatabase(Database):
    """A database that is away every third time."""

    count = 0

    @contextmanager
    def reading(self) -> Iterator[Any]:
        ShakyDatabase.count += 1
        if ShakyDatabase.count % 3 == 0:
            raise OperationalError("SELECT", {}, Exception("away"))
        with super().reading() as session:
            yield session


@dataclass
class Job:
    """As much of a context as the parts of a job need."""

    database: Database
    settings: StoreSettings
    claim: claims.Claim
    messages: list[str] = field(default_factory=list)

    def take(self, part_id: str) -> claims.Claim:
        """Another worker takes a part."""
        with self.database.writing() as session:
            held = claims.claim(session, part_id, now=utc_now(), lease=timedelta(hours=1))
        assert held is not None
        return held

    def end(self, held: claims.Claim) -> None:
        with self.database.writing() as session:
            claims.finish(session, held, now=utc_now())

    def parts(self) -> dict[int, tuple[str, JobState]]:
        """The parts that there are, by number."""
        with self.database.reading() as session:
            rows = list_jobs(session, parent_id=self.claim.job_id).items
        return {row.payload["number"]: (row.id, row.state) for row in rows}

    @property
    def progress(self) -> CallbackProgress:
        return CallbackProgress(lambda fraction, message: self.messages.append(message))


@pytest.fixture
def job(tmp_path: Path) -> Iterator[Job]:
    settings = StoreSettings(data_dir=tmp_path)
    database = Database.connect(settings)
    upgrade(database.engine)
    job_id = queue_job(database, utc_now(), JobKind.TRAIN_CLASSIFIER)
    with database.writing() as session:
        held = claims.claim(session, job_id, now=utc_now(), lease=LEASE)
    assert held is not None
    yield Job(database, settings, held)
    database.close()


@pytest.fixture
def invited(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Ids of the parts that were announced."""
    ids: list[str] = []
    monkeypatch.setattr(shared_parts, "send_wakeup", lambda _, part: ids.append(part.id) or True)
    return ids


def shared(job: Job, count: int, **options: float) -> SharedParts:
    return SharedParts(job, KIND, [{"number": n} for n in range(count)], **options)  # type: ignore[arg-type]


def test_without_help_a_worker_does_every_part_in_order(job: Job, invited: list[str]) -> None:
    parts = shared(job, 6)
    ids = {number: part_id for number, (part_id, _) in job.parts().items()}
    taken = list(parts.mine(job.progress))
    assert [number for number, _ in taken] == list(range(6))
    assert [done for _, done in taken] == pytest.approx([n / 6 for n in range(6)])
    assert invited == [ids[n] for n in range(2, 6)]  # the last ones, each once
    assert job.parts() == {}
    assert list(shared(job, 0).mine(job.progress)) == []


def test_what_others_take_is_left_to_them_and_awaited(job: Job, invited: list[str]) -> None:
    parts = shared(job, 4)
    others: list[claims.Claim] = []
    taken = []
    helpers_end = CallbackProgress(lambda fraction, message: job.end(others.pop()))
    for number, _ in parts.mine(helpers_end):
        taken.append(number)
        if number == 0:
            others += [job.take(job.parts()[n][0]) for n in (1, 3)]
    assert taken == [0, 2]
    assert {state for _, state in job.parts().values()} == {JobState.SUCCEEDED}


def test_a_part_that_was_lost_or_takes_for_ever_is_done_here(job: Job, invited: list[str]) -> None:
    parts = shared(job, 3, patience_s=0.05)
    numbers: list[int] = []
    given_back: list[claims.Claim] = []

    def give_back(_: float, message: str) -> None:
        job.messages.append(message)
        if given_back:
            with job.database.writing() as session:
                claims.release(session, given_back.pop(), now=utc_now())

    for number, _ in parts.mine(CallbackProgress(give_back)):
        numbers.append(number)
        if number == 0:
            job.take(job.parts()[1][0])  # and is never heard of again
            given_back.append(job.take(job.parts()[2][0]))
    assert numbers == [0, 2, 1]
    assert "waiting for 2 at other workers" in job.messages


def test_nobody_is_invited_while_others_wait_and_more_come_with_those_who_came(job: Job, invited: list[str]) -> None:
    parts = shared(job, 30)
    queue_job(job.database, utc_now())
    walk = parts.mine(job.progress)
    next(walk)
    assert invited == []
    with job.database.reading() as session:
        waiting = [row.id for row in list_jobs(session, state=JobState.QUEUED).items]
    job.end(job.take(waiting[0]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(claims, "QUIET", timedelta(0))
        next(walk)
        assert len(invited) == INVITATIONS
        for part_id in invited[:]:
            job.take(part_id)
        next(walk)
    assert len(invited) == len(set(invited)) == 3 * INVITATIONS


def test_a_database_that_is_away_for_a_while_stops_nothing(
    job: Job, invited: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shared_parts, "_POLL_S", 0.0)
    parts = shared(job, 5)
    job.database = ShakyDatabase(job.database.engine)
    assert [number for number, _ in parts.mine(job.progress)] == list(range(5))
    assert "waiting for the database" in job.messages
