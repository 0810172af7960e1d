"""Collections and retrievals in the catalogue: what they ask for is there, and results belong to their jobs."""

from datetime import datetime
from typing import Any

import pytest
from store_support import LEASE, FakeClock, clock, database  # noqa: F401 - fixtures
from worker_support import brick, rod

from models_store import catalog, claims
from models_store.artifacts import ArtifactStore
from models_store.errors import NotFoundError, NotReadyError, StoreError
from models_store.jobs import JobKind, JobState
from models_store.session import Database
from models_store.tables import CollectionRow
from shapewright.mesh import TriangleMesh
from shapewright.mesh.file import parse_mesh

NOTHING = "0" * 64
SETTINGS: dict[str, Any] = {"evidence": "combined", "limit": 5, "instances": 10, "seed": 0}


def add_meshes(database: Database, now: datetime, count: int) -> list[str]:  # noqa: F811
    artifacts = ArtifactStore.open("memory://")
    ids = []
    for number in range(count):
        data = f"OFF\n4 4 0\n0 0 0\n{number + 1} 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n".encode()
        mesh: TriangleMesh = parse_mesh(data, "off")
        row, _ = catalog.store_mesh(
            database, artifacts, data, file_name=f"m{number}.off", file_type="off", mesh=mesh, now=now
        )
        ids.append(row.id)
    return ids


def add_classifier(database: Database, clock: FakeClock) -> str:  # noqa: F811
    with database.writing() as session:
        models = [catalog.add_model(session, model, now=clock.now)[0].id for model in (brick(), rod())]
        row = catalog.request_classifier(session, models, {}, now=clock.now)
    with database.writing() as session:
        held = claims.claim(session, row.job_id, now=clock.now, lease=LEASE)
        claims.finish(session, held, now=clock.now)
        catalog.record_classifier(session, row.id, onnx_key="k", class_names=["brick", "rod"], metrics={}, seconds=1.0)
    return row.id


def finish(database: Database, row: CollectionRow, now: datetime) -> None:  # noqa: F811
    with database.writing() as session:
        held = claims.claim(session, row.job_id, now=now, lease=LEASE)
        claims.finish(session, held, now=now)
        catalog.record_collection(
            session,
            row.id,
            index_key=f"collections/{row.id}.npz",
            skipped=[{"mesh_id": "m", "reason": "r"}],
            seconds=2.0,
        )


def test_a_collection_is_asked_for_indexed_and_looked_through(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
) -> None:
    meshes = add_meshes(database, clock.now, 3)
    with database.writing() as session, pytest.raises(NotReadyError, match="no classifier"):
        catalog.request_collection(session, meshes, None, now=clock.now)
    classifier = add_classifier(database, clock)
    with database.writing() as session:
        row = catalog.request_collection(session, [*meshes, meshes[0]], None, name="all\0", now=clock.now)
    assert (row.mesh_ids, row.classifier_id, row.name) == (meshes, classifier, "all")
    assert (row.job.kind, row.job.state, row.job.payload) == (
        JobKind.INDEX_COLLECTION, JobState.QUEUED, {"collection_id": row.id},
    )  # fmt: skip
    with database.writing() as session, pytest.raises(NotReadyError, match="queued"):
        catalog.request_retrieval(session, row.id, SETTINGS, class_name="rod", now=clock.now)
    finish(database, row, clock.forward(1))
    with database.writing() as session:
        wanted = catalog.request_retrieval(session, row.id, SETTINGS, class_name="rod", now=clock.now)
        assert (wanted.job.kind, wanted.result, wanted.sheet_key) == (JobKind.RETRIEVE, None, None)
        catalog.request_retrieval(session, row.id, SETTINGS, mesh_id=meshes[1], now=clock.forward(1))
        catalog.request_retrieval(session, row.id, SETTINGS, model_id=brick().digest, now=clock.forward(1))
    with database.writing() as session:
        catalog.record_retrieval(session, wanted.id, {"items": []}, "sheet.png")
    with database.reading() as session:
        done = catalog.get_retrieval(session, wanted.id)
        assert (done.result, done.sheet_key, done.class_name) == ({"items": []}, "sheet.png", "rod")
        listed = catalog.list_retrievals(session, limit=2)
        assert [one.model_id for one in listed.items] == [brick().digest, None]
        (last,) = catalog.list_retrievals(session, cursor=listed.next_cursor).items
        assert last.id == wanted.id
        (collection,) = catalog.list_collections(session).items
        assert (collection.job.state, collection.seconds) == (JobState.SUCCEEDED, 2.0)


def test_a_request_that_makes_no_sense_leaves_nothing_behind(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
) -> None:
    meshes = add_meshes(database, clock.now, 1)
    add_classifier(database, clock)
    for ids in ([*meshes, NOTHING], ["' OR 1=1"], ["\0"]):
        with database.writing() as session, pytest.raises(NotFoundError, match="no mesh"):
            catalog.request_collection(session, ids, None, now=clock.now)
    with database.writing() as session, pytest.raises(NotFoundError, match="no classifier"):
        catalog.request_collection(session, meshes, "0" * 32, now=clock.now)
    with database.writing() as session, pytest.raises(StoreError, match="at least one"):
        catalog.request_collection(session, [], None, now=clock.now)
    with database.writing() as session:
        row = catalog.request_collection(session, meshes, None, now=clock.now)
    finish(database, row, clock.now)
    queries: list[tuple[dict[str, str], type[StoreError]]] = [
        ({}, StoreError),
        ({"class_name": "rod", "mesh_id": meshes[0]}, StoreError),
        ({"class_name": "teapot\ud800"}, StoreError),
        ({"model_id": NOTHING}, NotFoundError),
        ({"mesh_id": NOTHING}, NotFoundError),
    ]
    for query, error in queries:
        with database.writing() as session, pytest.raises(error):
            catalog.request_retrieval(session, row.id, SETTINGS, **query, now=clock.now)
    with database.writing() as session, pytest.raises(NotFoundError, match="no collection"):
        catalog.request_retrieval(session, "0" * 32, SETTINGS, class_name="rod", now=clock.now)
    with database.reading() as session:
        assert list(catalog.list_retrievals(session).items) == []
        assert len(catalog.list_collections(session).items) == 1


def test_many_meshes_are_found_in_the_order_asked_for(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("models_store.catalog.meshes._IDS_A_QUERY", 2)
    meshes = add_meshes(database, clock.now, 5)[::-1]
    with database.reading() as session:
        assert list(catalog.mesh_names(session, meshes).items()) == [
            (mesh, f"m{4 - place}.off") for place, mesh in enumerate(meshes)
        ]
        with pytest.raises(NotFoundError):
            catalog.mesh_names(session, [*meshes, NOTHING])


def test_the_newest_indexes_of_a_classifier_are_found(database: Database, clock: FakeClock) -> None:  # noqa: F811
    meshes = add_meshes(database, clock.now, 1)
    classifier = add_classifier(database, clock)
    made = []
    for _ in range(4):
        with database.writing() as session:
            made.append(catalog.request_collection(session, meshes, classifier, now=clock.forward(1)))
    for row in made[:3]:  # the newest is not indexed
        finish(database, row, clock.now)
    with database.reading() as session:
        keys = catalog.index_keys(session, classifier, limit=2)
    assert keys == [f"collections/{row.id}.npz" for row in (made[2], made[1])]
