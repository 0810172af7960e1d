"""How jobs begin and end in a worker, with tasks of a few lines in place of the real ones."""

import time
from collections.abc import Callable, Iterator
from datetime import timedelta
from pathlib import Path
from types import MappingProxyType

import pytest
from sqlalchemy.exc import OperationalError
from store_support import clock, database, queue_job  # noqa: F401 - fixtures
from waiting import wait_until
from worker_support import now

from models_store import claims
from models_store.artifacts import ArtifactStore
from models_store.job_kinds import TASK_NAMES, JobKind
from models_store.jobs import JobState, get_job, list_events, request_cancel
from models_store.session import Database
from models_store.sweep import sweep
from models_store.tables import JobRow
from shapewright.errors import Cancelled, MeshFileError
from workers import runner as runner_module
from workers.app import create_celery
from workers.context import JobContext, Outcome
from workers.runner import Runner
from workers.settings import WorkerSettings
from workers.stopping import StopNotice
from workers.tasks import TASKS

Task = Callable[[JobContext], Outcome]


def nothing(_: object) -> None:
    """Record nothing."""


class Bench:
    """A runner in this process whose every job runs one given task."""

    def __init__(self, database: Database, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
        self.database = database
        self.artifacts = ArtifactStore.open("memory://")
        self.stop_notice = StopNotice()
        self.settings = WorkerSettings(
            data_dir=folder, lease_s=0.6, progress_interval_s=0.02, cancel_check_s=0.02, retry_delay_s=0,
            result_patience_s=0.0,
        )  # fmt: skip
        self._patch = monkeypatch

    def run(self, task: Task, job_id: str | None = None, database: Database | None = None, **settings) -> str:  # noqa: F811
        """Run a (new) job with this task; returns its id."""
        job_id = job_id or queue_job(self.database, now(), max_attempts=2)
        self._patch.setattr(runner_module, "TASKS", MappingProxyType(dict.fromkeys(JobKind, task)))
        Runner(
            self.settings.model_copy(update=settings), self.stop_notice,
            database=database or self.database, artifacts=self.artifacts,
        ).run(job_id)  # fmt: skip
        return job_id

    def job(self, job_id: str) -> JobRow:
        with self.database.reading() as session:
            return get_job(session, job_id)

    def cancel(self, job_id: str) -> None:
        with self.database.writing() as session:
            request_cancel(session, job_id, now=now())

    def steal(self, job_id: str) -> claims.Claim:
        """Let another worker take a running job, as if this one had been silent for long."""
        later = now() + timedelta(hours=1)
        with self.database.writing() as session:
            sweep(session, now=later, wakeup_after=timedelta(seconds=5))
            held = claims.claim(session, job_id, now=later, lease=timedelta(hours=1))
        assert held is not None
        return held


@pytest.fixture
def bench(database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:  # noqa: F811
    return Bench(database, tmp_path / "bench", monkeypatch)


def wait_for(report: Callable[[], None]) -> None:
    """Report until that raises."""
    wait_until(report, lambda: "nobody stopped the work")


def test_every_kind_of_job_has_its_task(tmp_path: Path) -> None:
    celery = create_celery(WorkerSettings(data_dir=tmp_path / "data"))
    assert set(TASKS) == set(JobKind) == set(TASK_NAMES)
    assert set(TASK_NAMES.values()) <= set(celery.tasks)
    assert not (tmp_path / "data").exists()  # nothing is opened before the first job


def test_applications_in_one_process_have_tasks_of_their_own(tmp_path: Path) -> None:
    first, second = (create_celery(WorkerSettings(data_dir=tmp_path / name)) for name in ("first", "second"))
    name = TASK_NAMES[JobKind.CLASSIFY]
    assert first.tasks[name].app is first
    assert second.tasks[name].app is second
    assert first.tasks[name] is not second.tasks[name]


def test_the_result_is_written_with_the_end(bench: Bench) -> None:
    written = []

    def task(context: JobContext) -> Outcome:
        context.progress.report(0.5, "half")
        context.artifacts.put("a/b", b"result")
        return Outcome(lambda session: written.append(get_job(session, context.claim.job_id).state), ("a/b",))

    job_id = bench.run(task)
    assert bench.job(job_id).state is JobState.SUCCEEDED
    assert written == [JobState.SUCCEEDED]
    assert bench.artifacts.get("a/b") == b"result"


@pytest.mark.parametrize("job_id", ["0" * 32, "", "nonsense \0"])
def test_a_delivery_without_a_job_is_harmless(bench: Bench, job_id: str) -> None:
    bench.run(lambda context: pytest.fail("there is no such job"), job_id or "x")


def test_a_second_delivery_is_harmless(bench: Bench) -> None:
    job_id = bench.run(lambda context: Outcome(nothing))
    bench.run(lambda context: pytest.fail("it is done"), job_id)
    assert bench.job(job_id).attempt == 1


def test_a_delivery_too_many_begins_what_has_waited_longest(bench: Bench) -> None:
    """Deliveries of a busy worker pile up; new work must not wait behind those whose jobs are done."""
    done = bench.run(lambda context: Outcome(nothing))
    waiting = [queue_job(bench.database, now()) for _ in range(2)]
    bench.run(lambda context: Outcome(nothing), done)
    assert [bench.job(job_id).state for job_id in waiting] == [JobState.SUCCEEDED, JobState.QUEUED]


def test_a_delivery_too_many_begins_nothing_that_shall_wait(bench: Bench) -> None:
    done = bench.run(lambda context: Outcome(nothing))

    def broken(context: JobContext) -> Outcome:
        raise ZeroDivisionError

    later = bench.run(broken, retry_delay_s=60)
    bench.run(lambda context: pytest.fail("it is tried again in a minute"), done)
    assert bench.job(later).state is JobState.QUEUED


def test_an_error_of_the_library_is_final_and_clear(bench: Bench) -> None:
    def task(context: JobContext) -> Outcome:
        raise MeshFileError("the file ends in the middle of a face", where="line 12")

    job = bench.job(bench.run(task))
    assert (job.state, job.attempt) == (JobState.FAILED, 1)
    assert (job.error_title, job.error_detail, job.error_where) == (
        "Mesh file error", "the file ends in the middle of a face", "line 12",
    )  # fmt: skip


def test_an_unexpected_error_is_tried_again_and_tells_nothing_internal(bench: Bench) -> None:
    def task(context: JobContext) -> Outcome:
        raise ZeroDivisionError("secret of the house")

    job_id = bench.run(task)
    assert (bench.job(job_id).state, bench.job(job_id).attempt) == (JobState.QUEUED, 1)
    bench.run(task, job_id)
    job = bench.job(job_id)
    assert (job.state, job.attempt) == (JobState.FAILED, 2)
    assert job.error_title == "Unexpected error"
    assert "secret" not in job.error_detail


def test_a_result_that_cannot_be_written_is_an_unexpected_error(bench: Bench) -> None:
    def task(context: JobContext) -> Outcome:
        context.artifacts.put("a/b", b"result")

        def record(session) -> None:
            get_job(session, context.claim.job_id).payload = {"not JSON": float("nan")}
            session.flush()

        return Outcome(record, ("a/b",))

    job_id = bench.run(task)
    assert (bench.job(job_id).state, bench.job(job_id).attempt) == (JobState.QUEUED, 1)
    bench.run(task, job_id)
    assert (bench.job(job_id).state, bench.job(job_id).error_title) == (JobState.FAILED, "Unexpected error")
    assert not bench.artifacts.exists("a/b")


def test_a_cancelled_job_hears_of_it(bench: Bench) -> None:
    def task(context: JobContext) -> Outcome:
        bench.cancel(context.claim.job_id)
        wait_for(lambda: context.progress.report(0.1, "working"))
        return Outcome(nothing)

    assert bench.job(bench.run(task)).state is JobState.CANCELLED


def test_a_cancelled_job_may_leave_its_best(bench: Bench) -> None:
    written = []

    def task(context: JobContext) -> Outcome:
        bench.cancel(context.claim.job_id)
        with pytest.raises(Cancelled):
            wait_for(lambda: context.progress.report(0.1, "working"))
        return Outcome(lambda session: written.append("best so far"), cancelled=True)

    assert bench.job(bench.run(task)).state is JobState.CANCELLED
    assert written == ["best so far"]


def test_the_lease_is_renewed_while_nothing_is_reported(bench: Bench) -> None:
    def task(context: JobContext) -> Outcome:
        for _ in range(2):  # not a word meanwhile, as in a native call
            before = bench.job(context.claim.job_id).lease_expires_at
            wait_until(lambda before=before: bench.job(context.claim.job_id).lease_expires_at > before)
        return Outcome(nothing)

    job = bench.job(bench.run(task))
    assert (job.state, job.attempt) == (JobState.SUCCEEDED, 1)


def test_a_worker_that_lost_its_job_hears_of_it_and_leaves_nothing(bench: Bench) -> None:
    others = []

    def task(context: JobContext) -> Outcome:
        others.append(bench.steal(context.claim.job_id))
        wait_for(lambda: context.progress.report(0.1, "working"))
        return Outcome(nothing)

    job = bench.job(bench.run(task))
    assert (job.state, job.token) == (JobState.RUNNING, others[0].token)


def test_a_result_of_a_lost_job_is_not_kept(bench: Bench) -> None:
    written = []

    def task(context: JobContext) -> Outcome:
        bench.steal(context.claim.job_id)
        key = context.own_key("a/result", "bin")
        context.artifacts.put(key, b"late")
        return Outcome(written.append, (key,))

    job = bench.job(bench.run(task))
    assert job.state is JobState.RUNNING
    assert written == []
    assert not bench.artifacts.exists("a/result-1.bin")


def test_a_worker_that_stops_gives_the_job_back(bench: Bench) -> None:
    def task(context: JobContext) -> Outcome:
        bench.stop_notice.announce(0.1)
        wait_for(lambda: context.progress.report(0.1, "working"))
        return Outcome(nothing)

    job_id = bench.run(task)
    assert (bench.job(job_id).state, bench.job(job_id).attempt) == (JobState.QUEUED, 0)
    bench.run(lambda context: pytest.fail("this worker takes no more jobs"), job_id)


def test_progress_is_written_at_most_so_often_and_the_last_is_not_lost(bench: Bench) -> None:
    def task(context: JobContext) -> Outcome:
        began = time.monotonic()
        for step in range(10_001):
            context.progress.report(step / 10_000, f"step {step}")
        wait_until(lambda: bench.job(context.claim.job_id).progress_fraction == 1.0)
        took.append(time.monotonic() - began)
        return Outcome(nothing)

    took: list[float] = []
    job_id = bench.run(task, progress_interval_s=0.1)
    with bench.database.reading() as session:
        events = [event for event in list_events(session, job_id) if event.type == "progress"]
    assert 1 <= len(events) <= took[0] / 0.1 + 2
    assert events[-1].data == {"fraction": 1.0, "message": "step 10000"}


class Flaky(Database):
    """A database whose next transactions break, before or after they are written."""

    def __init__(self, database: Database, *, breaks: int, after_commit: bool) -> None:  # noqa: F811
        super().__init__(database.engine)
        self._real = database
        self.breaks = breaks
        self._after_commit = after_commit
        self.armed = False

    def writing(self):
        return self._flaky() if self.armed else self._real.writing()

    def _flaky(self):
        from contextlib import contextmanager

        @contextmanager
        def session() -> Iterator:
            self.breaks -= 1
            broken = self.breaks >= 0
            if broken and not self._after_commit:
                raise OperationalError("COMMIT", {}, Exception("server closed the connection"))
            with self._real.writing() as real:
                yield real
            if broken:
                raise OperationalError("COMMIT", {}, Exception("server closed the connection"))

        return session()


@pytest.mark.parametrize("after_commit", [False, True])
def test_a_result_outlives_a_short_outage_of_the_database(bench: Bench, *, after_commit: bool) -> None:
    flaky = Flaky(bench.database, breaks=2, after_commit=after_commit)

    def task(context: JobContext) -> Outcome:
        context.artifacts.put("a/b", b"precious")
        flaky.armed = True
        return Outcome(nothing, ("a/b",))

    job_id = bench.run(task, database=flaky, lease_s=60, result_patience_s=20)
    assert bench.job(job_id).state is JobState.SUCCEEDED
    assert bench.artifacts.get("a/b") == b"precious"


def test_a_database_that_is_away_at_the_start_leaves_the_job_queued(bench: Bench) -> None:
    flaky = Flaky(bench.database, breaks=1, after_commit=False)
    flaky.armed = True
    job_id = bench.run(lambda context: pytest.fail("not claimed"), database=flaky)
    assert bench.job(job_id).state is JobState.QUEUED
