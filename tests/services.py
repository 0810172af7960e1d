"""Real servers for tests: PostgreSQL and Redis on free loopback ports, and the path of Chromium.

Nothing is mocked: a test that needs PostgreSQL gets a PostgreSQL server that was started for this test
process (with pytest-xdist each worker has its own) in a temporary folder, and a fresh database in it. Without
the program :class:`ServiceMissingError` is raised; the fixtures in ``conftest.py`` skip then on a laptop and
fail in CI.
"""

import contextlib
import ctypes
import os
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import psycopg
import redis
from redis.backoff import NoBackoff
from redis.retry import Retry
from waiting import PATIENCE_S

PORT_ATTEMPTS = 3


class ServiceMissingError(Exception):
    """A program that a test needs is not on this machine; the message says how to get it."""


class ServiceFailedError(Exception):
    """A program is there but did not start; the message holds the end of its log."""


def free_port() -> int:
    """Return a loopback TCP port that nobody listens on right now."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def find_program(*names: str, extra: tuple[Path, ...] = (), package: str) -> Path:
    """Return the first of ``names`` in ``PATH`` or in the ``extra`` folders, or raise ServiceMissingError."""
    for name in names:
        for folder in extra:
            if (folder / name).is_file():
                return folder / name
        found = shutil.which(name)
        if found:
            return Path(found)
    raise ServiceMissingError(f"{names[0]} is not installed (Debian and Ubuntu: apt-get install {package})")


def _postgres_folders() -> tuple[Path, ...]:
    """Debian keeps the server programs outside PATH, one folder a version; newest first."""
    folders = Path("/usr/lib/postgresql").glob("*/bin")
    return tuple(sorted(folders, key=lambda p: int(p.parent.name.split(".")[0]), reverse=True))


def _die_with_parent() -> None:
    """Run in the child before exec: a killed test process leaves no server behind (Linux only)."""
    if sys.platform == "linux":
        pr_set_pdeathsig = 1
        ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGINT)


def _wait_until_ready(
    process: "subprocess.Popen[bytes]", log: Path, probe: Callable[[], None], errors: type[Exception]
) -> None:
    deadline = time.monotonic() + PATIENCE_S
    while True:
        try:
            probe()
            return
        except errors as error:
            if process.poll() is not None or time.monotonic() > deadline:
                process.kill()
                process.wait()
                tail = log.read_text(errors="replace")[-2000:] if log.exists() else ""
                raise ServiceFailedError(f"{process.args!r} did not start: {error}\n{tail}") from error
            time.sleep(0.05)


def _stop(process: "subprocess.Popen[bytes]", stop_signal: signal.Signals) -> None:
    process.send_signal(stop_signal)
    try:
        process.wait(timeout=20)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


@dataclass(frozen=True)
class PostgresServer:
    """A running PostgreSQL server; every :meth:`create_database` is a new, empty database."""

    port: int
    folder: Path
    process: "subprocess.Popen[bytes]"

    @classmethod
    def start(cls) -> "PostgresServer":
        """Initialise a cluster in a temporary folder and start it; as root it runs as user ``postgres``."""
        server = find_program("postgres", extra=_postgres_folders(), package="postgresql")
        initdb = find_program("initdb", extra=(server.parent,), package="postgresql")
        owner: str | None = None
        if os.geteuid() == 0:  # the server refuses to run as root
            try:
                owner = pwd.getpwnam("postgres").pw_name
            except KeyError:
                raise ServiceMissingError("PostgreSQL cannot run as root and there is no user 'postgres'") from None
        folder = Path(tempfile.mkdtemp(prefix="shapewright-postgres-"))
        try:
            if owner:
                shutil.chown(folder, owner, owner)
            options = ["-U", "shapewright", "--auth=trust", "-E", "UTF8", "--locale=C", "--no-sync"]
            made = subprocess.run(
                [initdb, "-D", folder / "data", *options],
                user=owner, group=owner, extra_groups=[] if owner else None, cwd=folder,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
            )  # fmt: skip
            if made.returncode != 0:
                raise ServiceFailedError(f"initdb failed:\n{made.stdout.decode(errors='replace')[-2000:]}")
            for attempt in range(PORT_ATTEMPTS):
                try:
                    return cls._launch(server, folder, owner)
                except ServiceFailedError:  # somebody may have taken the port in between
                    if attempt == PORT_ATTEMPTS - 1:
                        raise
            raise AssertionError("unreachable")
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise

    @classmethod
    def _launch(cls, server: Path, folder: Path, owner: str | None) -> "PostgresServer":
        port = free_port()
        options = {
            "listen_addresses": "127.0.0.1", "port": port, "unix_socket_directories": folder, "fsync": "off",
            "full_page_writes": "off", "synchronous_commit": "off", "shared_buffers": "32MB",
        }  # fmt: skip
        arguments = [word for name, value in options.items() for word in ("-c", f"{name}={value}")]
        log = folder / "server.log"
        with log.open("wb") as out:
            process = subprocess.Popen(
                [server, "-D", folder / "data", *arguments],
                user=owner, group=owner, extra_groups=[] if owner else None, cwd=folder,
                stdin=subprocess.DEVNULL, stdout=out, stderr=out, preexec_fn=_die_with_parent,
            )  # fmt: skip
        running = cls(port, folder, process)
        _wait_until_ready(process, log, running._probe, psycopg.Error)
        return running

    def _connect(self) -> "psycopg.Connection[tuple[object, ...]]":
        return psycopg.connect(host="127.0.0.1", port=self.port, user="shapewright", dbname="postgres", autocommit=True)

    def _probe(self) -> None:
        self._connect().close()

    def create_database(self) -> str:
        """Create an empty database and return its SQLAlchemy address (``postgresql+psycopg://…``)."""
        name = f"test_{uuid.uuid4().hex}"
        with self._connect() as connection:
            connection.execute(f'CREATE DATABASE "{name}" TEMPLATE template0')
        return f"postgresql+psycopg://shapewright@127.0.0.1:{self.port}/{name}"

    def drop_database(self, url: str) -> None:
        """Drop a database made by :meth:`create_database`, also when a leaked connection still uses it."""
        name = url.rsplit("/", 1)[1]
        with self._connect() as connection:
            connection.execute(f'DROP DATABASE IF EXISTS "{name}" WITH (FORCE)')

    def stop(self) -> None:
        """Stop the server and remove its folder."""
        _stop(self.process, signal.SIGINT)  # "fast shutdown": open connections are closed
        shutil.rmtree(self.folder, ignore_errors=True)


@dataclass(frozen=True)
class RedisServer:
    """A running Redis server that keeps nothing on disk."""

    port: int
    folder: Path
    process: "subprocess.Popen[bytes]"

    @property
    def url(self) -> str:
        """Return the address of its database 0."""
        return f"redis://127.0.0.1:{self.port}/0"

    @classmethod
    def start(cls, port: int | None = None) -> "RedisServer":
        """Start a server on ``port`` (default: a free one); give the port to bring a stopped one back."""
        program = find_program("redis-server", package="redis-server")
        folder = Path(tempfile.mkdtemp(prefix="shapewright-redis-"))
        try:
            for attempt in range(PORT_ATTEMPTS):
                try:
                    return cls._launch(program, folder, port or free_port())
                except ServiceFailedError:
                    if port is not None or attempt == PORT_ATTEMPTS - 1:
                        raise
            raise AssertionError("unreachable")
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise

    @classmethod
    def _launch(cls, program: Path, folder: Path, port: int) -> "RedisServer":
        log = folder / "server.log"
        with log.open("wb") as out:
            process = subprocess.Popen(
                [program, "--bind", "127.0.0.1", "--port", str(port), "--save", "", "--appendonly", "no"],
                cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=out, preexec_fn=_die_with_parent,
            )  # fmt: skip
        running = cls(port, folder, process)
        _wait_until_ready(process, log, running.flush, redis.RedisError)
        return running

    def flush(self) -> None:
        """Forget everything."""
        with redis.Redis(host="127.0.0.1", port=self.port, retry=Retry(NoBackoff(), 0)) as client:
            client.flushall()

    def stop(self) -> None:
        """Stop the server and remove its folder."""
        _stop(self.process, signal.SIGTERM)
        shutil.rmtree(self.folder, ignore_errors=True)


def find_chromium() -> Path:
    """Return the system's Chromium (or Chrome) program."""
    return find_program("chromium", "chromium-browser", "google-chrome", package="chromium")


@contextlib.contextmanager
def logged_process(
    arguments: Sequence[str | Path], *, log: Path, cwd: Path, env: Mapping[str, str]
) -> "Iterator[subprocess.Popen[bytes]]":
    """Run a program beside the test, its output in ``log``; it is stopped with SIGTERM at the end."""
    with log.open("wb") as out:
        process = subprocess.Popen(
            arguments, cwd=cwd, env=env, stdin=subprocess.DEVNULL, stdout=out, stderr=out,
            preexec_fn=_die_with_parent,
        )  # fmt: skip
    try:
        yield process
    finally:
        _stop(process, signal.SIGTERM)
