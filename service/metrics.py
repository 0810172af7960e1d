"""Figures for Prometheus; each app has its own registry."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, PlatformCollector, ProcessCollector
from prometheus_client.core import GaugeMetricFamily, Metric
from prometheus_client.registry import Collector
from sqlalchemy.exc import SQLAlchemyError

from models_store.job_kinds import JobKind, JobState

JobCounts = Mapping[tuple[JobKind, JobState], int]


class _JobCollector(Collector):
    """Counts the jobs when somebody looks, so that every API process tells the same."""

    def __init__(self, count: Callable[[], JobCounts]) -> None:
        self._count = count

    def describe(self) -> list[Metric]:
        """Nothing: the registry must not ask the database when the collector is registered."""
        return []

    def collect(self) -> Iterator[Metric]:
        """Ask the database."""
        try:
            counts = self._count()
        except SQLAlchemyError:
            return
        family = GaugeMetricFamily("shapewright_jobs", "Jobs by kind and state", labels=("kind", "state"))
        for kind in JobKind:
            for state in JobState:
                family.add_metric((kind.value, state.value), counts.get((kind, state), 0))
        yield family


class Metrics:
    """What the service counts and measures."""

    def __init__(self, count_jobs: Callable[[], JobCounts]) -> None:
        self.registry = CollectorRegistry()
        ProcessCollector(registry=self.registry)
        PlatformCollector(registry=self.registry)
        self.registry.register(_JobCollector(count_jobs))
        options: dict[str, Any] = {"registry": self.registry}
        labels = ("method", "route")
        self.requests = Counter("shapewright_http_requests_total", "Answered requests", (*labels, "status"), **options)
        self.seconds = Histogram(
            "shapewright_http_request_seconds", "Seconds until a response has ended", labels, **options
        )
        self.in_flight = Gauge("shapewright_http_requests_in_flight", "Requests being answered", **options)
        self.instance_seconds = Histogram(
            "shapewright_instance_seconds",
            "Seconds to generate an instance",
            buckets=(0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2.5),
            **options,
        )
        self.upload_seconds = Histogram(
            "shapewright_mesh_parse_seconds", "Seconds to read an uploaded mesh in its child process", **options
        )
        self.wakeups_lost = Counter(
            "shapewright_wakeups_lost_total", "Jobs announced while the broker was away", **options
        )
