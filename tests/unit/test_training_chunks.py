"""Chunks: each depends on nothing but itself, is computed once, and lets a training go on where it was."""

from dataclasses import replace

import numpy as np
import pytest
from simple_shapes import BoxModel, toy_classes

from shapewright.classification.readings import plain_reading
from shapewright.classification.series import SERIES
from shapewright.distances.panorama import panorama_descriptor
from shapewright.errors import Cancelled, ClassifierError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.network import FeatureExtractor, load_backbone
from shapewright.progress import CallbackProgress
from shapewright.training import FolderStore, MemoryStore, TrainingSettings, learning
from shapewright.training.array_store import ArrayStore
from shapewright.training.broken.breaking import is_broken
from shapewright.training.chunks import (
    Chunk,
    chunk_images,
    chunks_of,
    descriptors_key,
    features_key,
    is_stored,
    store_chunk,
)
from shapewright.training.dataset import load_features, plan_learning
from shapewright.training.learning import train_classifier
from shapewright.training.sources import (
    AssemblySource,
    DistortedSource,
    MixedSource,
    ModelSource,
    Source,
)

SMALL = TrainingSettings(
    variations=6, images_per_variation=2, image_size=64, negatives=2, exemplars=False, held_out=0.25, epochs=5, seed=3
)
BOXES = [models[0] for models in toy_classes().values()]
SOURCES = [ModelSource(BOXES[0]), AssemblySource(), DistortedSource(BOXES), MixedSource(BOXES[:1], BOXES[1:])]


class CountingExtractor(FeatureExtractor):
    """Tells how many pictures were described."""

    seen: list[int] = []  # noqa: RUF012 - of all extractors

    def __call__(self, images: np.ndarray) -> np.ndarray:
        self.seen.append(len(images))
        return super().__call__(images)


@pytest.fixture
def seen(monkeypatch) -> list[int]:
    """Numbers of pictures that networks were asked about from now on."""
    monkeypatch.setattr(learning, "FeatureExtractor", CountingExtractor)
    monkeypatch.setattr(CountingExtractor, "seen", [])
    return CountingExtractor.seen


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.name)
def test_a_shorter_chunk_is_the_beginning_of_a_longer_one(source: Source) -> None:
    long, short = Chunk(source, 1, 5), Chunk(source, 1, 2)
    pictures = chunk_images(long, SMALL)
    drawn = chunk_images(short, SMALL)
    assert np.array_equal(drawn, pictures[: len(drawn)])
    assert np.array_equal(short.broken(SMALL), long.broken(SMALL)[:2])
    for one, other in zip(short.meshes(SMALL), long.meshes(SMALL), strict=False):
        assert np.array_equal(one.vertices, other.vertices)
        assert np.array_equal(one.faces, other.faces)
    for one, other in zip(short.views(SMALL), long.views(SMALL), strict=True):
        assert np.array_equal(one, other[:2])
    assert not np.array_equal(chunk_images(Chunk(source, 0, 5), SMALL), pictures), "another chunk, other meshes"
    assert not np.array_equal(chunk_images(long, replace(SMALL, seed=4)), pictures)


def test_pictures_of_triangles_do_not_depend_on_those_beside_them() -> None:
    settings = replace(SMALL, style="fused", broken=0.0)
    pictures, drawn = (chunk_images(Chunk(SOURCES[0], 1, count), settings) for count in (5, 2))
    differing = (drawn != pictures[: len(drawn)]).mean()
    assert differing < 1e-3, "but for the rounding at edges of pictures that lie elsewhere in the atlas"


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.name)
def test_objects_are_the_meshes_but_for_the_broken_ones(source: Source) -> None:
    chunk = Chunk(source, 0, 10)
    flags = chunk.broken(SMALL)
    assert flags.tolist() == [is_broken(number, SMALL.broken) for number in range(10)]
    assert 3 <= flags.sum() <= 8
    for mesh, learned, is_one in zip(chunk.meshes(SMALL), chunk.objects(SMALL), flags, strict=True):
        same = (
            isinstance(learned, TriangleMesh)
            and np.array_equal(learned.vertices, mesh.vertices)
            and np.array_equal(learned.faces, mesh.faces)
        )
        assert same != is_one
    for one, again in zip(chunk.objects(SMALL), chunk.objects(SMALL), strict=True):
        assert np.array_equal(_positions(one), _positions(again))
    other = replace(SMALL, seed=4, breaks=("sparse",))
    clouds = [one for one in chunk.objects(other) if isinstance(one, PointCloud)]
    assert len(clouds) == flags.sum()
    assert len({len(cloud.points) for cloud in clouds}) == len(clouds), "each is broken in its own way"


def _positions(one: TriangleMesh | PointCloud) -> np.ndarray:
    return one.points if isinstance(one, PointCloud) else one.vertices


@pytest.mark.parametrize("change", [{"broken": 0.0}, {"breaks": ()}])
def test_without_breaks_all_meshes_stay_whole(change: dict) -> None:
    chunk, settings = Chunk(SOURCES[0], 0, 10), replace(SMALL, **change)
    assert not chunk.broken(settings).any()
    for mesh, learned in zip(chunk.meshes(settings), chunk.objects(settings), strict=True):
        assert np.array_equal(_positions(learned), mesh.vertices)


def test_descriptors_are_of_the_objects_as_they_are_learned_from_every_other_by_surfels() -> None:
    chunk, store = Chunk(SOURCES[0], 0, 5), MemoryStore()
    store_chunk(chunk, SMALL, FeatureExtractor(load_backbone()), store, described=True)
    stored = store.get(descriptors_key(chunk, SMALL))
    assert stored is not None
    for number, (one, row) in enumerate(zip(chunk.objects(SMALL), stored, strict=True)):
        surface = plain_reading(one).described_surface(by_surfels=number % 2 == 1)
        assert np.array_equal(panorama_descriptor(surface.vertices, surface.faces).to_array(), row)


def test_a_name_of_descriptors_says_all_that_they_depend_on() -> None:
    chunk = Chunk(SOURCES[0], 0, 3)
    changes = ({}, {"seed": 4}, {"subdivision_steps": 1}, {"broken": 0.3}, {"breaks": ("noise",)})
    keys = [descriptors_key(chunk, replace(SMALL, **change)) for change in changes]
    assert len(set(keys)) == len(keys)
    for change in ({"image_size": 96}, {"images_per_variation": 3}, {"scale_range": (0.5, 1.0)}, {"epochs": 9}):
        assert descriptors_key(chunk, replace(SMALL, **change)) == keys[0], "geometry has no pictures"


@pytest.mark.parametrize("count", [1, SERIES - 1, SERIES, SERIES + 1, 3 * SERIES])
def test_chunks_cut_a_source_without_a_rest(count: int) -> None:
    chunks = chunks_of(SOURCES[0], count)
    assert [chunk.number for chunk in chunks] == list(range(len(chunks)))
    assert sum(chunk.count for chunk in chunks) == count
    assert all(chunk.count == SERIES for chunk in chunks[:-1])


def test_descriptors_of_another_version_are_computed_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    chunk, backbone, store = Chunk(SOURCES[0], 0, 3), load_backbone(), MemoryStore()
    for key in (features_key(chunk, SMALL, backbone), descriptors_key(chunk, SMALL)):
        store.put(key, np.zeros(1))
    assert is_stored(chunk, SMALL, backbone, store, described=True)
    monkeypatch.setattr("shapewright.distances.descriptor_files.VERSION", 99)
    assert is_stored(chunk, SMALL, backbone, store, described=False)
    assert not is_stored(chunk, SMALL, backbone, store, described=True)


def test_a_name_says_all_that_the_features_depend_on() -> None:
    chunk, backbone = Chunk(SOURCES[0], 0, 3), load_backbone()
    keys = [features_key(chunk, SMALL, backbone)]
    keys += [
        features_key(chunk, replace(SMALL, **change), backbone)
        for change in (
            {"seed": 4},
            {"images_per_variation": 3},
            {"image_size": 96},
            {"scale_range": (0.5, 1.0)},
            {"style": "depth", "broken": 0.0},
            {"style": "fused", "broken": 0.0},
            {"style": "fused", "broken": 0.0, "framing": "paper"},
            {"style": "fused", "broken": 0.0, "window": 2.0},
            {"subdivision_steps": 1},
            {"broken": 0.3},
            {"breaks": ("noise",)},
        )
    ]
    keys.append(features_key(chunk, SMALL, load_backbone("efficientnet_lite0_random")))
    keys += [features_key(Chunk(*place), SMALL, backbone) for place in ((SOURCES[0], 1, 3), (SOURCES[0], 0, 4))]
    keys += [features_key(Chunk(source, 0, 3), SMALL, backbone) for source in SOURCES[1:]]
    assert len(set(keys)) == len(keys)
    learning = replace(SMALL, epochs=9, negatives=7, variations=50, held_out=0.5, learning_rate=0.1)
    assert features_key(chunk, learning, backbone) == keys[0], "how one learns does not matter"


def test_what_is_stored_is_not_computed_again(seen) -> None:
    store = MemoryStore()
    first = train_classifier(toy_classes(), SMALL, store=store)
    pictures = (3 * 6 + 2 + 3 + 2) * 2
    assert sum(seen) == pictures
    again = train_classifier(toy_classes(), replace(SMALL, epochs=3), store=store)
    assert sum(seen) == pictures
    assert again.onnx != first.onnx
    with_exemplars = train_classifier(toy_classes(), replace(SMALL, exemplars=True), store=store)
    assert sum(seen) == pictures, "descriptors need no pictures"
    whole = [number for number in range(6) if not is_broken(number, SMALL.broken)]
    assert with_exemplars.exemplars.numbers.tolist() == 3 * whole


def test_a_training_goes_on_where_it_was_cancelled(seen, tmp_path) -> None:
    def stop(fraction: float, message: str) -> None:
        if message.startswith("block"):
            raise Cancelled

    store = FolderStore(tmp_path)
    with pytest.raises(Cancelled):
        train_classifier(toy_classes(), SMALL, CallbackProgress(stop), store=store)
    done = sum(seen)
    assert done == 2 * 6 * 2, "bench and cross"
    resumed = train_classifier(toy_classes(), SMALL, store=store)
    assert sum(seen) == (3 * 6 + 2 + 3 + 2) * 2, "nothing twice"
    assert resumed.onnx == train_classifier(toy_classes(), SMALL).onnx


def test_a_cancelled_chunk_leaves_nothing(tmp_path) -> None:
    def stop(fraction: float, message: str) -> None:
        if fraction > 0:
            raise Cancelled

    extractor, store, chunk = FeatureExtractor(load_backbone()), FolderStore(tmp_path), Chunk(SOURCES[0], 0, 20)
    with pytest.raises(Cancelled):
        store_chunk(chunk, SMALL, extractor, store, described=True, progress=CallbackProgress(stop))
    assert not list(tmp_path.rglob("*.npy"))


def test_an_added_class_computes_its_own_chunks_alone(seen) -> None:
    settings = replace(SMALL, negatives=0)
    classes, store = toy_classes(), MemoryStore()
    train_classifier({name: classes[name] for name in ("bench", "cross")}, settings, store=store)
    assert sum(seen) == 2 * 6 * 2
    added = train_classifier({"block": classes["block"], **classes}, settings, store=store)
    assert sum(seen) == 3 * 6 * 2
    assert added.onnx == train_classifier({"block": classes["block"], **classes}, settings).onnx


def test_a_changed_model_computes_its_own_chunks_alone(seen) -> None:
    settings = replace(SMALL, negatives=0)
    classes, store = toy_classes(), MemoryStore()
    train_classifier(classes, settings, store=store)
    before = sum(seen)
    changed = BoxModel("block of another kind", [((0, 0, 0), (1, 2, 1))])
    train_classifier({**classes, "block": [changed]}, settings, store=store)
    assert sum(seen) == before + 6 * 2


def _stored(store: ArrayStore, chunk: Chunk) -> list[np.ndarray]:
    keys = (features_key(chunk, SMALL, load_backbone()), descriptors_key(chunk, SMALL))
    return [np.asarray(store.get(key)) for key in keys]


def test_features_and_descriptors_of_a_shorter_chunk_are_the_beginning() -> None:
    extractor, store = FeatureExtractor(load_backbone()), MemoryStore()
    chunks = [Chunk(SOURCES[0], 0, count) for count in (11, 4)]
    for chunk in chunks:
        assert not is_stored(chunk, SMALL, extractor.backbone, store, described=True)
        store_chunk(chunk, SMALL, extractor, store, described=True)
        assert is_stored(chunk, SMALL, extractor.backbone, store, described=True)
    for long, short in zip(*(_stored(store, chunk) for chunk in chunks), strict=True):
        assert len(long) == 11
        assert np.array_equal(short, long[:4])


def test_what_is_missing_is_said() -> None:
    plan = plan_learning(toy_classes(), (), SMALL)
    with pytest.raises(ClassifierError, match="not stored"):
        load_features(plan, SMALL, load_backbone(), MemoryStore())
