"""The broker carries wake-ups and nothing else: a lost one costs seconds, a doubled one nothing."""

import logging
from typing import Any, Final, Protocol

from celery import Celery
from kombu.entity import Exchange, Queue

from models_store import file_transport
from models_store.job_kinds import TASK_NAMES, JobKind
from models_store.settings import StoreSettings

log = logging.getLogger(__name__)

QUEUE: Final = "shapewright"
VISIBILITY_TIMEOUT_S: Final = 3600
"""Redis hands a message that a worker holds unacknowledged to another one after this time. A wake-up is
acknowledged before the work starts, so this concerns only one that waits behind a running job; the second
delivery finds the job taken or done."""


class Waking(Protocol):
    """Anything that knows the id and the kind of a job: a ``JobRow``, a ``QueuedJob``."""

    @property
    def id(self) -> Any:
        """The job's id."""

    @property
    def kind(self) -> Any:
        """The job's kind."""


def celery_options(settings: StoreSettings) -> dict[str, Any]:
    """Celery's configuration, the same for who sends and who works."""
    # the nameless exchange: a routing key is a queue, nothing has to be bound
    queue: Any = Queue(QUEUE, Exchange(""), routing_key=QUEUE)  # type: ignore[no-untyped-call]
    options: dict[str, Any] = {
        "broker_connection_timeout": settings.broker_timeout_s,
        "broker_connection_retry_on_startup": True,
        "broker_connection_max_retries": None,
        "task_default_queue": QUEUE,
        "task_default_exchange": "",
        "task_default_routing_key": QUEUE,
        "task_queues": [queue],
        "task_create_missing_queues": False,
        "task_ignore_result": True,
        "task_store_errors_even_if_ignored": False,
        "task_serializer": "json",
        "accept_content": ["json"],
        "task_acks_late": False,
        "worker_prefetch_multiplier": 1,
    }
    # How long one connection attempt may take before "away" is the answer; the worker's own loop retries above.
    patience: dict[str, Any] = {
        "max_retries": 1,
        "interval_start": 0,
        "interval_step": 0.1,
        "interval_max": 0.1,
        "connect_retries_timeout": settings.broker_timeout_s,
    }
    folder = settings.embedded_broker_folder
    if folder is not None:
        file_transport.register()
        options["broker_url"] = f"{file_transport.SCHEME}://localhost//"
        options["broker_transport_options"] = {"folder": str(folder), **patience}
        options["worker_enable_remote_control"] = False  # the folder has no broadcast
        return options
    options["broker_url"] = settings.broker_url
    if settings.broker_url.startswith(("redis", "sentinel", "valkey")):
        patience |= {
            "visibility_timeout": VISIBILITY_TIMEOUT_S,
            "socket_connect_timeout": settings.broker_timeout_s,
            "socket_timeout": max(settings.broker_timeout_s, 5.0),
            "socket_keepalive": True,
            "health_check_interval": 25,
        }
    options["broker_transport_options"] = patience
    return options


def create_sender(settings: StoreSettings) -> Celery:
    """A Celery that only sends; nothing is connected yet."""
    celery = Celery("shapewright", set_as_current=False)
    celery.conf.update(celery_options(settings))
    return celery


def send_wakeup(celery: Celery, job: Waking) -> bool:
    """Announce a queued job, after its row is committed.

    Returns whether the broker took it. If it is away the job stays queued and the sweeper announces it later,
    so the caller has nothing to do.
    """
    try:
        # A connection of its own: a pooled one that broke while the broker was away would fail once more.
        with celery.connection_for_write() as connection:
            celery.send_task(
                TASK_NAMES[JobKind(job.kind)], args=[job.id], connection=connection, retry=False, queue=QUEUE
            )
    except Exception as error:  # whatever a transport and its driver raise: it is away
        log.warning("broker away, job %s stays queued: %s", job.id, error)
        return False
    return True


def broker_answers(celery: Celery) -> bool:
    """Whether the broker can be reached now; for readiness checks."""
    try:
        with celery.connection_for_write() as connection:
            connection.default_channel.queue_declare(QUEUE, passive=False, durable=True, auto_delete=False)
    except Exception as error:
        log.info("broker away: %s", error)
        return False
    return True
