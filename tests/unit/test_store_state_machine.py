"""Any sequence of what clients, workers and sweepers may do keeps the rules of jobs."""

import tempfile
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from pathlib import Path

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from store_support import queue_job

from models_store import claims
from models_store.errors import JobFinishedError, StaleClaim
from models_store.jobs import JobState, get_job, list_events, request_cancel
from models_store.session import Database, upgrade
from models_store.settings import StoreSettings
from models_store.sweep import sweep, wakeups_sent

LEASE = timedelta(seconds=30)
MAX_ATTEMPTS = 2
FOLLOWS = {
    "queued": {"running", "cancelled"},
    "running": {"running", "queued", "succeeded", "failed", "cancelled"},
}


class JobMachine(RuleBasedStateMachine):
    """One job, many workers that remember every claim they ever had, and a clock."""

    def __init__(self) -> None:
        super().__init__()
        self.folder = tempfile.TemporaryDirectory()
        self.database = Database.connect(StoreSettings(data_dir=Path(self.folder.name)))
        upgrade(self.database.engine)
        self.now = datetime(2030, 1, 1, tzinfo=UTC)
        self.job_id = queue_job(self.database, self.now, max_attempts=MAX_ATTEMPTS)
        self.claims: list[claims.Claim] = []
        self.cancel_asked = False
        self.released = 0
        self.ends = 0

    def teardown(self) -> None:
        self.database.close()
        self.folder.cleanup()

    def job(self):
        with self.database.reading() as session:
            return get_job(session, self.job_id)

    def holds(self, held: claims.Claim) -> bool:
        job = self.job()
        return job.state is JobState.RUNNING and job.token == held.token

    def write(self, held: claims.Claim, function, *arguments, **options):
        """Do one write of a worker; it is refused exactly when the claim is an old one."""
        valid = self.holds(held)
        try:
            with self.database.writing() as session:
                result = function(session, held, *arguments, now=self.now, **options)
        except StaleClaim:
            assert not valid
            return None
        assert valid
        return result

    @rule(seconds=st.sampled_from([1, 10, 29, 31]))
    def time_passes(self, seconds: int) -> None:
        self.now += timedelta(seconds=seconds)

    @rule()
    def somebody_claims(self) -> None:
        was_queued = self.job().state is JobState.QUEUED
        with self.database.writing() as session:
            held = claims.claim(session, self.job_id, now=self.now, lease=LEASE)
        assert (held is not None) == was_queued
        if held is not None:
            assert all(held.token > old.token for old in self.claims)
            self.claims.append(held)

    @precondition(lambda self: self.claims)
    @rule(data=st.data())
    def somebody_reports(self, data) -> None:
        held = data.draw(st.sampled_from(self.claims))
        asked = self.write(held, claims.report_progress, 0.5, "half", lease=LEASE)
        assert asked in (None, self.cancel_asked)

    @precondition(lambda self: self.claims)
    @rule(data=st.data())
    def somebody_renews(self, data) -> None:
        assert self.write(data.draw(st.sampled_from(self.claims)), claims.renew, lease=LEASE) in (
            None,
            self.cancel_asked,
        )

    @precondition(lambda self: self.claims)
    @rule(data=st.data(), how=st.sampled_from(["finish", "finish_cancelled", "fail"]))
    def somebody_ends(self, data, how: str) -> None:
        held = data.draw(st.sampled_from(self.claims))
        valid = self.holds(held)
        arguments = (claims.JobError("Broken", "broken"),) if how == "fail" else ()
        self.write(held, getattr(claims, how), *arguments)
        self.ends += valid

    @precondition(lambda self: self.claims)
    @rule(data=st.data(), counted=st.booleans())
    def somebody_gives_back(self, data, counted: bool) -> None:
        held = data.draw(st.sampled_from(self.claims))
        valid = self.holds(held)
        self.write(held, claims.release, counted=counted)
        self.released += valid and not counted

    @rule()
    def client_cancels(self) -> None:
        ended = self.job().state.is_final
        try:
            with self.database.writing() as session:
                request_cancel(session, self.job_id, now=self.now)
        except JobFinishedError:
            assert ended
        else:
            assert not ended
            self.cancel_asked = True

    @rule(sent=st.booleans())
    def sweeper_sweeps(self, sent: bool) -> None:
        before = self.job()
        expired = before.state is JobState.RUNNING and before.lease_expires_at < self.now
        with self.database.writing() as session:
            done = sweep(session, now=self.now, wakeup_after=timedelta(seconds=5))
        assert len(done.requeued) + len(done.failed) + len(done.cancelled) == expired
        if sent:
            with self.database.writing() as session:
                wakeups_sent(session, [j.id for j in done.to_wake], now=self.now, wakeup_after=timedelta(seconds=5))

    @invariant()
    def the_row_makes_sense(self) -> None:
        job = self.job()
        assert job.token == len(self.claims)
        assert 0 <= job.attempt <= job.token - self.released
        assert (job.finished_at is not None) == job.state.is_final
        assert (job.lease_expires_at is not None) == (job.state is JobState.RUNNING)
        assert (job.next_wakeup_at is not None) == (job.state is JobState.QUEUED)
        assert (job.error_title is not None) == (job.state is JobState.FAILED)
        assert job.cancel_requested == self.cancel_asked
        assert not (job.cancel_requested and job.state is JobState.QUEUED)
        assert self.ends <= 1

    @invariant()
    def the_stream_tells_the_story(self) -> None:
        with self.database.reading() as session:
            events = list_events(session, self.job_id)
        assert [event.sequence for event in events] == list(range(1, len(events) + 1))
        states = [event.data["state"] for event in events if event.type == "state"]
        assert states[0] == "queued"
        assert states[-1] == self.job().state
        for state, following in pairwise(states):
            assert following in FOLLOWS[state]


TestJobMachine = JobMachine.TestCase
TestJobMachine.settings = settings(
    max_examples=20, stateful_step_count=25, deadline=None, suppress_health_check=list(HealthCheck)
)
