"""The tasks themselves, run in this process: what they keep, what they reuse, what they say when it fails."""

import itertools
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image
from waiting import wait_until
from worker_support import QUICK, Site, brick, now, rod

from models_store import catalog
from models_store.artifacts import ArtifactStore
from models_store.claims import IDLE_WORKERS_TAKE_IT, QUIET
from models_store.errors import ArtifactError
from models_store.jobs import JobState, request_cancel
from models_store.parts import part_states
from models_store.tables import ClassifierRow
from shapewright.classification.exemplars import Exemplars
from shapewright.estimation import EstimationSettings, PanoramaBank, estimate
from shapewright.mesh.file import parse_mesh
from shapewright.modeling import ProceduralModel, Recorder, compile_model
from shapewright.training import TrainedClassifier, TrainingSettings
from shapewright.training.broken.breaking import is_broken
from workers import learning_plans
from workers.context import JobContext, WorkerProgress
from workers.runner import Runner
from workers.settings import WorkerSettings
from workers.stopping import StopNotice
from workers.stored.arrays import ArtifactArrays


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    made = Site(tmp_path)
    yield made
    made.close()


def run(site: Site, job_id: str, artifacts: ArtifactStore | None = None) -> None:
    settings = WorkerSettings(data_dir=site.settings.data_dir, cancel_check_s=0.1, progress_interval_s=0.1)
    with closing(
        Runner(settings, StopNotice(), database=site.database, artifacts=artifacts or site.artifacts)
    ) as runner:
        runner.run(job_id)


TRAINING = {"variations": 8, "images_per_variation": 4, "image_size": 64, "negatives": 4, "subdivision_steps": 1}
"""Settings of a training that takes seconds."""


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
    expected = estimate(query, compile_model(brick()), settings).to_dict()
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
    query = compile_model(rods).instance(np.array([1.7])).to_bytes("off")
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
    assert [one["model"]["name"] for one in done.result["tried"]] == ["rod", "brick"]
    assert done.result["parameters"][0]["name"] == "length"
    for model in models:
        (path,) = (Path(site.settings.data_dir) / "artifacts" / "banks" / model).iterdir()
        assert len(PanoramaBank.load(path)) == 30


def test_the_fast_estimator_needs_no_bank_and_its_residuals_are_kept(site: Site) -> None:
    row = site.queue_estimation(20, send=False, changes={"estimator": "fast"})
    run(site, row.job_id)
    assert site.job(row.job_id).state is JobState.SUCCEEDED, site.job(row.job_id).error_detail
    done = site.estimation(row.id)
    assert done.result["estimator"] == "fast"
    assert 0 < done.result["verdict"]["residuals"]["followed_share"] <= 1
    assert not (Path(site.settings.data_dir) / "artifacts" / "banks").exists()
    colored = site.artifacts.get(done.residuals_key)
    scene = trimesh.load(BytesIO(colored), file_type="glb")
    assert set(scene.geometry) == {"fit", "query"}
    query = parse_mesh(site.artifacts.get(f"meshes/{row.mesh_id}/source.off"), "off")
    assert np.allclose(scene.geometry["query"].bounds, query.bounds, atol=1e-6)
    assert b"COLOR_0" in colored


def test_when_the_time_is_over_the_best_until_then_is_the_answer(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    ticks = itertools.count()
    monkeypatch.setattr(JobContext, "seconds", property(lambda context: float(next(ticks))))
    row = site.queue_estimation(2000, send=False, time_limit_s=8.0)
    run(site, row.job_id)
    job, done = site.job(row.job_id), site.estimation(row.id)
    assert (job.state, job.error_detail) == (JobState.SUCCEEDED, None)
    assert not done.result["complete"]
    assert done.mesh_key is not None


def test_an_estimation_with_no_time_at_all_says_so(site: Site) -> None:
    row = site.queue_estimation(20, send=False, time_limit_s=1e-9)
    run(site, row.job_id)
    job = site.job(row.job_id)
    assert (job.state, job.error_where) == (JobState.FAILED, "time_limit_s")
    assert "time was over" in job.error_detail


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
    models, other = [site.add_model(brick()), site.add_model(rod())], site.add_model(slab())
    with site.database.writing() as session:
        classifier = catalog.request_classifier(session, models, TRAINING, negative_model_ids=[other], now=now())
    run(site, classifier.job_id)
    assert site.job(classifier.job_id).state is JobState.SUCCEEDED, site.job(classifier.job_id).error_detail
    for model in (brick(), rod()):
        mesh = compile_model(model).instance(np.array([0.8]))
        data = mesh.to_bytes("ply")
        stored, _ = catalog.store_mesh(
            site.database, site.artifacts, data, file_name="q.ply", file_type="ply", mesh=mesh, now=now()
        )
        with site.database.writing() as session:
            row = catalog.request_classification(session, stored.id, None, {"views": 4, "fit": True}, now=now())
        run(site, row.job_id)
        with site.database.reading() as session:
            row = catalog.get_classification(session, row.id)
        assert row.job.state is JobState.SUCCEEDED, row.job.error_detail
        assert row.result["class_name"] == model.class_name
        for name in ("probabilities", "picture_probabilities"):
            ranked = [entry["probability"] for entry in row.result[name]]
            assert ranked == sorted(ranked, reverse=True)
            assert sum(ranked) == pytest.approx(1, abs=1e-4)
        assert 0 < row.result["known"] < 1
        assert row.result["answer"] == (model.class_name if row.result["known"] >= 0.5 else "unknown")
        nearest, farther = row.result["distances"]
        assert nearest["class_name"] == model.class_name
        assert nearest["distance"] < farther["distance"]
        neighbor = row.result["neighbor"]
        assert (neighbor["class_name"], neighbor["model_id"]) == (model.class_name, model.digest)
        with site.database.reading() as session:
            exemplars = exemplars_of(site, catalog.get_classifier(session, classifier.id))
        rows = np.flatnonzero(exemplars.classes == exemplars.class_names.index(model.class_name))
        assert neighbor["values"] in [exemplars.values(int(row), compile_model(model)).tolist() for row in rows]
        best = {fit["class_name"]: fit for fit in row.result["fits"]}[model.class_name]
        assert best["model_id"] == model.digest
        assert best["values"] == [pytest.approx(0.8, abs=0.2)]
        assert best["distance"] == nearest["distance"] <= best["exemplar_distance"]
        with Image.open(BytesIO(site.artifacts.get(row.pictures_key))) as picture:
            assert (picture.format, picture.size) == ("PNG", (4 * 64, 64))
        assert np.asarray(row.result["per_view"]).shape == (4, 2)
    with site.database.reading() as session:
        trained = catalog.get_classifier(session, classifier.id)
    assert trained.class_names == ["brick", "rod"]
    assert trained.metrics
    assert len(site.artifacts.get(trained.onnx_key)) > 1_000_000
    whole = [number for number in range(TRAINING["variations"]) if not is_broken(number, TrainingSettings().broken)]
    assert (exemplars.class_names, exemplars.numbers.tolist()) == (("brick", "rod"), 2 * whole)
    assert keys_of(site, "features", slab())


def test_a_classifier_without_exemplars_looks_at_pictures_alone(site: Site) -> None:
    classifier = queue_training(site, [brick(), rod()], exemplars=False, negatives=0)
    succeed(site, classifier.job_id, site.artifacts)
    query = compile_model(rod()).instance(np.array([0.8]))
    stored, _ = catalog.store_mesh(
        site.database, site.artifacts, query.to_bytes("ply"), file_name="q.ply", file_type="ply", mesh=query, now=now()
    )
    with site.database.writing() as session:
        row = catalog.request_classification(session, stored.id, None, {"views": 7}, now=now())
    succeed(site, row.job_id, Full(site.artifacts, "classifications/"))  # the pictures find no room
    with site.database.reading() as session:
        assert catalog.get_classifier(session, classifier.id).exemplars_key is None
        row = catalog.get_classification(session, row.id)
    assert (row.result["known"], row.result["distances"], row.pictures_key) == (None, None, None)
    assert row.result["answer"] == row.result["class_name"]


def keys_of(site: Site, kind: str, model: ProceduralModel) -> set[str]:
    folder = Path(site.settings.data_dir) / "artifacts"
    found = (path for path in (folder / kind).rglob("*.npy") if path.parent.name == model.digest[:32])
    return {path.relative_to(folder).as_posix() for path in found}


def slab() -> ProceduralModel:
    """A flat box of a class of its own."""
    recorder = Recorder("slab", "slab")
    box = recorder.box(1.5, 1.5, 0.1)
    recorder.extrude(box.top, 0.1, length="thickness")
    recorder.parameter("thickness", "thickness", 0.5, 2.0)
    return recorder.build()


class Watched(ArtifactStore):
    """A store that notes what is put, and does something after each array."""

    def __init__(self, real: ArtifactStore, after: Callable[[str], None] = lambda key: None) -> None:
        super().__init__(real._store, real._folder)
        self.arrays: list[str] = []
        self._after = after

    def put(self, key: str, data: bytes) -> None:
        super().put(key, data)
        if key.endswith(".npy"):
            self.arrays.append(key)
            self._after(key)

    def models(self, kind: str) -> set[str]:
        """The digests, as keys have them, whose arrays of a kind were put."""
        return {key.split("/")[-2] for key in self.arrays if key.startswith(f"{kind}/")}


class Interrupting(ArtifactStore):
    """A store that does something when an array is looked for."""

    def __init__(self, real: ArtifactStore, before: Callable[[], object]) -> None:
        super().__init__(real._store, real._folder)
        self._before = before

    def local_copy(self, key: str, cache: Path) -> Path:
        self._before()
        return super().local_copy(key, cache)


def queue_training(site: Site, models: list[ProceduralModel], **settings: Any) -> ClassifierRow:
    identifiers = [site.add_model(model) for model in models]
    with site.database.writing() as session:
        return catalog.request_classifier(session, identifiers, TRAINING | settings, now=now())


def succeed(site: Site, job_id: str, artifacts: ArtifactStore) -> None:
    run(site, job_id, artifacts)
    assert site.job(job_id).state is JobState.SUCCEEDED, site.job(job_id).error_detail


def test_a_training_with_one_class_more_computes_that_class_alone(site: Site) -> None:
    first, same, more, other, whole = (Watched(site.artifacts) for _ in range(5))
    succeed(site, queue_training(site, [brick(), rod()], negatives=0).job_id, first)
    known = {model.digest[:32] for model in (brick(), rod())}
    assert first.models("features") == first.models("panoramas") == known
    succeed(site, queue_training(site, [rod(), brick()], negatives=0, epochs=3).job_id, same)
    assert same.arrays == []
    succeed(site, queue_training(site, [brick(), slab(), rod()], negatives=0).job_id, more)
    assert more.models("features") == more.models("panoramas") == {slab().digest[:32]}
    succeed(site, queue_training(site, [brick(), rod()], negatives=0, image_size=96).job_id, other)
    assert (other.models("features"), other.models("panoramas")) == (known, set())
    succeed(site, queue_training(site, [brick(), rod()], negatives=0, broken=0.0).job_id, whole)
    assert whole.models("features") == whole.models("panoramas") == known, "other objects, other geometry"


def test_a_cancelled_training_goes_on_where_it_was(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    first = queue_training(site, [brick(), rod()])
    begun: list[WorkerProgress] = []
    enter = WorkerProgress.__enter__
    monkeypatch.setattr(WorkerProgress, "__enter__", lambda self: begun.append(self) or enter(self))

    def cancel(key: str) -> None:
        if key.startswith("features/"):
            with site.database.writing() as session:
                request_cancel(session, first.job_id, now=now())
            wait_until(lambda: begun[-1]._cancelled)  # the heartbeat has heard of it

    stopped, rest = Watched(site.artifacts, cancel), Watched(site.artifacts)
    run(site, first.job_id, stopped)
    assert site.job(first.job_id).state is JobState.CANCELLED
    assert stopped.models("features") == {brick().digest[:32]}
    succeed(site, queue_training(site, [brick(), rod()]).job_id, rest)
    assert stopped.arrays
    assert not set(stopped.arrays) & set(rest.arrays)
    assert rod().digest[:32] in rest.models("features")


def test_a_classifier_is_extended_with_what_the_catalog_has(site: Site) -> None:
    base = queue_training(site, [brick(), rod()])
    succeed(site, base.job_id, site.artifacts)
    extending = {"variations": 8, "images_per_variation": 4, "rehearsed": 4, "negatives": 4}
    added = site.add_model(slab())
    with site.database.writing() as session:
        row = catalog.request_classifier(session, [added], extending, base_classifier_id=base.id, now=now())
    succeed(site, row.job_id, site.artifacts)
    with site.database.reading() as session:
        before, after = (catalog.get_classifier(session, one.id) for one in (base, row))
    assert after.class_names == [*before.class_names, slab().class_name]
    assert {"new_accuracy", "known_accuracy", "known_accuracy_before"} <= after.metrics.keys()
    trained = TrainedClassifier.read(site.artifacts.get(after.onnx_key), exemplars_of(site, after))
    assert trained.class_names == tuple(after.class_names)
    assert trained.exemplars.digests == (brick().digest, rod().digest, slab().digest)

    with site.database.writing() as session:
        late = catalog.request_classifier(session, [added], extending, base_classifier_id=base.id, now=now())
    with site.database.writing() as session:
        session.delete(catalog.get_model(session, rod().digest))
    learning_plans._compiled.clear()  # as in a worker that has just started
    run(site, late.job_id)
    job = site.job(late.job_id)
    assert job.state is JobState.FAILED
    assert "there is no model" in job.error_detail


def exemplars_of(site: Site, row: ClassifierRow) -> Exemplars:
    return Exemplars.load(site.artifacts.local_copy(row.exemplars_key, Path(site.settings.data_dir)))


def parts_of(site: Site, job_id: str) -> dict[str, JobState]:
    with site.database.reading() as session:
        return part_states(session, job_id)


def test_parts_of_a_training_are_done_by_other_workers(site: Site) -> None:
    """What the training's worker finds done it does not do again, and the classifier is the same."""
    alone = queue_training(site, [brick(), rod()])
    succeed(site, alone.job_id, site.artifacts)
    shutil.rmtree(Path(site.settings.data_dir) / "artifacts" / "features")
    shared = queue_training(site, [brick(), rod()])
    elsewhere = Watched(site.artifacts)

    def help_once(key: str) -> None:
        parts = parts_of(site, shared.job_id)
        if JobState.SUCCEEDED not in parts.values():
            run(site, next(part for part, state in parts.items() if state is JobState.QUEUED), elsewhere)

    time.sleep(QUIET.total_seconds())  # the first training has just ended
    own = Watched(site.artifacts, help_once)
    succeed(site, shared.job_id, own)
    assert list(parts_of(site, shared.job_id).values()) == [JobState.SUCCEEDED]
    assert len(elsewhere.arrays) == 1
    assert not set(elsewhere.arrays) & set(own.arrays)
    with site.database.reading() as session:
        first, second = (catalog.get_classifier(session, row.id) for row in (alone, shared))
    assert first.metrics == second.metrics


def test_a_part_gives_way_and_one_that_fails_is_done_by_the_training(site: Site) -> None:
    training = queue_training(site, [brick(), rod()])
    tried: list[str] = []

    def want_something() -> None:
        site.queue_thumbnail(site.add_model(slab()))
        time.sleep(IDLE_WORKERS_TAKE_IT.total_seconds() + 0.1)  # there is none

    def help_badly(key: str) -> None:
        parts = parts_of(site, training.job_id)
        if tried:
            return
        first, second = [part for part, state in parts.items() if state is JobState.QUEUED][:2]
        run(site, first, Full(site.artifacts, "features/"))
        tried.append(first)

        run(site, second, Interrupting(site.artifacts, want_something))
        assert parts_of(site, training.job_id)[second] is JobState.QUEUED

    succeed(site, training.job_id, Watched(site.artifacts, help_badly))
    assert parts_of(site, training.job_id) == {tried[0]: JobState.FAILED}
    assert "could not be stored" in site.job(tried[0]).error_detail


def test_a_damaged_array_is_computed_anew(site: Site) -> None:
    first, second = Watched(site.artifacts), Watched(site.artifacts)
    succeed(site, queue_training(site, [brick(), rod()]).job_id, first)
    site.artifacts.put(first.arrays[0], b"damaged")
    succeed(site, queue_training(site, [brick(), rod()]).job_id, second)
    assert second.arrays == [first.arrays[0]]


def test_no_room_for_the_arrays_does_not_harm_the_training(site: Site) -> None:
    for prefix in ("features/", "panoramas/"):
        succeed(site, queue_training(site, [brick(), rod()]).job_id, Full(site.artifacts, prefix))


def test_arrays_of_a_remote_store_are_copied_once(tmp_path: Path) -> None:
    remote = ArtifactStore.open("memory://")
    arrays = ArtifactArrays(remote, tmp_path)
    key = "features/some-backbone/0f/abc/0-0-2.npy"
    assert arrays.get(key) is None
    arrays.put(key, np.arange(6).reshape(2, 3))
    kept = arrays.get(key)
    assert isinstance(kept, np.memmap)
    np.testing.assert_array_equal(kept, np.arange(6).reshape(2, 3))

    (tmp_path / key).write_bytes(b"damaged")
    assert arrays.get(key) is None
    arrays.put(key, np.zeros(2))
    np.testing.assert_array_equal(arrays.get(key), np.zeros(2))

    blocked = tmp_path / "file"
    blocked.write_bytes(b"")
    np.testing.assert_array_equal(ArtifactArrays(remote, blocked).get(key), np.zeros(2))
