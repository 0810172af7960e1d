"""Engines and sessions, the same for SQLite and PostgreSQL."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Connection, Engine, NullPool, create_engine, event, make_url, text
from sqlalchemy.exc import InterfaceError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError
from sqlalchemy.orm import Session, sessionmaker

from models_store.settings import StoreSettings

OUTAGES: Final = (OperationalError, InterfaceError, PoolTimeoutError)
"""What SQLAlchemy raises while the database is away (or locked for long): worth another try."""

SQLITE_BUSY_TIMEOUT_S: Final = 30.0
POSTGRES_CONNECT_TIMEOUT_S: Final = 5
_WRITES = "shapewright_writes"
_MIGRATION_LOCK: Final = 0x5AFE_3A9E  # any constant, the same in all processes


def make_engine(settings: StoreSettings, *, pooled: bool = True) -> Engine:
    """Make the engine; it connects when first used.

    Args:
        settings: where the database is. The folder of an SQLite file is created.
        pooled: ``False`` closes every connection right after use. A process that forks while it has an engine
            wants that, as an SQLite connection must not reach a child.
    """
    url = make_url(settings.database_url)
    options: dict[str, Any] = {
        "json_serializer": partial(json.dumps, allow_nan=False, separators=(",", ":")),
        "hide_parameters": True,
    }
    if not pooled:
        options["poolclass"] = NullPool
    if url.get_backend_name() == "sqlite":
        if url.database and url.database != ":memory:":
            Path(url.database).parent.mkdir(parents=True, exist_ok=True)
        engine = create_engine(url, connect_args={"timeout": SQLITE_BUSY_TIMEOUT_S}, **options)
        _prepare_sqlite(engine)
        return engine
    connect_args = {
        "application_name": "shapewright",
        "connect_timeout": POSTGRES_CONNECT_TIMEOUT_S,
        # a server that vanished without a word is noticed in seconds, not hours
        "keepalives_idle": 10,
        "keepalives_interval": 5,
        "keepalives_count": 3,
        "tcp_user_timeout": 20_000,
    }
    return create_engine(url, pool_pre_ping=pooled, connect_args=connect_args, **options)


def _prepare_sqlite(engine: Engine) -> None:
    @event.listens_for(engine, "connect")
    def _on_connect(connection: Any, _record: Any) -> None:
        connection.isolation_level = None  # the driver begins no transactions, _on_begin does
        cursor = connection.cursor()
        cursor.execute("PRAGMA journal_mode=WAL")
        cursor.execute("PRAGMA synchronous=NORMAL")
        cursor.execute("PRAGMA foreign_keys=ON")
        cursor.close()

    @event.listens_for(engine, "begin")
    def _on_begin(connection: Connection) -> None:
        # A deferred transaction that reads first and writes later fails at once when another writer came in
        # between, whatever the busy timeout: so writers take the write lock at the start.
        writes = connection.get_execution_options().get(_WRITES, False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


class Database:
    """Sessions on one engine. Rows stay readable after their session has ended."""

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        self._readers = sessionmaker(engine, expire_on_commit=False, autoflush=False)
        self._writers = sessionmaker(engine.execution_options(**{_WRITES: True}), expire_on_commit=False)

    @classmethod
    def connect(cls, settings: StoreSettings, *, pooled: bool = True) -> "Database":
        """Make an engine and its sessions; nothing is opened yet."""
        return cls(make_engine(settings, pooled=pooled))

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """A session whose reads belong together; nothing written in it is kept."""
        with self._readers() as session:
            yield session

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """A session that commits at the end of the block, or rolls back when the block raises."""
        with self._writers() as session, session.begin():
            yield session

    def ping(self) -> None:
        """Ask the database for a sign of life.

        Raises:
            sqlalchemy.exc.SQLAlchemyError: it does not answer.
        """
        with self.engine.connect() as connection:
            connection.execute(text("SELECT 1"))

    def close(self) -> None:
        """Close all pooled connections."""
        self.engine.dispose()


def upgrade(engine: Engine) -> None:
    """Bring the database to the newest revision; safe when several processes start at once."""
    from alembic import command
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", "models_store:migrations")
    config.set_main_option("path_separator", "os")
    with engine.execution_options(**{_WRITES: True}).begin() as connection:
        if connection.dialect.name == "postgresql":
            connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": _MIGRATION_LOCK})
        config.attributes["connection"] = connection
        command.upgrade(config, "head")
