"""The revisions and the tables say the same."""

import importlib
import json
from collections.abc import Iterator

import pytest
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.operations import Operations
from sqlalchemy import Connection, inspect, text
from sqlalchemy.exc import IntegrityError

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


def test_a_classifier_keeps_what_was_asked_of_it_when_its_job_may_be_missing(empty_database: Database) -> None:
    engine = empty_database.engine
    now = {"now": "2026-12-01 00:00:00+00:00"}
    jobs = ("train", "ask", "index")
    with engine.execution_options(**{"shapewright_writes": True}).begin() as connection:
        _migrate(connection, "20261126_collection_estimations")
        for job in jobs:
            connection.execute(
                text(
                    "INSERT INTO jobs (id, kind, state, payload, result_id, attempt, max_attempts, token, event_count, "
                    "cancel_requested, progress_fraction, progress_message, created_at, wakeup_count) "
                    f"VALUES ('{job}', 'classify', 'succeeded', '{{}}', 'r', 1, 3, 1, 1, false, 1, '', :now, 0)"
                ),
                now,
            )
        connection.execute(
            text(
                "INSERT INTO meshes (id, file_name, file_type, file_size, vertex_count, face_count, bounds, "
                "watertight, source_key, content_key, created_at) "
                "VALUES ('m', 'a.off', 'off', 1, 4, 4, '[]', true, 's', 'c', :now)"
            ),
            now,
        )
        connection.execute(
            text(
                "INSERT INTO classifiers (id, job_id, name, model_ids, class_names, settings, onnx_key, created_at) "
                "VALUES ('old', 'train', 'mine', '[]', '[\"a\"]', '{}', 'k', :now)"
            ),
            now,
        )
        connection.execute(
            text(
                "INSERT INTO classifications (id, job_id, mesh_id, classifier_id, settings, created_at) "
                "VALUES ('asked', 'ask', 'm', 'old', '{}', :now)"
            ),
            now,
        )

    def names() -> list[tuple[str, str | None, str | None]]:
        with engine.connect() as connection:
            found = connection.execute(
                text(
                    "SELECT classifiers.id, classifiers.name, classifications.id FROM classifiers "
                    "LEFT JOIN classifications ON classifier_id = classifiers.id ORDER BY classifiers.id DESC"
                )
            )
            return [tuple(row) for row in found]

    upgrade(engine)
    assert names() == [("old", "mine", "asked")]
    with engine.begin() as connection:
        connection.execute(
            text(
                "INSERT INTO classifiers (id, model_ids, class_names, settings, onnx_key, created_at) "
                "VALUES ('new', '[]', '[]', '{}', 'k', :now)"
            ),
            now,
        )
        connection.execute(
            text(
                "INSERT INTO classifications (id, job_id, mesh_id, classifier_id, settings, created_at) "
                "VALUES ('again', 'index', 'm', 'new', '{}', :now)"
            ),
            now,
        )
    with engine.connect() as connection, pytest.raises(IntegrityError):
        connection.execute(text("DELETE FROM classifiers WHERE id = 'old'"))
    with engine.execution_options(**{"shapewright_writes": True}).begin() as connection:
        _migrate(connection, "20261126_collection_estimations", down=True)
    assert names() == [("old", "mine", "asked")]


def _migrate(connection: Connection, revision: str, *, down: bool = False) -> None:
    config = Config()
    config.set_main_option("script_location", "models_store:migrations")
    config.set_main_option("path_separator", "os")
    config.attributes["connection"] = connection
    (command.downgrade if down else command.upgrade)(config, revision)
