"""The revisions and the tables say the same."""

from collections.abc import Iterator

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import inspect

from models_store.session import Database, upgrade
from models_store.settings import StoreSettings
from models_store.tables import Base


@pytest.fixture(params=["sqlite", "postgres"])
def empty_database(request: pytest.FixtureRequest, tmp_path) -> Iterator[Database]:
    url = request.getfixturevalue("postgres_url") if request.param == "postgres" else ""
    database = Database.connect(StoreSettings(data_dir=tmp_path, database_url=url))
    yield database
    database.close()


def test_upgraded_database_is_what_the_tables_say(empty_database: Database) -> None:
    upgrade(empty_database.engine)
    with empty_database.engine.connect() as connection:
        options = {"compare_type": True, "compare_server_default": True}
        assert compare_metadata(MigrationContext.configure(connection, opts=options), Base.metadata) == []


def test_upgrade_twice_changes_nothing(empty_database: Database) -> None:
    upgrade(empty_database.engine)
    names = sorted(inspect(empty_database.engine).get_table_names())
    upgrade(empty_database.engine)
    assert sorted(inspect(empty_database.engine).get_table_names()) == names
    assert set(names) == {*Base.metadata.tables, "alembic_version"}
