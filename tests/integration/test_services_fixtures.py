"""The fixtures hand out real, empty, separate services."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import psycopg
import pytest
import redis
from services import RedisServer, ServiceMissingError, find_program


def _connect(url: str) -> "psycopg.Connection[tuple[object, ...]]":
    return psycopg.connect(url.replace("+psycopg", ""), autocommit=True)


@pytest.mark.services
def test_two_postgres_databases_do_not_see_each_other(new_postgres_url: Callable[[], str]) -> None:
    first, second = new_postgres_url(), new_postgres_url()
    with _connect(first) as connection:
        connection.execute("CREATE TABLE seen (n int)")
    with _connect(second) as connection:
        row = connection.execute("SELECT to_regclass('seen')").fetchone()
    assert row == (None,)


@pytest.mark.services
def test_redis_is_empty_at_the_start_of_a_test_and_comes_back_on_its_port(redis_url: str) -> None:
    with redis.Redis.from_url(redis_url) as client:
        assert client.dbsize() == 0
    server = RedisServer.start()
    server.stop()
    with pytest.raises(redis.ConnectionError), redis.Redis(port=server.port, retry=None) as client:
        client.ping()
    again = RedisServer.start(server.port)
    assert again.url == server.url
    again.stop()


@pytest.mark.browser
def test_chromium_answers(chromium_path: Path) -> None:
    said = subprocess.run([chromium_path, "--version"], capture_output=True, text=True, check=True).stdout
    assert "chrom" in said.lower()


def test_a_missing_program_names_its_package() -> None:
    with pytest.raises(ServiceMissingError, match="apt-get install no-such-package"):
        find_program("no-such-program", package="no-such-package")
