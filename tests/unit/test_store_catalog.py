"""The catalogue: the same content is the same thing, and results belong to the jobs that fill them in."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Barrier

import numpy as np
import pytest
from store_support import LEASE, FakeClock, clock, database  # noqa: F401 - fixtures
from worker_support import brick, rod

from models_store import catalog, claims
from models_store.artifacts import ArtifactStore
from models_store.errors import ArtifactError, CursorError, NotFoundError, NotReadyError, StoreError
from models_store.jobs import JobKind, JobState
from models_store.session import Database
from models_store.tables import MeshRow
from shapewright.mesh import TriangleMesh

TETRAHEDRON = TriangleMesh(
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
)


@pytest.fixture
def artifacts() -> ArtifactStore:
    return ArtifactStore.open("memory://")


def add_model(database: Database, now, model=None) -> str:  # noqa: F811
    with database.writing() as session:
        return catalog.add_model(session, model or brick(), now=now)[0].id


def store_tetrahedron(database: Database, artifacts: ArtifactStore, now) -> tuple[MeshRow, bool]:  # noqa: F811
    data = TETRAHEDRON.to_bytes("off")
    return catalog.store_mesh(
        database, artifacts, data, file_name="t\0\ud800.off", file_type="off", mesh=TETRAHEDRON, now=now
    )


def test_the_same_model_twice_is_one_model(database: Database, clock: FakeClock) -> None:  # noqa: F811
    with database.writing() as session:
        first, is_new = catalog.add_model(session, brick(), now=clock.now)
        assert is_new
    clock.forward(10)
    with database.writing() as session:
        second, is_new = catalog.add_model(session, brick(), now=clock.now)
        assert not is_new
    assert (second.id, second.created_at) == (first.id, first.created_at)
    assert first.id == brick().digest
    assert second.parameters == [
        {
            "name": "height", "label": "height", "unit": None, "base_value": None, "kind": None, "minimum": 0.3,
            "maximum": 2.0, "default": 1.0, "options": [], "active_when": [], "limits": [],
        }
    ]  # fmt: skip
    assert (second.parts, second.symmetry) == ([], {"mirrors": [], "axis": None, "order": 1})
    assert second.document == brick().to_json()


def test_uploads_of_the_same_model_at_the_same_time_are_one_model(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
) -> None:
    barrier = Barrier(6)

    def upload(_: int) -> bool:
        barrier.wait()
        with database.writing() as session:
            return catalog.add_model(session, brick(), now=clock.now)[1]

    with ThreadPoolExecutor(6) as pool:
        assert sum(pool.map(upload, range(6))) == 1


def test_the_same_mesh_twice_is_one_mesh(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
) -> None:
    first, is_new = store_tetrahedron(database, artifacts, clock.now)
    assert is_new
    assert (first.vertex_count, first.face_count, first.watertight) == (4, 4, True)
    assert first.bounds == [[0, 0, 0], [1, 1, 1]]
    assert first.file_name == "t?.off"
    assert artifacts.get(first.source_key) == TETRAHEDRON.to_bytes("off")
    assert artifacts.get(first.content_key)[:4] == b"glTF"
    second, is_new = store_tetrahedron(database, artifacts, clock.forward(1))
    assert (second.id, is_new) == (first.id, False)


def test_a_mesh_for_which_there_is_no_room_leaves_nothing_behind(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
) -> None:
    class AlmostFull(ArtifactStore):
        def put(self, key: str, data: bytes) -> None:
            if key.endswith("mesh.glb"):
                raise ArtifactError("there is no space left to store this (the disk is full)")
            artifacts.put(key, data)

        def delete(self, key: str) -> None:
            artifacts.delete(key)

    with pytest.raises(ArtifactError):
        store_tetrahedron(database, AlmostFull(artifacts._store), clock.now)
    identifier = catalog.mesh_id(TETRAHEDRON.to_bytes("off"))
    assert not artifacts.exists(f"meshes/{identifier}/source.off")
    with database.reading() as session, pytest.raises(NotFoundError):
        catalog.get_mesh(session, identifier)


def test_a_classifier_is_asked_for_trained_and_used(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
) -> None:
    models = [add_model(database, clock.now), add_model(database, clock.now, rod())]
    mesh, _ = store_tetrahedron(database, artifacts, clock.now)
    with database.writing() as session, pytest.raises(NotReadyError, match="no classifier"):
        catalog.request_classification(session, mesh.id, None, {}, now=clock.now)
    with database.writing() as session:
        row = catalog.request_classifier(session, [*models, models[0]], {"epochs": 2}, name="n\0", now=clock.now)
    assert (row.model_ids, row.class_names, row.name) == (models, ["brick", "rod"], "n")
    assert (row.negative_model_ids, row.exemplars_key) == ([], None)
    assert (row.job.kind, row.job.state, row.job.result_id) == (JobKind.TRAIN_CLASSIFIER, JobState.QUEUED, row.id)
    with database.writing() as session, pytest.raises(NotReadyError, match="queued"):
        catalog.request_classification(session, mesh.id, row.id, {}, now=clock.now)
    with database.reading() as session:
        assert catalog.newest_classifier(session) is None
    with database.writing() as session:
        held = claims.claim(session, row.job_id, now=clock.now, lease=LEASE)
    with database.writing() as session:
        claims.finish(session, held, now=clock.now)
        catalog.record_classifier(
            session, row.id, onnx_key="k", class_names=["brick", "rod"], metrics={"accuracy": 1.0}, seconds=2.5
        )
    with database.writing() as session:
        request = catalog.request_classification(session, mesh.id, None, {"views": 3}, now=clock.now)
    assert request.classifier_id == row.id
    with database.reading() as session:
        (listed,) = catalog.list_classifiers(session).items
        assert (listed.job.state, listed.metrics, listed.seconds) == (JobState.SUCCEEDED, {"accuracy": 1.0}, 2.5)


def test_one_class_is_nothing_to_tell_apart(database: Database, clock: FakeClock) -> None:  # noqa: F811
    model_id = add_model(database, clock.now)
    for model_ids in ([], [model_id], [model_id, model_id]):
        with database.writing() as session, pytest.raises(StoreError) as caught:
            catalog.request_classifier(session, model_ids, {}, now=clock.now)
        assert caught.value.where == "model_ids"


def test_negative_models_are_of_no_learned_class(database: Database, clock: FakeClock) -> None:  # noqa: F811
    models = [add_model(database, clock.now), add_model(database, clock.now, rod())]
    other = add_model(database, clock.now, replace(rod(), class_name="pipe"))
    bigger = add_model(database, clock.now, replace(rod(), name="bigger"))
    with database.writing() as session:
        row = catalog.request_classifier(session, models, {}, negative_model_ids=[other, other], now=clock.now)
    assert row.negative_model_ids == [other]
    for negative in (models[0], bigger):
        with database.writing() as session, pytest.raises(StoreError, match="the classifier learns") as caught:
            catalog.request_classifier(session, models, {}, negative_model_ids=[other, negative], now=clock.now)
        assert caught.value.where == "negative_model_ids[1]"
    with database.writing() as session, pytest.raises(NotFoundError):
        catalog.request_classifier(session, models, {}, negative_model_ids=["0" * 64], now=clock.now)


def test_an_extension_has_the_models_of_both_and_needs_those_of_its_base(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
) -> None:
    pipe = replace(rod(), class_name="pipe")
    models = [add_model(database, clock.now), add_model(database, clock.now, rod())]
    other, tube = add_model(database, clock.now, pipe), add_model(database, clock.now, replace(pipe, class_name="tube"))
    with database.writing() as session:
        base = catalog.request_classifier(session, models, {}, negative_model_ids=[other, tube], now=clock.now)
    with database.writing() as session, pytest.raises(NotReadyError, match="queued"):
        catalog.request_classifier(session, [other], {}, base_classifier_id=base.id, now=clock.now)
    with database.writing() as session:
        catalog.record_classifier(session, base.id, onnx_key="k", class_names=["rod", "brick"], metrics={}, seconds=1)
    with database.writing() as session:
        row = catalog.request_classifier(session, [other], {}, base_classifier_id=base.id, now=clock.now)
    assert (row.class_names, row.model_ids) == (["rod", "brick", "pipe"], [*models, other])
    assert row.negative_model_ids == [tube], "as the base, without what is a class now"
    with database.writing() as session, pytest.raises(StoreError, match="knows the class 'rod'") as caught:
        catalog.request_classifier(session, [other, models[1]], {}, base_classifier_id=base.id, now=clock.now)
    assert caught.value.where == "model_ids[1]"
    with database.writing() as session:
        session.delete(catalog.get_model(session, models[0]))
    with database.writing() as session, pytest.raises(StoreError, match="1 of the models") as caught:
        catalog.request_classifier(session, [other], {}, base_classifier_id=base.id, now=clock.now)
    assert caught.value.where == "base_classifier_id"
    assert models[0] in str(caught.value)


def test_requests_for_what_is_not_there_leave_nothing_behind(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
) -> None:
    mesh, _ = store_tetrahedron(database, artifacts, clock.now)
    model_id = add_model(database, clock.now)
    nothing = "0" * 64
    for mesh_id, other in ((nothing, model_id), (mesh.id, nothing), ("\0", model_id), (mesh.id, "' OR 1=1")):
        with database.writing() as session, pytest.raises(NotFoundError):
            catalog.request_estimation(session, mesh_id, other, {}, now=clock.now)
    with database.writing() as session, pytest.raises(NotFoundError):
        catalog.request_thumbnail(session, nothing, now=clock.now)
    with database.reading() as session:
        assert list(catalog.list_estimations(session).items) == []


@pytest.mark.parametrize("cursor", ["", "x", "bm9wZQ==", "WzEsMl0=", "W10=", "é", "WyIyMDMwLTAxLTAxIiwgImEiXQ=="])
def test_a_cursor_of_somewhere_else_is_refused(database: Database, cursor: str) -> None:  # noqa: F811
    with database.reading() as session, pytest.raises(CursorError) as caught:
        catalog.list_models(session, cursor=cursor)
    assert caught.value.where == "cursor"


def test_limits_are_checked(database: Database) -> None:  # noqa: F811
    for limit in (0, -1, 201):
        with database.reading() as session, pytest.raises(CursorError):
            catalog.list_meshes(session, limit=limit)


def test_settings_fill_each_other_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from models_store.settings import StoreSettings

    monkeypatch.setenv("SHAPEWRIGHT_DATA_DIR", str(tmp_path))
    monkeypatch.setenv("SHAPEWRIGHT_BROKER_URL", "")
    settings = StoreSettings()
    assert settings.database_url == f"sqlite:///{tmp_path}/shapewright.db"
    assert settings.artifacts_url == (tmp_path / "artifacts").as_uri()
    assert settings.embedded_broker_folder == tmp_path / "broker"
    monkeypatch.setenv("SHAPEWRIGHT_DATABASE_URL", "postgres://me:secret@here/db")
    monkeypatch.setenv("SHAPEWRIGHT_BROKER_URL", "redis://here/0")
    settings = StoreSettings()
    assert settings.database_url == "postgresql+psycopg://me:secret@here/db"
    assert settings.embedded_broker_folder is None
    assert "secret" not in repr(settings)
    assert list(tmp_path.iterdir()) == []  # reading settings makes nothing
