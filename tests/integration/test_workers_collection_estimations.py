"""Estimating many meshes as workers do it, in this process: rows that are kept, parts that others take, bad meshes."""

from collections.abc import Iterator
from contextlib import closing
from datetime import timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from worker_support import QUICK, Site, brick, now

from models_store import catalog, claims
from models_store.catalog import RankedMesh, RowOrder
from models_store.jobs import JobKind, JobState, list_jobs, request_cancel
from models_store.parts import add_parts
from models_store.tables import CollectionEstimationRow
from shapewright.errors import Cancelled
from shapewright.modeling import compile_model
from workers import mesh_estimations
from workers.runner import Runner
from workers.settings import WorkerSettings
from workers.stopping import StopNotice
from workers.tasks import estimate_collection

HEIGHTS = (1.8, 0.5, 1.2, 0.9, 1.5)
COARSE = {
    **QUICK,
    "samples": 20,
    "estimator": "reference",
    "alignment": {"translation_step": 0.1, "rotation_step_rad": 0.2, "scale_step": 0.1},
}


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    made = Site(tmp_path)
    yield made
    made.close()


def run(site: Site, job_id: str) -> None:
    settings = WorkerSettings(data_dir=site.settings.data_dir, cancel_check_s=0.05, progress_interval_s=0.05)
    with closing(Runner(settings, StopNotice(), database=site.database, artifacts=site.artifacts)) as runner:
        runner.run(job_id)


def request(site: Site, heights: tuple[float, ...] = HEIGHTS) -> CollectionEstimationRow:
    compiled = compile_model(brick())
    meshes = []
    for number, height in enumerate(heights):
        mesh = compiled.instance(np.array([height]), steps=0)
        row, _ = catalog.store_mesh(
            site.database, site.artifacts, mesh.to_bytes("off"),
            file_name=f"m{number}.off", file_type="off", mesh=mesh, now=now(),
        )  # fmt: skip
        meshes.append(row.id)
    model_id = site.add_model(brick())
    with site.database.writing() as session:
        return catalog.request_collection_estimation(session, COARSE, mesh_ids=meshes, model_id=model_id, now=now())


def rows(site: Site, row: CollectionEstimationRow, *sort: str) -> list[RankedMesh]:
    with site.database.reading() as session:
        return catalog.page_of_estimated(session, row.id, RowOrder(sort))[0]


def parts(site: Site, row: CollectionEstimationRow) -> list[tuple[str, JobState, list[int]]]:
    with site.database.reading() as session:
        found = list_jobs(session, parent_id=row.job_id).items
    return sorted(((part.id, part.state, part.payload["positions"]) for part in found), key=lambda part: part[2])


def test_each_mesh_has_a_row_and_a_broken_one_its_reason(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(estimate_collection, "MESHES_A_PART", 2)
    row = request(site)
    site.artifacts.put(f"meshes/{row.mesh_ids[1]}/source.off", b"OFF\n3 1 0\n0 0 0\n")
    site.artifacts.delete(f"meshes/{row.mesh_ids[2]}/source.off")
    run(site, row.job_id)
    job = site.job(row.job_id)
    assert job.state is JobState.SUCCEEDED, job.error_detail
    found = rows(site, row)
    assert [one.row.position for one in found] == list(range(5))
    assert "truncated" in found[1].row.error
    assert "no artefact" in found[2].row.error
    assert [one.row.answer["model"]["name"] for one in found if one.row.answer] == ["brick"] * 3
    assert [one.file_name for one in rows(site, row, "height")] == ["m3.off", "m4.off", "m0.off", "m1.off", "m2.off"]
    assert parts(site, row) == []


def test_what_breaks_unexpectedly_is_a_row_too(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any, **__: Any) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("shapewright.estimation.estimate", broken)
    row = request(site, (1.2,))
    run(site, row.job_id)
    assert site.job(row.job_id).state is JobState.SUCCEEDED
    assert [one.row.error for one in rows(site, row)] == [mesh_estimations.UNEXPECTED]


def test_another_worker_takes_parts_and_a_later_attempt_goes_on(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first attempt is lost after a part of it was done elsewhere."""
    monkeypatch.setattr(estimate_collection, "MESHES_A_PART", 2)
    monkeypatch.setattr(claims, "QUIET", timedelta(0))
    row = request(site)
    with site.database.writing() as session:
        lost = claims.claim(session, row.job_id, now=now(), lease=timedelta(minutes=5))
        assert lost is not None
        payload = {"collection_estimation_id": row.id, "positions": [3, 1]}
        (part,) = add_parts(session, lost, JobKind.ESTIMATE_MESHES, [payload], now=now())
    run(site, part)
    assert site.job(part).state is JobState.SUCCEEDED, site.job(part).error_detail
    first = {one.row.position: one.row.created_at for one in rows(site, row)}
    assert set(first) == {1, 3}
    with site.database.writing() as session:
        claims.release(session, lost, now=now())
    run(site, row.job_id)
    assert site.job(row.job_id).state is JobState.SUCCEEDED
    found = {one.row.position: one.row.created_at for one in rows(site, row)}
    assert set(found) == set(range(5))
    assert {position: found[position] for position in first} == first


def test_a_cancelled_job_keeps_its_rows(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    row = request(site)
    write = mesh_estimations.MeshEstimations._write

    def write_and_cancel(self: Any, position: int, *given: Any) -> None:
        write(self, position, *given)
        if position == 1:
            with site.database.writing() as session:
                request_cancel(session, row.job_id, now=now())
            site.wait(row.job_id, lambda job: job.cancel_requested)

    monkeypatch.setattr(mesh_estimations.MeshEstimations, "_write", write_and_cancel)
    monkeypatch.setattr("workers.context.WorkerProgress.report", _looking)
    run(site, row.job_id)
    assert site.job(row.job_id).state is JobState.CANCELLED
    assert [one.row.position for one in rows(site, row)] == [0, 1]


def _looking(self: Any, fraction: float, message: str) -> None:
    """Look for the request at once, as the heartbeat does a moment later."""
    with self._database.reading() as session:
        if claims.look(session, self._claim):
            raise Cancelled


def test_a_part_in_vain_stops(site: Site) -> None:
    row = request(site)
    with site.database.writing() as session:
        held = claims.claim(session, row.job_id, now=now(), lease=timedelta(minutes=5))
        assert held is not None
        payload = {"collection_estimation_id": row.id, "positions": list(range(5))}
        (part,) = add_parts(session, held, JobKind.ESTIMATE_MESHES, [payload], now=now())
        request_cancel(session, row.job_id, now=now())
    run(site, part)
    assert site.job(part).state is JobState.CANCELLED
    assert rows(site, row) == []
