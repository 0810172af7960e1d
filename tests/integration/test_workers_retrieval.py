"""Indexing and retrieving as workers do it, in this process: what is kept, used again, and said when it fails."""

import io
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fake_classifier import ExtentClassifier
from PIL import Image
from simple_shapes import box
from small_dataset import rod, slab
from store_support import LEASE
from worker_support import Site, now

from models_store import catalog, claims
from models_store.jobs import JobState
from models_store.tables import CollectionRow, RetrievalRow
from shapewright.distances.surface import uniform_points
from shapewright.errors import Cancelled, MeshError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.file import MeshReader
from shapewright.retrieval import CollectionIndex
from workers.context import JobContext, WorkerProgress
from workers.runner import Runner
from workers.settings import WorkerSettings
from workers.stopping import StopNotice, WorkerStopping

SHAPES = {
    "long.off": (0.2, 0.2, 3.0),
    "flat.off": (2.0, 2.0, 0.2),
    "longer.off": (0.2, 0.2, 5.0),
    "wide.off": (3.0, 2.5, 0.2),
}


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    made = Site(tmp_path)
    yield made
    made.close()


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> ExtentClassifier:
    """What stands for every classifier's file."""
    made = ExtentClassifier()
    monkeypatch.setattr("shapewright.classification.Classifier", lambda content, exemplars: made)
    monkeypatch.setattr("workers.stored.classifiers._kept", {})
    return made


def run(site: Site, job_id: str) -> None:
    settings = WorkerSettings(data_dir=site.settings.data_dir)
    with closing(Runner(settings, StopNotice(), database=site.database, artifacts=site.artifacts)) as runner:
        runner.run(job_id)


def upload(site: Site, name: str, mesh: TriangleMesh) -> str:
    row, _ = catalog.store_mesh(
        site.database, site.artifacts, mesh.to_bytes("off"), file_name=name, file_type="off", mesh=mesh, now=now()
    )
    return row.id


def upload_all(site: Site) -> list[str]:
    return [upload(site, name, box(size)) for name, size in SHAPES.items()]


def add_classifier(site: Site) -> str:
    models = [site.add_model(model) for model in (rod(), slab())]
    with site.database.writing() as session:
        row = catalog.request_classifier(session, models, {}, now=now())
        held = claims.claim(session, row.job_id, now=now(), lease=LEASE)
        claims.finish(session, held, now=now())
        site.artifacts.put(f"classifiers/{row.id}.onnx", row.id.encode())
        key = f"classifiers/{row.id}.onnx"
        catalog.record_classifier(session, row.id, onnx_key=key, class_names=["rod", "slab"], metrics={}, seconds=1.0)
    return row.id


def ask(site: Site, meshes: Sequence[str]) -> CollectionRow:
    with site.database.writing() as session:
        return catalog.request_collection(session, meshes, None, now=now())


def collection(site: Site, identifier: str) -> CollectionRow:
    with site.database.reading() as session:
        return catalog.get_collection(session, identifier)


def index_of(site: Site, identifier: str) -> CollectionIndex:
    key = str(collection(site, identifier).index_key)
    return CollectionIndex.load(site.artifacts.local_copy(key, site.settings.data_dir / "cache"))


def retrieve(site: Site, collection_id: str, **query: Any) -> RetrievalRow:
    settings = {"evidence": "combined", "limit": 10, "instances": 10, "seed": 0}
    settings |= {name: query.pop(name) for name in list(query) if name in settings}
    with site.database.writing() as session:
        row = catalog.request_retrieval(session, collection_id, settings, **query, now=now())
    run(site, row.job_id)
    with site.database.reading() as session:
        return catalog.get_retrieval(session, row.id)


def names(row: RetrievalRow) -> list[str]:
    assert row.job.state is JobState.SUCCEEDED, row.job.error_detail
    return [item["file_name"] for item in row.result["items"]]


def unreadable(site: Site) -> str:
    """A mesh that was uploaded, and cannot be read any more: files may be lost."""
    lost = upload(site, "lost.off", box((9.0, 1.0, 1.0)))
    site.artifacts.put(f"meshes/{lost}/source.off", b"OFF\n3 1 0\n0 0 0\n")
    return lost


def test_meshes_are_indexed_and_what_cannot_be_is_listed(site: Site, network: ExtentClassifier) -> None:
    add_classifier(site)
    meshes = [*upload_all(site), unreadable(site)]
    row = ask(site, meshes)
    run(site, row.job_id)
    done = collection(site, row.id)
    assert done.job.state is JobState.SUCCEEDED, done.job.error_detail
    assert [skipped["mesh_id"] for skipped in done.skipped] == [meshes[-1]]
    assert done.skipped[0]["reason"]
    assert done.seconds > 0
    index = index_of(site, row.id)
    assert index.names == tuple(meshes[:-1])
    assert index.class_names == ("rod", "slab")
    folder = Path(site.settings.data_dir) / "artifacts" / "collections"
    assert [path.name for path in folder.iterdir()] == [Path(str(done.index_key)).name]


def test_what_the_same_classifier_has_looked_at_is_not_looked_at_again(site: Site, network: ExtentClassifier) -> None:
    add_classifier(site)
    meshes = upload_all(site)
    first = ask(site, meshes[:3])
    run(site, first.job_id)
    assert network.asked == 3
    second = ask(site, meshes[::-1])
    run(site, second.job_id)
    assert network.asked == 4
    before, after = index_of(site, first.id), index_of(site, second.id)
    assert set(after.names) == set(meshes)
    for name, row in after.rows_of(before.names).items():
        np.testing.assert_array_equal(after.descriptors[row], before.descriptors[before.names.index(name)])
    site.artifacts.put(str(collection(site, first.id).index_key), b"damaged")
    site.artifacts.put(str(collection(site, second.id).index_key), b"damaged")
    third = ask(site, meshes)
    run(site, third.job_id)
    assert collection(site, third.id).job.state is JobState.SUCCEEDED
    assert network.asked == 8
    add_classifier(site)
    fourth = ask(site, meshes)
    run(site, fourth.job_id)
    assert network.asked == 12  # of another classifier


def test_a_collection_without_a_usable_mesh_fails_and_says_why(site: Site, network: ExtentClassifier) -> None:
    add_classifier(site)
    row = ask(site, [unreadable(site)])
    run(site, row.job_id)
    job = site.job(row.job_id)
    assert (job.state, job.error_title, job.error_where) == (JobState.FAILED, "Mesh error", "mesh_ids")
    assert "no mesh of the collection can be used" in str(job.error_detail)


@pytest.mark.parametrize("reason", [WorkerStopping, Cancelled])
def test_half_an_index_is_kept_for_the_next_attempt_unless_it_was_cancelled(
    site: Site, network: ExtentClassifier, monkeypatch: pytest.MonkeyPatch, reason: type[BaseException]
) -> None:
    monkeypatch.setattr("shapewright.retrieval.indexing.CHUNK", 1)
    add_classifier(site)
    row = ask(site, upload_all(site))
    report = WorkerProgress.report

    def stopping(self: WorkerProgress, fraction: float, message: str) -> None:
        if network.asked == 3:
            raise reason
        report(self, fraction, message)

    monkeypatch.setattr(WorkerProgress, "report", stopping)
    run(site, row.job_id)
    part = f"collections/{row.id}-part.npz"
    assert site.artifacts.exists(part) == (reason is WorkerStopping)
    if reason is Cancelled:
        assert site.job(row.job_id).state is JobState.CANCELLED
        return
    monkeypatch.setattr(WorkerProgress, "report", report)
    run(site, row.job_id)
    assert site.job(row.job_id).state is JobState.SUCCEEDED, site.job(row.job_id).error_detail
    assert network.asked == 4
    assert len(index_of(site, row.id)) == 4
    assert not site.artifacts.exists(part)


def test_meshes_are_found_by_class_model_and_mesh(site: Site, network: ExtentClassifier) -> None:
    add_classifier(site)
    meshes = upload_all(site)
    row = ask(site, meshes)
    run(site, row.job_id)
    flat = {"flat.off", "wide.off"}
    by_class = retrieve(site, row.id, class_name="slab", limit=3)
    assert set(names(by_class)[:2]) == flat
    assert (by_class.result["mesh_count"], len(by_class.result["items"])) == (4, 3)
    scores = [item["score"] for item in by_class.result["items"]]
    assert scores == sorted(scores, reverse=True)
    assert {item["mesh_id"] for item in by_class.result["items"][:2]} == {meshes[1], meshes[3]}
    for item in by_class.result["items"]:
        assert 0 <= item["probability"] <= 1
        assert 0 <= item["distance"] <= 2
    quick = retrieve(site, row.id, class_name="slab", evidence="probabilities")
    assert set(names(quick)[:2]) == flat
    assert {item["distance"] for item in quick.result["items"]} == {None}
    by_model = retrieve(site, row.id, model_id=slab().digest, evidence="panorama", instances=0)
    assert set(names(by_model)[:2]) == flat
    assert {item["probability"] for item in by_model.result["items"]} == {None}
    inside = retrieve(site, row.id, mesh_id=meshes[1])
    assert names(inside)[0] == "flat.off"
    asked = network.asked
    outside = retrieve(site, row.id, mesh_id=upload(site, "query.off", box((0.2, 0.3, 4.0))))
    assert set(names(outside)[:2]) == {"long.off", "longer.off"}
    assert network.asked == asked + 1
    for done, rows in ((by_class, 1), (outside, 2)):
        with Image.open(io.BytesIO(site.artifacts.get(str(done.sheet_key)))) as sheet:
            assert sheet.format == "PNG"
            assert sheet.height > rows * 200


def upload_scan(site: Site, name: str, sides: tuple[float, float, float]) -> str:
    points = uniform_points(box(sides), 300, rng=np.random.default_rng(0))
    data = b"".join(b"%r %r %r\n" % tuple(row) for row in points.tolist())
    row, _ = catalog.store_mesh(
        site.database, site.artifacts, data,
        file_name=name, file_type="xyz", mesh=PointCloud(points), now=now(),
    )  # fmt: skip
    return row.id


def test_point_clouds_are_indexed_and_asked_for(site: Site, network: ExtentClassifier) -> None:
    add_classifier(site)
    inside = upload_scan(site, "long.xyz", (0.2, 0.2, 4.0))
    row = ask(site, [*upload_all(site), inside])
    run(site, row.job_id)
    assert collection(site, row.id).skipped == []
    assert set(names(retrieve(site, row.id, class_name="rod", evidence="probabilities"))[:3]) == {
        "long.off", "longer.off", "long.xyz",
    }  # fmt: skip
    by_cloud = retrieve(site, row.id, mesh_id=upload_scan(site, "flat.xyz", (2.2, 2.0, 0.2)))
    assert set(names(by_cloud)[:2]) == {"flat.off", "wide.off"}
    assert by_cloud.sheet_key is not None


def test_the_job_of_a_point_cloud_without_a_surface_says_so(site: Site) -> None:
    cloud = upload_scan(site, "long.xyz", (0.2, 0.2, 4.0))
    with closing(MeshReader()) as reader:
        context = JobContext(None, site.database, site.artifacts, None, None, reader)  # type: ignore[arg-type]
        assert isinstance(context.load_query(cloud), PointCloud)
        with pytest.raises(MeshError, match="cloud of 300 points"):
            context.load_mesh(cloud)


def test_a_mesh_that_cannot_be_described_is_said(
    site: Site, network: ExtentClassifier, monkeypatch: pytest.MonkeyPatch
) -> None:
    add_classifier(site)
    row = ask(site, upload_all(site)[:1])
    run(site, row.job_id)
    query = upload(site, "query.off", box((1.0, 2.0, 3.0)))
    load = JobContext.load_query

    def no_area(self: JobContext, mesh_id: str) -> TriangleMesh:
        if mesh_id == query:
            raise MeshError("the surface has no area")
        return load(self, mesh_id)

    monkeypatch.setattr(JobContext, "load_query", no_area)
    done = retrieve(site, row.id, mesh_id=query)
    assert (done.job.state, done.result, done.sheet_key) == (JobState.FAILED, None, None)
    assert done.job.error_detail == "the surface has no area"
