"""The tasks themselves, run in this process: what they keep, what they reuse, what they say when it fails."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from worker_support import QUICK, Site, brick, now, rod

from models_store import catalog
from models_store.artifacts import ArtifactStore
from models_store.errors import ArtifactError
from models_store.jobs import JobState
from shapewright.estimation import EstimationSettings, PanoramaBank, estimate
from shapewright.mesh_file import parse_mesh
from workers.runner import Runner
from workers.settings import WorkerSettings
from workers.stopping import StopNotice


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    made = Site(tmp_path)
    yield made
    made.close()


def run(site: Site, job_id: str, artifacts: ArtifactStore | None = None) -> None:
    settings = WorkerSettings(data_dir=site.settings.data_dir)
    Runner(settings, StopNotice(), database=site.database, artifacts=artifacts or site.artifacts).run(job_id)


def bank_file(site: Site) -> Path:
    folder = Path(site.settings.data_dir) / "artifacts" / "banks" / brick().digest
    (path,) = folder.iterdir()
    return path


def test_an_estimation_is_what_the_library_says_and_keeps_the_bank(site: Site) -> None:
    first = site.queue_estimation(100, send=False)
    run(site, first.job_id)
    result = site.estimation(first.id).result
    query = parse_mesh(site.artifacts.get(f"meshes/{first.mesh_id}/source.off"), "off")
    settings = EstimationSettings.from_dict({**QUICK, "samples": 100})
    expected = estimate(query, brick().compile(), settings).to_dict()
    assert {name: value for name, value in result.items() if name != "seconds"} == expected

    assert len(PanoramaBank.load(bank_file(site))) == 100
    written_at = bank_file(site).stat().st_mtime_ns
    second = site.queue_estimation(100, send=False)
    run(site, second.job_id)
    assert bank_file(site).stat().st_mtime_ns == written_at
    again = site.estimation(second.id).result
    assert {name: value for name, value in again.items() if name != "seconds"} == expected


def test_an_estimation_for_a_class_finds_the_model_and_keeps_every_bank(site: Site) -> None:
    bricks, rods = brick(), replace(rod(), class_name="brick")
    models = [site.add_model(bricks), site.add_model(rods)]
    query = rods.compile().instance(np.array([1.7])).to_bytes("off")
    stored, _ = catalog.store_mesh(
        site.database, site.artifacts, query, file_name="q.off", file_type="off",
        mesh=parse_mesh(query, "off"), now=now(),
    )  # fmt: skip
    with site.database.writing() as session:
        row = catalog.request_estimation(
            session, stored.id, None, {**QUICK, "samples": 30}, class_name="brick", now=now()
        )
    assert (row.model_id, row.model_ids) == (None, models)
    run(site, row.job_id)
    assert site.job(row.job_id).state is JobState.SUCCEEDED, site.job(row.job_id).error_detail
    done = site.estimation(row.id)
    assert done.model_id == rods.digest
    assert [one["model_name"] for one in done.result["models_tried"]] == ["rod", "brick"]
    assert done.result["parameters"][0]["name"] == "length"
    for model in models:
        (path,) = (Path(site.settings.data_dir) / "artifacts" / "banks" / model).iterdir()
        assert len(PanoramaBank.load(path)) == 30


def test_a_damaged_bank_is_built_anew(site: Site) -> None:
    first = site.queue_estimation(20, send=False)
    run(site, first.job_id)
    bank_file(site).write_bytes(b"damaged")
    second = site.queue_estimation(20, send=False)
    run(site, second.job_id)
    assert site.job(second.job_id).state is JobState.SUCCEEDED
    assert len(PanoramaBank.load(bank_file(site))) == 20


class Full(ArtifactStore):
    """A store that has no room for keys that begin in a certain way."""

    def __init__(self, real: ArtifactStore, prefix: str) -> None:
        super().__init__(real._store, real._folder)
        self._prefix = prefix

    def put(self, key: str, data: bytes) -> None:
        if key.startswith(self._prefix):
            raise ArtifactError("there is no space left to store this (the disk is full)")
        super().put(key, data)


def test_no_room_for_the_bank_does_not_harm_the_estimation(site: Site) -> None:
    row = site.queue_estimation(20, send=False)
    run(site, row.job_id, Full(site.artifacts, "banks/"))
    assert site.job(row.job_id).state is JobState.SUCCEEDED


def test_no_room_for_the_result_is_said_and_leaves_no_result(site: Site) -> None:
    row = site.queue_estimation(20, send=False)
    run(site, row.job_id, Full(site.artifacts, "estimations/"))
    job = site.job(row.job_id)
    assert (job.state, job.error_title) == (JobState.FAILED, "Artifact error")
    assert "disk is full" in job.error_detail
    assert site.estimation(row.id).result is None


def test_a_classifier_is_trained_and_tells_a_brick_from_a_rod(site: Site) -> None:
    models = [site.add_model(brick()), site.add_model(rod())]
    settings = {"variations": 8, "images_per_variation": 4, "scale_range": [0.9, 1.4], "subdivision_steps": 1}
    with site.database.writing() as session:
        classifier = catalog.request_classifier(session, models, settings, now=now())
    run(site, classifier.job_id)
    assert site.job(classifier.job_id).state is JobState.SUCCEEDED, site.job(classifier.job_id).error_detail
    for model in (brick(), rod()):
        mesh = model.compile().instance(np.array([0.8]))
        data = mesh.to_bytes("ply")
        stored, _ = catalog.store_mesh(
            site.database, site.artifacts, data, file_name="q.ply", file_type="ply", mesh=mesh, now=now()
        )
        with site.database.writing() as session:
            row = catalog.request_classification(session, stored.id, None, {"views": 4}, now=now())
        run(site, row.job_id)
        with site.database.reading() as session:
            row = catalog.get_classification(session, row.id)
        assert row.job.state is JobState.SUCCEEDED, row.job.error_detail
        assert row.result["class_name"] == model.class_name
        ranked = [entry["probability"] for entry in row.result["probabilities"]]
        assert ranked == sorted(ranked, reverse=True)
        assert sum(ranked) == pytest.approx(1, abs=1e-4)
        assert np.asarray(row.result["per_view"]).shape == (4, 2)
    with site.database.reading() as session:
        trained = catalog.get_classifier(session, classifier.id)
    assert trained.class_names == ["brick", "rod"]
    assert trained.metrics
    assert len(site.artifacts.get(trained.onnx_key)) > 1_000_000
