"""The broker carries wake-ups; one that is away is an answer, not an error."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Empty

import kombu
import pytest
from services import free_port

from models_store.broker import QUEUE, broker_answers, celery_options, create_sender, send_wakeup
from models_store.jobs import JobKind
from models_store.settings import StoreSettings
from models_store.sweep import QueuedJob

JOB = QueuedJob("0" * 32, JobKind.ESTIMATE)


def connect(settings: StoreSettings) -> kombu.Connection:
    options = celery_options(settings)
    return kombu.Connection(options["broker_url"], transport_options=options["broker_transport_options"])


def taken(connection: kombu.Connection) -> list[str]:
    """Take all messages; the ids of their jobs."""
    ids = []
    with connection.SimpleQueue(QUEUE) as queue:
        while True:
            try:
                message = queue.get_nowait()
            except Empty:
                return ids
            assert message.headers["task"] == "shapewright.estimate"
            ids.append(message.payload[0][0])
            message.ack()


@pytest.fixture(params=["embedded", pytest.param("redis", marks=pytest.mark.services)])
def settings(request: pytest.FixtureRequest, tmp_path: Path) -> StoreSettings:
    url = request.getfixturevalue("redis_url") if request.param == "redis" else ""
    return StoreSettings(data_dir=tmp_path, broker_url=url)


def test_a_wakeup_arrives_once(settings: StoreSettings) -> None:
    sender = create_sender(settings)
    assert broker_answers(sender)
    assert send_wakeup(sender, JOB) is True
    with connect(settings) as connection:
        assert taken(connection) == [JOB.id]
        assert taken(connection) == []


def test_a_broker_server_that_is_away_is_said(tmp_path: Path) -> None:
    settings = StoreSettings(data_dir=tmp_path, broker_url=f"redis://127.0.0.1:{free_port()}/0", broker_timeout_s=0.5)
    sender = create_sender(settings)
    assert send_wakeup(sender, JOB) is False
    assert not broker_answers(sender)  # and not "never", which is Celery's default


def test_an_embedded_broker_that_cannot_be_written(tmp_path: Path) -> None:
    settings = StoreSettings(data_dir=tmp_path)
    sender = create_sender(settings)
    folder = settings.embedded_broker_folder
    folder.write_text("in the way")
    assert send_wakeup(sender, JOB) is False
    assert not broker_answers(sender)
    folder.unlink()
    assert send_wakeup(sender, JOB) is True


def test_messages_of_the_folder_come_in_order_and_once(tmp_path: Path) -> None:
    settings = StoreSettings(data_dir=tmp_path)
    sender = create_sender(settings)
    ids = [f"{number:032x}" for number in range(30)]
    for identifier in ids:
        assert send_wakeup(sender, QueuedJob(identifier, JobKind.ESTIMATE))

    def take(_: int) -> list[str]:
        with connect(settings) as connection:
            return taken(connection)

    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(take, range(4)))
    for some in found:
        assert some == sorted(some)
    assert sorted(identifier for some in found for identifier in some) == ids


def test_damaged_and_unfinished_messages_do_not_stop_the_folder(tmp_path: Path) -> None:
    settings = StoreSettings(data_dir=tmp_path)
    sender = create_sender(settings)
    queue = settings.embedded_broker_folder / QUEUE
    queue.mkdir(parents=True)
    (queue / "0-damaged.message").write_text("{")
    (queue / "0-half.partial").write_text("{")
    assert send_wakeup(sender, JOB)
    with connect(settings) as connection:
        assert taken(connection) == [JOB.id]
    assert [path.name for path in queue.iterdir()] == ["0-half.partial"]
