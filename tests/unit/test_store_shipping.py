"""What ships: each version is added to a database once, by whichever process comes first, and deletions stay."""

from concurrent.futures import ThreadPoolExecutor
from datetime import datetime
from hashlib import sha256
from pathlib import Path
from threading import Barrier

import pytest
from ready_classifier import write_ready_classifier
from sqlalchemy import delete, select
from store_support import FakeClock, clock, database  # noqa: F401 - fixtures

from models_store import catalog, shipping
from models_store.artifacts import ArtifactStore
from models_store.catalog import ShippedItem, ShippedKind
from models_store.catalog.shipped import classifier_id_of
from models_store.errors import ArtifactError
from models_store.library.shipped import list_classes, list_shipped, thumbnail_png
from models_store.session import Database
from models_store.shipping import READY_NAME, add_shipped
from models_store.tables import ClassifierRow, JobRow, ModelRow
from shapewright.classification.ready_files import READY_FILE
from shapewright.errors import ClassifierError
from shapewright.modeling import ProceduralModel, Recorder


@pytest.fixture
def artifacts() -> ArtifactStore:
    return ArtifactStore.open("memory://")


@pytest.fixture
def few_models(monkeypatch: pytest.MonkeyPatch) -> None:
    """A release with three models, which are added sooner than all."""
    few = {name: document for name, document in list_shipped().items() if name in ("chair", "gun", "stool")}
    monkeypatch.setattr(shipping, "list_shipped", lambda: few)


@pytest.fixture
def ready_dir(tmp_path: Path) -> Path:
    return write_ready_classifier(tmp_path / "ready")


def test_every_model_comes_with_its_picture_and_the_classifier_with_its_files(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
    ready_dir: Path,
) -> None:
    added = add_shipped(database, artifacts, now=clock.now, ready_dir=ready_dir)
    assert added == [*list_shipped(), READY_NAME]
    with database.reading() as session:
        rows = {row.name: row for row in session.scalars(select(ModelRow))}
        classes = {name: [row.name for row in rows] for name, rows in catalog.list_classes(session, limit=100).items}
        classifier = catalog.shipped_classifier(session)
        assert session.scalars(select(JobRow)).all() == []
    assert classes == list_classes()
    for name, document in list_shipped().items():
        assert rows[name].document.encode() == document.read_bytes()
        assert rows[name].id == ProceduralModel.from_json(rows[name].document).digest
        assert artifacts.get(str(rows[name].thumbnail_key)) == thumbnail_png(name)
    assert classifier is not None
    assert (classifier.name, classifier.state.value, classifier.job_id) == (READY_NAME, "succeeded", None)
    assert (classifier.class_names, classifier.model_ids) == (["box", "crate"], ["a" * 64])
    assert (classifier.metrics, classifier.settings) == ({"accuracy": 0.75, "loss": None}, {"variations": 3})
    assert artifacts.get(str(classifier.onnx_key)) == (ready_dir / READY_FILE).read_bytes()
    assert artifacts.get(str(classifier.exemplars_key)) == b"exemplars"
    clock.forward(60)
    assert add_shipped(database, artifacts, now=clock.now, ready_dir=ready_dir) == []


@pytest.mark.usefixtures("few_models")
def test_processes_that_start_at_once_add_everything_once(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
    ready_dir: Path,
) -> None:
    barrier = Barrier(3)

    def start(_: int) -> list[str]:
        barrier.wait()
        return add_shipped(database, artifacts, now=clock.now, ready_dir=ready_dir)

    with ThreadPoolExecutor(3) as pool:
        added = [name for names in pool.map(start, range(3)) for name in names]
    assert sorted(added) == ["chair", "gun", READY_NAME, "stool"]


@pytest.mark.usefixtures("few_models")
def test_what_was_deleted_stays_deleted(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
    ready_dir: Path,
) -> None:
    add_shipped(database, artifacts, now=clock.now, ready_dir=ready_dir)
    with database.writing() as session:
        session.execute(delete(ModelRow).where(ModelRow.class_name == "gun"))
        session.execute(delete(ClassifierRow))
    write_ready_classifier(ready_dir, class_names=["box", "crate", "tin"])  # a later release has another
    assert add_shipped(database, artifacts, now=clock.now, ready_dir=ready_dir) == []
    with database.reading() as session:
        assert catalog.shipped_classifier(session) is None
        assert session.scalars(select(ModelRow.id).where(ModelRow.class_name == "gun")).all() == []


@pytest.mark.usefixtures("few_models")
def test_a_later_release_adds_its_version_beside_the_older_one(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
    ready_dir: Path,
) -> None:
    first, second = _lamp(1.0), _lamp(2.0)
    for model in (first, second):
        assert _missing(database, model)
        assert _add(database, model, clock.forward(60))
        assert not _missing(database, model)
        assert not _add(database, model, clock.forward(60))
    assert not _missing(database, first)  # an older process that starts later changes nothing
    with database.reading() as session:
        assert [row.id for row in catalog.models_of_class(session, "lamp")] == [second.digest]

    add_shipped(database, artifacts, now=clock.now, ready_dir=ready_dir)
    write_ready_classifier(ready_dir, class_names=["box", "crate", "tin"])
    assert add_shipped(database, artifacts, now=clock.forward(60), ready_dir=ready_dir) == [READY_NAME]
    with database.reading() as session:
        newest = catalog.shipped_classifier(session)
        assert newest is not None
        assert newest.class_names == ["box", "crate", "tin"]
        assert len(catalog.list_classifiers(session).items) == 2


def test_a_model_that_was_uploaded_before_gets_its_picture(database: Database, clock: FakeClock) -> None:  # noqa: F811
    with database.writing() as session:
        before, _ = catalog.add_model(session, _lamp(1.0), now=clock.now)
    assert _add(database, _lamp(1.0), clock.forward(60))
    with database.reading() as session:
        row = catalog.get_model(session, before.id)
    assert (row.thumbnail_key, row.created_at) == ("lamp.png", before.created_at)


def test_without_room_for_pictures_nothing_is_added(database: Database, clock: FakeClock) -> None:  # noqa: F811
    class Full(ArtifactStore):
        def __init__(self) -> None:
            pass

        def put(self, key: str, data: bytes) -> None:
            raise ArtifactError(f"no space left for {key}")

    with pytest.raises(ArtifactError):
        add_shipped(database, Full(), now=clock.now)
    with database.reading() as session:
        assert session.scalars(select(ModelRow)).all() == []


@pytest.mark.usefixtures("few_models")
@pytest.mark.parametrize("damage", ["missing", "cut", "foreign", "newer"])
def test_a_classifier_that_cannot_be_read_is_refused_after_the_models_are_there(
    database: Database,  # noqa: F811
    clock: FakeClock,  # noqa: F811
    artifacts: ArtifactStore,
    ready_dir: Path,
    damage: str,
) -> None:
    path = ready_dir / READY_FILE
    if damage == "missing":
        path.unlink()
    elif damage == "cut":
        path.write_bytes(path.read_bytes()[:-20])
    elif damage == "foreign":
        path.write_bytes(b"\x89PNG\r\n\x1a\n")
    else:
        write_ready_classifier(ready_dir, version=10_000)
    with pytest.raises(ClassifierError):
        add_shipped(database, artifacts, now=clock.now, ready_dir=ready_dir)
    with database.reading() as session:
        assert len(session.scalars(select(ModelRow)).all()) == 3
        assert catalog.shipped_classifier(session) is None


def test_ids_of_classifiers_are_as_long_as_others() -> None:
    assert len(classifier_id_of(sha256(b"").hexdigest())) == 32


def _lamp(height: float) -> ProceduralModel:
    recorder = Recorder("lamp", "lamp")
    recorder.box(1.0, 1.0, height)
    return recorder.build()


def _item(model: ProceduralModel) -> ShippedItem:
    return ShippedItem(ShippedKind.MODEL, model.name, model.digest)


def _missing(database: Database, model: ProceduralModel) -> bool:  # noqa: F811
    with database.reading() as session:
        return catalog.missing_shipped(session, [_item(model)]) == [_item(model)]


def _add(database: Database, model: ProceduralModel, now: datetime) -> bool:  # noqa: F811
    with database.writing() as session:
        return catalog.add_shipped_model(
            session, _item(model), model, model.to_json(), thumbnail_key="lamp.png", now=now
        )
