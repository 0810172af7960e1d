"""The rules of jobs, with a clock that stands still unless it is moved."""

from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from threading import Barrier

import pytest
from store_support import LEASE, FakeClock, clock, database, queue_job  # noqa: F401 - fixtures

from models_store import claims
from models_store.errors import JobFinishedError, NotFoundError, StaleClaim
from models_store.jobs import JobKind, JobState, get_job, list_events, list_jobs, request_cancel
from models_store.session import Database
from models_store.sweep import sweep, wakeups_sent
from models_store.tables import JobRow

WAKEUP_AFTER = timedelta(seconds=5)


@pytest.fixture
def desk(database: Database, clock: FakeClock) -> "Desk":  # noqa: F811
    return Desk(database, clock)


class Desk:
    """The functions of the store, each in a transaction of its own."""

    def __init__(self, database: Database, clock: FakeClock) -> None:  # noqa: F811
        self.database = database
        self.clock = clock

    def queue(self, **options) -> str:
        return queue_job(self.database, self.clock.now, **options)

    def claim(self, job_id: str) -> claims.Claim | None:
        with self.database.writing() as session:
            return claims.claim(session, job_id, now=self.clock.now, lease=LEASE, worker="w")

    def renew(self, held: claims.Claim) -> bool:
        with self.database.writing() as session:
            return claims.renew(session, held, now=self.clock.now, lease=LEASE)

    def report(self, held: claims.Claim, fraction: float, message: str = "") -> bool:
        with self.database.writing() as session:
            return claims.report_progress(session, held, fraction, message, now=self.clock.now, lease=LEASE)

    def finish(self, held: claims.Claim) -> None:
        with self.database.writing() as session:
            claims.finish(session, held, now=self.clock.now)

    def finish_cancelled(self, held: claims.Claim) -> None:
        with self.database.writing() as session:
            claims.finish_cancelled(session, held, now=self.clock.now)

    def fail(self, held: claims.Claim, error: claims.JobError) -> None:
        with self.database.writing() as session:
            claims.fail(session, held, error, now=self.clock.now)

    def release(self, held: claims.Claim, **options) -> None:
        with self.database.writing() as session:
            claims.release(session, held, now=self.clock.now, **options)

    def cancel(self, job_id: str) -> JobRow:
        with self.database.writing() as session:
            return request_cancel(session, job_id, now=self.clock.now)

    def sweep(self):
        with self.database.writing() as session:
            return sweep(session, now=self.clock.now, wakeup_after=WAKEUP_AFTER)

    def sent(self, *job_ids: str) -> None:
        with self.database.writing() as session:
            wakeups_sent(session, list(job_ids), now=self.clock.now, wakeup_after=WAKEUP_AFTER)

    def get(self, job_id: str) -> JobRow:
        with self.database.reading() as session:
            return get_job(session, job_id)

    def events(self, job_id: str, after: int = 0):
        with self.database.reading() as session:
            return list_events(session, job_id, after=after)


def test_a_job_lives_from_queued_to_succeeded(desk: Desk) -> None:
    job_id = desk.queue()
    assert desk.get(job_id).state is JobState.QUEUED
    held = desk.claim(job_id)
    assert held is not None
    assert (held.attempt, held.kind) == (1, JobKind.ESTIMATE)
    desk.clock.forward(3)
    assert desk.report(held, 0.5, "half way") is False
    running = desk.get(job_id)
    assert (running.state, running.progress_fraction, running.progress_message) == ("running", 0.5, "half way")
    desk.clock.forward(3)
    desk.finish(held)
    done = desk.get(job_id)
    assert (done.state, done.progress_fraction, done.lease_expires_at) == (JobState.SUCCEEDED, 1.0, None)
    assert done.finished_at == desk.clock.now
    assert done.started_at == done.created_at == desk.clock.now - timedelta(seconds=6)


def test_many_workers_claim_and_one_gets_the_job(desk: Desk) -> None:
    job_ids = [desk.queue() for _ in range(5)]
    workers = 8
    barrier = Barrier(workers)

    def try_all(_: int) -> list[claims.Claim]:
        barrier.wait()
        return [held for job_id in job_ids if (held := desk.claim(job_id)) is not None]

    with ThreadPoolExecutor(workers) as pool:
        won = [held.job_id for claimed in pool.map(try_all, range(workers)) for held in claimed]
    assert sorted(won) == sorted(job_ids)


def test_an_unknown_or_absurd_job_cannot_be_claimed(desk: Desk) -> None:
    assert desk.claim("0" * 32) is None
    assert desk.claim("../\0\ud800") is None


@pytest.mark.parametrize("write", ["renew", "report", "finish", "finish_cancelled", "fail", "release"])
def test_an_old_claim_is_refused_and_changes_nothing(desk: Desk, write: str) -> None:
    job_id = desk.queue()
    old = desk.claim(job_id)
    desk.clock.forward(31)
    assert desk.sweep().requeued == [job_id]
    new = desk.claim(job_id)
    assert new.token == old.token + 1
    before, events = desk.get(job_id), len(desk.events(job_id))
    arguments = {"report": (0.9, "late"), "fail": (claims.JobError("late", "late"),)}.get(write, ())
    with pytest.raises(StaleClaim):
        getattr(desk, write)(old, *arguments)
    after = desk.get(job_id)
    for name in JobRow.__table__.columns.keys():  # noqa: SIM118
        assert getattr(after, name) == getattr(before, name), name
    assert len(desk.events(job_id)) == events
    desk.finish(new)
    with pytest.raises(StaleClaim):  # and an ended job takes no write from its own worker either
        desk.finish(new)


def test_results_of_a_stale_claim_are_rolled_back(desk: Desk) -> None:
    job_id, other = desk.queue(), desk.queue()
    old = desk.claim(job_id)
    desk.clock.forward(31)
    desk.sweep()

    def write_all() -> None:
        with desk.database.writing() as session:
            get_job(session, other).progress_message = "written by a stale worker"
            claims.finish(session, old, now=desk.clock.now)

    with pytest.raises(StaleClaim):
        write_all()
    assert desk.get(other).progress_message == ""


def test_a_renewed_lease_does_not_run_out(desk: Desk) -> None:
    job_id = desk.queue()
    held = desk.claim(job_id)
    for _ in range(5):
        desk.clock.forward(20)
        assert desk.renew(held) is False
        assert desk.sweep().requeued == []
    assert desk.get(job_id).attempt == 1


def test_a_lost_job_fails_after_its_last_attempt(desk: Desk) -> None:
    job_id = desk.queue(max_attempts=2)
    for attempt in (1, 2):
        held = desk.claim(job_id)
        assert held.attempt == attempt
        desk.clock.forward(31)
        swept = desk.sweep()
    assert swept.failed == [job_id]
    failed = desk.get(job_id)
    assert failed.state is JobState.FAILED
    assert failed.error_title == "The worker was lost"
    assert failed.finished_at == desk.clock.now
    assert desk.events(job_id)[-1].data["error"]["title"] == "The worker was lost"
    assert desk.claim(job_id) is None
    assert desk.sweep().to_wake == []


def test_cancelling_a_queued_job_ends_it(desk: Desk) -> None:
    job_id = desk.queue()
    assert desk.cancel(job_id).state is JobState.CANCELLED
    assert desk.get(job_id).finished_at == desk.clock.now
    assert desk.claim(job_id) is None
    assert desk.sweep().to_wake == []
    with pytest.raises(JobFinishedError):
        desk.cancel(job_id)


def test_cancelling_a_running_job_is_a_request(desk: Desk) -> None:
    job_id = desk.queue()
    held = desk.claim(job_id)
    assert desk.cancel(job_id).state is JobState.RUNNING
    assert desk.cancel(job_id).cancel_requested  # asking twice is no error
    assert desk.renew(held) is True
    assert desk.report(held, 0.3) is True
    desk.finish_cancelled(held)
    assert desk.get(job_id).state is JobState.CANCELLED


def test_a_job_that_ends_before_it_sees_the_request_has_succeeded(desk: Desk) -> None:
    job_id = desk.queue()
    held = desk.claim(job_id)
    desk.cancel(job_id)
    desk.finish(held)
    assert desk.get(job_id).state is JobState.SUCCEEDED


@pytest.mark.parametrize("how", ["release", "sweep"])
def test_a_job_to_be_cancelled_does_not_go_back_to_the_queue(desk: Desk, how: str) -> None:
    job_id = desk.queue(max_attempts=1)
    held = desk.claim(job_id)
    desk.cancel(job_id)
    if how == "release":
        desk.release(held)
    else:
        desk.clock.forward(31)
        assert desk.sweep().cancelled == [job_id]
    row = desk.get(job_id)
    assert (row.state, row.finished_at, row.error_title) == (JobState.CANCELLED, desk.clock.now, None)


def test_a_planned_stop_is_no_attempt_but_a_crash_is(desk: Desk) -> None:
    job_id = desk.queue()
    first = desk.claim(job_id)
    desk.release(first)
    assert desk.get(job_id).attempt == 0
    second = desk.claim(job_id)
    assert second.token == 2
    desk.release(second, counted=True, delay=timedelta(seconds=60))
    assert desk.get(job_id).attempt == 1
    assert desk.sweep().to_wake == []
    desk.clock.forward(61)
    assert [job.id for job in desk.sweep().to_wake] == [job_id]


def test_jobs_that_nobody_takes_are_announced_again_more_and_more_seldom(desk: Desk) -> None:
    job_id = desk.queue()
    waits = []
    for _ in range(4):
        waited = 0
        while not (found := desk.sweep().to_wake):
            desk.clock.forward(1)
            waited += 1
        assert [(job.id, job.kind) for job in found] == [(job_id, JobKind.ESTIMATE)]
        desk.sent(job_id)
        waits.append(waited)
    assert waits == [0, 5, 10, 20]


def test_a_wake_up_that_could_not_be_sent_is_due_again_soon(desk: Desk) -> None:
    job_id = desk.queue()
    for _ in range(10):
        assert [job.id for job in desk.sweep().to_wake] == [job_id]
        assert desk.sweep().to_wake == []  # a second sweeper does not send it too
        desk.clock.forward(5)


def test_events_replay_in_order_without_gaps(desk: Desk) -> None:
    job_id = desk.queue()
    held = desk.claim(job_id)
    for step in range(4):
        desk.report(held, step / 4, f"step {step}")
    desk.fail(held, claims.JobError("No solid", "all faces lie in a plane", "faces"))
    events = desk.events(job_id)
    assert [event.sequence for event in events] == list(range(1, 8))
    assert [event.type for event in events] == ["state", "state", *["progress"] * 4, "state"]
    assert [event.data.get("state") for event in events if event.type == "state"] == [
        "queued", "running", "failed",
    ]  # fmt: skip
    assert events[-1].data["error"] == {
        "title": "No solid", "detail": "all faces lie in a plane", "where": "faces",
    }  # fmt: skip
    assert [event.sequence for event in desk.events(job_id, after=4)] == [5, 6, 7]
    assert events[2].data == {"fraction": 0.0, "message": "step 0"}


def test_texts_that_a_database_cannot_hold_are_cleaned(desk: Desk) -> None:
    job_id = desk.queue()
    held = desk.claim(job_id)
    desk.report(held, float("nan"), "")
    assert desk.get(job_id).progress_fraction == 0.0
    desk.report(held, 2.0, "nul \0 and surrogate \ud800")
    desk.fail(held, claims.JobError("t\0", "d\ud800", None))
    assert desk.get(job_id).error_title == "t"
    assert desk.get(job_id).progress_fraction == 1.0


def test_lists_are_paged_newest_first_and_filtered(desk: Desk) -> None:
    made = []
    for number in range(7):
        if number % 2:
            desk.clock.forward(1)  # some share their time
        made.append(desk.queue(kind=JobKind.CLASSIFY if number % 3 == 0 else JobKind.ESTIMATE))
    seen, cursor = [], None
    while True:
        with desk.database.reading() as session:
            page = list_jobs(session, limit=3, cursor=cursor)
        seen += [(job.created_at, job.id) for job in page.items]
        cursor = page.next_cursor
        if cursor is None:
            break
    assert sorted(seen, reverse=True) == seen
    assert {identifier for _, identifier in seen} == set(made)
    desk.claim(made[0])
    with desk.database.reading() as session:
        assert [j.id for j in list_jobs(session, state=JobState.RUNNING).items] == [made[0]]
        assert {j.id for j in list_jobs(session, kind=JobKind.CLASSIFY).items} == set(made[::3])


def test_a_job_that_is_not_there(desk: Desk) -> None:
    for identifier in ("0" * 32, "", "\0", "ü" * 32, "0" * 1000):
        with pytest.raises(NotFoundError):
            desk.get(identifier)
        with pytest.raises(NotFoundError):
            desk.cancel(identifier)
