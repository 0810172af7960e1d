"""Parts of a running job: who may take them, who sees them, and when they end."""

from datetime import timedelta

import pytest
from store_support import LEASE, FakeClock, clock, database, queue_job  # noqa: F401 - fixtures

from models_store import claims, parts
from models_store.claims import QUIET, Claim
from models_store.errors import StaleClaim
from models_store.jobs import JobKind, JobState, get_job, list_events, list_jobs
from models_store.session import Database
from models_store.sweep import sweep

KIND = JobKind.DESCRIBE_VARIATIONS


class Bench:
    """A training that runs, and its parts."""

    def __init__(self, database: Database, clock: FakeClock) -> None:  # noqa: F811
        self.database = database
        self.clock = clock
        self.held = self.start(queue_job(database, clock.now, JobKind.TRAIN_CLASSIFIER))
        self.parts = self.add(3)

    def add(self, count: int) -> list[str]:
        with self.database.writing() as session:
            return parts.add_parts(session, self.held, KIND, [{"chunk": n} for n in range(count)], now=self.clock.now)

    def claim(self, job_id: str) -> Claim | None:
        with self.database.writing() as session:
            return claims.claim(session, job_id, now=self.clock.now, lease=LEASE)

    def start(self, job_id: str) -> Claim:
        held = self.claim(job_id)
        assert held is not None
        return held

    def end(self, held: Claim) -> None:
        with self.database.writing() as session:
            claims.finish(session, held, now=self.clock.now)

    def withdraw(self, part_id: str) -> bool:
        with self.database.writing() as session:
            return parts.withdraw_part(session, part_id)

    def states(self) -> list[JobState | None]:
        with self.database.reading() as session:
            found = parts.part_states(session, self.held.job_id)
        return [found.get(part_id) for part_id in self.parts]

    def sweep(self):
        with self.database.writing() as session:
            return sweep(session, now=self.clock.now, wakeup_after=timedelta(seconds=5))


@pytest.fixture
def bench(database: Database, clock: FakeClock) -> Bench:  # noqa: F811
    return Bench(database, clock)


def test_a_part_is_done_by_who_takes_it(bench: Bench) -> None:
    held = bench.start(bench.parts[2])
    assert (held.kind, held.payload, held.result_id) == (KIND, {"chunk": 2}, bench.held.result_id)
    assert not bench.withdraw(bench.parts[2])
    assert bench.withdraw(bench.parts[0])
    assert not bench.withdraw(bench.parts[0])
    assert bench.claim(bench.parts[0]) is None
    bench.end(held)
    assert bench.states() == [None, JobState.QUEUED, JobState.SUCCEEDED]


def test_a_part_gives_way_to_what_somebody_asked_for(bench: Bench) -> None:
    wanted = queue_job(bench.database, bench.clock.now)
    assert bench.claim(bench.parts[0]) is None
    held = bench.start(wanted)
    part = bench.start(bench.parts[0])  # the one job has its worker, this worker is free
    with bench.database.reading() as session:
        assert not claims.others_wait(session, now=bench.clock.now)
    bench.end(held)
    with bench.database.reading() as session:
        assert claims.others_wait(session, now=bench.clock.now)
    assert bench.claim(bench.parts[1]) is None
    bench.clock.forward(QUIET.total_seconds() + 1)
    assert bench.claim(bench.parts[1]) is not None
    with bench.database.writing() as session:
        claims.release(session, part, now=bench.clock.now)
    assert bench.states() == [JobState.QUEUED, JobState.RUNNING, JobState.QUEUED]


def test_who_works_on_a_part_gives_way_when_no_idle_worker_takes_a_job(bench: Bench) -> None:
    def must_give_way() -> bool:
        with bench.database.reading() as session:
            return claims.must_give_way(session, now=bench.clock.now)

    wanted = queue_job(bench.database, bench.clock.now)
    assert not must_give_way()
    bench.clock.forward(1)
    assert must_give_way()
    held = bench.start(wanted)
    assert not must_give_way()
    bench.end(held)
    assert not must_give_way()


def test_a_stale_claim_adds_no_parts(bench: Bench) -> None:
    with bench.database.writing() as session:
        claims.release(session, bench.held, now=bench.clock.now)
    stale, bench.held = bench.held, bench.start(bench.held.job_id)
    with pytest.raises(StaleClaim), bench.database.writing() as session:
        parts.add_parts(session, stale, KIND, [{}], now=bench.clock.now)
    assert bench.states() == [JobState.QUEUED] * 3


def test_no_part_is_given_out_when_its_job_does_not_run(bench: Bench) -> None:
    with bench.database.writing() as session:
        claims.release(session, bench.held, now=bench.clock.now)
    bench.clock.forward(60)
    assert bench.claim(bench.parts[0]) is None
    bench.held = bench.start(bench.held.job_id)
    assert bench.claim(bench.parts[0]) is not None


def test_parts_end_with_their_job(bench: Bench) -> None:
    running = bench.start(bench.parts[0])
    bench.end(bench.held)
    bench.sweep()
    assert bench.states() == [JobState.RUNNING, JobState.CANCELLED, JobState.CANCELLED]
    with bench.database.reading() as session:
        assert claims.look(session, running)  # its worker hears that it shall stop
    events = len(_events(bench, bench.parts[0]))
    bench.sweep()
    assert len(_events(bench, bench.parts[0])) == events


def _events(bench: Bench, job_id: str) -> list:
    with bench.database.reading() as session:
        return list(list_events(session, job_id))


def test_a_new_attempt_replaces_what_is_queued_alone(bench: Bench) -> None:
    running, queued = bench.start(bench.parts[0]), bench.parts[1:]
    bench.parts = [running.job_id, *queued, *bench.add(2)]
    assert bench.states() == [JobState.RUNNING, None, None, JobState.QUEUED, JobState.QUEUED]


def test_the_sweeper_brings_back_lost_parts_and_announces_none(bench: Bench) -> None:
    bench.start(bench.parts[1])
    bench.clock.forward(LEASE.total_seconds() - 1)
    with bench.database.writing() as session:
        claims.renew(session, bench.held, now=bench.clock.now, lease=LEASE)
    bench.clock.forward(2)
    swept = bench.sweep()
    assert (swept.requeued, swept.to_wake) == ([bench.parts[1]], [])
    assert bench.states() == [JobState.QUEUED] * 3


def test_lists_show_parts_when_asked_for_them(bench: Bench) -> None:
    with bench.database.reading() as session:
        assert [job.id for job in list_jobs(session).items] == [bench.held.job_id]
        assert {job.id for job in list_jobs(session, parent_id=bench.held.job_id).items} == set(bench.parts)
        assert list_jobs(session, parent_id=bench.parts[0]).items == []
        assert get_job(session, bench.parts[0]).parent_id == bench.held.job_id
