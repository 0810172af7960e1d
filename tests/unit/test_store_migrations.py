"""The revisions and the tables say the same."""

import importlib
import json
from collections.abc import Iterator

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.operations import Operations
from sqlalchemy import inspect, text

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


def test_answers_of_before_say_their_model_in_the_new_way(empty_database: Database) -> None:
    revision = importlib.import_module("models_store.migrations.versions.20261126_estimations")
    tried = [{"model_id": "a", "model_name": "cup", "panorama": 0.1, "distances": None}]
    old = {"layer": 1, "models_tried": [*tried, {**tried[0], "model_id": "b", "model_name": "mug"}]}
    with empty_database.engine.begin() as connection, Operations.context(MigrationContext.configure(connection)):
        connection.execute(text("CREATE TABLE models (id VARCHAR, name TEXT)"))
        connection.execute(text("CREATE TABLE estimations (id VARCHAR, model_id VARCHAR, result JSON)"))
        connection.execute(text("INSERT INTO models VALUES ('a', 'cup')"))
        connection.execute(
            text("INSERT INTO estimations VALUES ('1', 'a', :old), ('2', NULL, NULL)"), {"old": json.dumps(old)}
        )

        def results() -> list[object]:
            rows = connection.execute(text("SELECT result FROM estimations ORDER BY id")).scalars()
            return [json.loads(row) if isinstance(row, str) else row for row in rows]

        revision.upgrade()
        new, nothing = results()
        assert nothing is None
        assert new["model"] == {"id": "a", "name": "cup"}
        assert [one["model"]["name"] for one in new["tried"]] == ["cup", "mug"]
        revision.downgrade()
        back, _ = results()
        assert back["models_tried"] == old["models_tried"]
