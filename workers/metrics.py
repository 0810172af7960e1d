"""Prometheus metrics of a worker's main process."""

from prometheus_client import CollectorRegistry, Counter, Gauge, start_http_server

from models_store.job_kinds import JobKind, JobState
from models_store.sweep import Sweep


class SweeperMetrics:
    """What the sweeper sees: how many jobs are in which state, and what it had to repair."""

    def __init__(self, registry: CollectorRegistry | None = None) -> None:
        self.registry = registry or CollectorRegistry()
        self._jobs = Gauge("shapewright_jobs", "Jobs by kind and state", ["kind", "state"], registry=self.registry)
        self._lost = Counter(
            "shapewright_lost_workers", "Jobs whose worker was lost, by their new state", ["state"],
            registry=self.registry,
        )  # fmt: skip
        self._wakeups = Counter("shapewright_wakeups_resent", "Wake-ups that were sent again", registry=self.registry)

    def serve(self, port: int) -> None:
        """Answer scrapes on a port."""
        start_http_server(port, registry=self.registry)

    def observe(self, swept: Sweep, sent: int, counts: dict[tuple[JobKind, JobState], int]) -> None:
        """Take in one sweep."""
        for state, job_ids in (("queued", swept.requeued), ("failed", swept.failed), ("cancelled", swept.cancelled)):
            self._lost.labels(state).inc(len(job_ids))
        self._wakeups.inc(sent)
        for kind in JobKind:
            for state in JobState:
                self._jobs.labels(kind.value, state.value).set(counts.get((kind, state), 0))
