"""Estimations of many meshes in the store: what is asked for, rows that are written once, and pages in any order."""

from datetime import timedelta

import pytest
from store_support import LEASE, FakeClock, clock, database
from worker_support import brick, rod

from models_store import catalog, claims
from models_store.catalog import DoneCounts, RowOrder
from models_store.claims import Claim
from models_store.errors import CursorError, NotFoundError, StaleClaim, StoreError
from models_store.jobs import JobKind, JobState, create_job, request_cancel
from models_store.parts import add_parts, is_in_vain
from models_store.session import Database
from models_store.tables import CollectionEstimationRow, MeshRow

__all__ = ["clock", "database"]

NOTHING = "f" * 64
MEASURES = [{"stem": 3.0, "bowl": 1.0}, {}, {"stem": 1.0, "bowl": 2.0}, {"stem": 1.0, "bowl": 0.0}, {"bowl": 5.0}]
"""Of the meshes in their order; the second could not be estimated."""


def add_meshes(database: Database, clock: FakeClock, count: int) -> list[str]:
    meshes = [
        MeshRow(
            id=f"{number:064x}", file_name=f"m{number}.off", file_type="off", file_size=1, vertex_count=3, face_count=1,
            bounds=[], watertight=False, source_key="s", content_key="c", created_at=clock.now,
        )
        for number in range(count)
    ]  # fmt: skip
    with database.writing() as session:
        session.add_all(meshes)
    return [mesh.id for mesh in meshes]


def request(database: Database, clock: FakeClock, meshes: list[str]) -> CollectionEstimationRow:
    with database.writing() as session:
        model, _ = catalog.add_model(session, brick(), now=clock.now)
        return catalog.request_collection_estimation(
            session, {}, mesh_ids=meshes, model_id=model.id, units="mm", now=clock.now
        )


def take(database: Database, job_id: str, clock: FakeClock) -> Claim:
    with database.writing() as session:
        held = claims.claim(session, job_id, now=clock.now, lease=LEASE)
    assert held is not None
    return held


def record(database: Database, held: Claim, row: CollectionEstimationRow, position: int, clock: FakeClock) -> None:
    measures = MEASURES[position]
    with database.writing() as session:
        catalog.record_estimated_mesh(
            session, held, row.id, position, mesh_id=row.mesh_ids[position], answer={"layer": 3} if measures else None,
            measures=measures, error=None if measures else "dust", seconds=1.0, now=clock.now,
        )  # fmt: skip


@pytest.fixture
def filled(database: Database, clock: FakeClock) -> CollectionEstimationRow:
    row = request(database, clock, add_meshes(database, clock, 5))
    held = take(database, row.job_id, clock)
    for position in range(5):
        record(database, held, row, position, clock)
    return row


def positions(database: Database, row: CollectionEstimationRow, order: RowOrder, limit: int) -> list[int]:
    """All positions, page by page."""
    found: list[int] = []
    cursor: str | None = None
    while True:
        with database.reading() as session:
            page, cursor = catalog.page_of_estimated(session, row.id, order, limit=limit, cursor=cursor)
        assert len(page) <= limit
        found += [one.row.position for one in page]
        if cursor is None:
            return found


@pytest.mark.parametrize(
    ("order", "expected"),
    [
        (RowOrder(), [0, 1, 2, 3, 4]),
        (RowOrder((), descending=True), [4, 3, 2, 1, 0]),
        (RowOrder(("stem",)), [2, 3, 0, 1, 4]),
        (RowOrder(("stem",), descending=True), [0, 2, 3, 1, 4]),
        (RowOrder(("stem", "bowl")), [2, 0, 1, 3, 4]),
        (RowOrder(("bowl.low",)), [0, 1, 2, 3, 4]),
    ],
)
def test_rows_come_page_by_page_in_any_order(
    database: Database,
    filled: CollectionEstimationRow,
    order: RowOrder,
    expected: list[int],
) -> None:
    for limit in (1, 2, 5):
        assert positions(database, filled, order, limit) == expected
    with database.reading() as session:
        everything = [(one.row.position, one.file_name) for one in catalog.all_estimated(session, filled.id, order)]
    assert everything == [(number, f"m{number}.off") for number in expected]


def test_a_cursor_belongs_to_its_order(database: Database, filled: CollectionEstimationRow) -> None:
    with database.reading() as session:
        _, cursor = catalog.page_of_estimated(session, filled.id, RowOrder(("stem",)), limit=1)
        for order, given in ((RowOrder(("bowl",)), cursor), (RowOrder(("stem",)), "bm90IG9uZQ=="), (RowOrder(), "ä")):
            with pytest.raises(CursorError, match="this cursor"):
                catalog.page_of_estimated(session, filled.id, order, cursor=given)
        with pytest.raises(CursorError, match="limit"):
            catalog.page_of_estimated(session, filled.id, RowOrder(), limit=0)


def test_a_row_is_written_once_and_by_the_holder_of_the_claim(database: Database, clock: FakeClock) -> None:
    row = request(database, clock, add_meshes(database, clock, 5))
    lost = take(database, row.job_id, clock)
    record(database, lost, row, 0, clock)
    with database.writing() as session:
        claims.release(session, lost, now=clock.forward(60), delay=timedelta(0))
    held = take(database, row.job_id, clock)
    with pytest.raises(StaleClaim):
        record(database, lost, row, 2, clock)
    record(database, held, row, 0, clock)
    record(database, held, row, 1, clock)
    with database.reading() as session:
        assert catalog.estimated_positions(session, row.id) == {0, 1}
        assert catalog.count_estimated(session, [row.id, "f" * 32]) == {
            row.id: DoneCounts(2, 1),
            "f" * 32: DoneCounts(),
        }


def test_what_makes_no_sense_is_refused(database: Database, clock: FakeClock) -> None:
    meshes = add_meshes(database, clock, 2)
    with database.writing() as session:
        model, _ = catalog.add_model(session, rod(), now=clock.now)
        model_id = model.id
    for given, error, words in (
        ({"model_id": model_id}, StoreError, "either a collection or meshes"),
        ({"mesh_ids": meshes}, StoreError, "either a model or a class"),
        ({"mesh_ids": [], "model_id": model_id}, StoreError, "at least one mesh"),
        ({"mesh_ids": [*meshes, NOTHING], "model_id": model_id}, NotFoundError, "no mesh"),
        ({"mesh_ids": meshes, "class_name": "teapot"}, NotFoundError, "no class"),
        ({"collection_id": "0" * 32, "model_id": model_id}, NotFoundError, "no collection"),
    ):
        with database.writing() as session, pytest.raises(error, match=words):
            catalog.request_collection_estimation(session, {}, **given, now=clock.now)
    with database.reading() as session:
        assert catalog.list_collection_estimations(session).items == []
    with database.writing() as session:
        row = catalog.request_collection_estimation(
            session, {}, mesh_ids=[*meshes, meshes[0]], class_name="rod", now=clock.now
        )
    assert (row.mesh_ids, row.model_ids, row.model_id) == (meshes, [model_id], None)


def test_a_part_is_in_vain_once_its_job_is_to_stop(database: Database, clock: FakeClock) -> None:
    row = request(database, clock, add_meshes(database, clock, 1))
    held = take(database, row.job_id, clock)
    with database.writing() as session:
        (part,) = add_parts(session, held, JobKind.ESTIMATE_MESHES, [{}], now=clock.now)
        alone = create_job(session, JobKind.ESTIMATE, "x", {}, now=clock.now).id
    with database.writing() as session:
        assert not is_in_vain(session, part)
        assert not is_in_vain(session, alone)
        assert request_cancel(session, row.job_id, now=clock.now).state is JobState.RUNNING
        assert is_in_vain(session, part)
        claims.finish_cancelled(session, held, now=clock.now)
    with database.reading() as session:
        assert is_in_vain(session, part)
