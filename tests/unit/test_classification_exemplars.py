"""Exemplars: kept in a file, searched by distance, and drawn again with the very parameters they had."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from simple_shapes import BoxModel, toy_classes

from models_store.library.shipped import load_shipped
from shapewright.classification import Exemplars
from shapewright.distances.panorama import DESCRIPTOR_SIZE, PanoramaDescriptor, panorama_descriptor
from shapewright.errors import ClassifierError
from shapewright.mapped_arrays import read_arrays, read_header, write_arrays
from shapewright.modeling import compile_model
from shapewright.training import TrainingSettings
from shapewright.training.broken.breaking import is_broken
from shapewright.training.dataset import plan_learning
from shapewright.training.exemplars import exemplars_of, representatives

SETTINGS = TrainingSettings(variations=5, negatives=0, subdivision_steps=1, seed=4, broken=0.0)
NAMES = ("classes", "models", "numbers", "levels", "largest")


def described(classes, settings: TrainingSettings = SETTINGS) -> Exemplars:
    """The exemplars of these classes, with no picture drawn."""
    plan = plan_learning(classes, (), settings)
    meshes = [mesh for chunk, _ in plan.chunks for mesh in chunk.meshes(settings)]
    descriptors = np.stack([panorama_descriptor(mesh.vertices, mesh.faces).to_array() for mesh in meshes])
    return exemplars_of(plan, descriptors, settings)


@pytest.fixture(scope="module")
def classes() -> dict:
    toys = toy_classes()
    return {"table": [compile_model(load_shipped("table_wire")), toys["bench"][0]], "cross": toys["cross"]}


@pytest.fixture(scope="module")
def exemplars(classes) -> Exemplars:
    return described(classes)


def test_rows_tell_where_they_come_from(exemplars: Exemplars, classes) -> None:
    assert len(exemplars) == 10
    assert exemplars.class_names == ("table", "cross")
    assert exemplars.classes.tolist() == [0] * 5 + [1] * 5
    assert exemplars.models.tolist() == [0, 0, 0, 1, 1, 2, 2, 2, 2, 2]
    assert exemplars.numbers.tolist() == [0, 1, 2, 0, 1, 0, 1, 2, 3, 4]
    generators = [generator for generators in classes.values() for generator in generators]
    assert exemplars.digests == tuple(generator.model.digest for generator in generators)


def test_whole_variations_alone_are_exemplars(exemplars: Exemplars, classes) -> None:
    found = described(classes, replace(SETTINGS, broken=0.6))
    whole = [row for row, number in enumerate(exemplars.numbers) if not is_broken(int(number), 0.6)]
    assert len(found) == len(whole) < len(exemplars)
    assert set(found.models.tolist()) == {0, 1, 2}, "the first variation of each model is whole"
    for name in ("classes", "models", "numbers", "descriptors"):
        assert np.array_equal(getattr(found, name), getattr(exemplars, name)[whole])


def test_an_exemplars_parameters_are_those_of_its_mesh(exemplars: Exemplars, classes) -> None:
    generators = [generator for generators in classes.values() for generator in generators]
    seen = set()
    for row in range(len(exemplars)):
        generator = generators[exemplars.models[row]]
        values = exemplars.values(row, generator)
        (mesh,) = generator.instances(values[None], exemplars.subdivision_steps)
        descriptor = panorama_descriptor(mesh.vertices, mesh.faces).to_array()
        assert np.allclose(descriptor, exemplars.descriptors[row], atol=1e-5)
        seen.add(values.tobytes())
    assert len(seen) == len(exemplars)


def test_parameters_are_found_beyond_the_first_series() -> None:
    many = replace(SETTINGS, variations=67)
    small = BoxModel("block", [((0, 0, 0), (1, 1, 1))])
    found = described({"block": [small], "cross": toy_classes()["cross"]}, many)
    for row in (63, 64, 66):
        (mesh,) = small.instances(found.values(row, small)[None])
        descriptor = panorama_descriptor(mesh.vertices, mesh.faces).to_array()
        assert np.allclose(descriptor, found.descriptors[row], atol=1e-5)


def test_parameters_of_another_model_are_refused(exemplars: Exemplars, classes) -> None:
    with pytest.raises(ClassifierError, match="another model"):
        exemplars.values(0, classes["cross"][0])


def test_a_file_is_small_and_keeps_distances(exemplars: Exemplars, tmp_path: Path) -> None:
    path = tmp_path / "a.exemplars.npz"
    exemplars.save(path)
    assert path.stat().st_size < len(exemplars) * DESCRIPTOR_SIZE + 4 * DESCRIPTOR_SIZE + 4096
    loaded = Exemplars.load(path)
    for name in ("class_names", "digests", "seed", "subdivision_steps"):
        assert getattr(loaded, name) == getattr(exemplars, name)
    for name in NAMES[:3]:
        assert np.array_equal(getattr(loaded, name), getattr(exemplars, name))
    assert loaded.descriptors.dtype == np.float32
    for row in exemplars.descriptors:
        descriptor = PanoramaDescriptor.from_array(row)
        exact = exemplars.distances(descriptor)
        moved = np.abs(loaded.distances(descriptor) - exact)
        assert moved[exact > 0.03].mean() < 0.003
        assert moved.max() < 0.03, "that of an exemplar to itself most of all"


def test_representatives_are_shared_by_the_models_and_near_to_the_rest(classes) -> None:
    every = described(classes, replace(SETTINGS, variations=20))
    kept = representatives(every, 6)
    assert kept.classes.tolist() == [0] * 6 + [1] * 6
    assert kept.models.tolist() == [0] * 3 + [1] * 3 + [2] * 6
    assert len(set(zip(kept.models.tolist(), kept.numbers.tolist(), strict=True))) == 12
    for model in range(3):
        rows = np.flatnonzero(every.models == model)
        numbers = kept.numbers[kept.models == model]
        between = np.array(
            [every.distances(PanoramaDescriptor.from_array(every.descriptors[row]))[rows] for row in rows]
        )
        assert between[:, numbers].min(axis=1).sum() < between[:, : len(numbers)].min(axis=1).sum()


def test_the_settings_say_how_many_are_kept_and_each_model_keeps_one(classes) -> None:
    assert len(described(classes, replace(SETTINGS, exemplars_per_class=4))) == 8
    assert described(classes, replace(SETTINGS, exemplars_per_class=1)).models.tolist() == [0, 1, 2]
    assert len(described(classes, replace(SETTINGS, exemplars_per_class=50))) == 10


def small(seed: int, exemplars: Exemplars) -> tuple[Exemplars, np.ndarray]:
    """Exemplars of three classes of one to three models, and made-up distances."""
    rng = np.random.default_rng(seed)
    owner = np.repeat(np.arange(3), rng.integers(1, 4, 3))
    models = np.concatenate([np.arange(len(owner)), rng.integers(0, len(owner), 12)])
    made = replace(
        exemplars,
        class_names=("a", "b", "c"),
        digests=tuple("0123456789"[number] * 64 for number in range(len(owner))),
        classes=owner[models],
        models=models,
        numbers=np.arange(len(models)),
        descriptors=np.tile(exemplars.descriptors[:1], (len(models), 1)),
    )
    return made, rng.uniform(size=len(models))


@given(seed=st.integers(0, 10_000), without=st.none() | st.integers(0, 2))
@settings(deadline=None, max_examples=60)
def test_the_nearest_is_found_as_by_brute_force(exemplars: Exemplars, seed: int, without: int | None) -> None:
    made, distances = small(seed, exemplars)
    near, rows = made.nearest(distances, without_model=without)
    owner = dict(zip(made.models.tolist(), made.classes.tolist(), strict=True))
    for number in range(3):
        candidates = [row for row in range(len(made)) if made.classes[row] == number]
        if without is not None and list(owner.values()).count(owner[without]) > 1:
            candidates = [row for row in candidates if made.models[row] != without]
        best = min(candidates, key=lambda row: distances[row])
        assert rows[number] == best
        assert near[number] == distances[best]


def test_a_class_keeps_its_only_model(exemplars: Exemplars) -> None:
    distances = np.arange(10.0)
    assert exemplars.nearest(distances, without_model=2)[1].tolist() == [0, 5], "cross has no other"
    assert exemplars.nearest(distances, without_model=0)[1].tolist() == [3, 5]


def test_damaged_and_foreign_files_are_refused(exemplars: Exemplars, tmp_path: Path) -> None:
    path = tmp_path / "a.exemplars.npz"
    exemplars.save(path)
    content, header = path.read_bytes(), read_header(path)
    arrays = dict(zip(NAMES, read_arrays(path, NAMES, memory_map=False), strict=True))
    for damaged in (b"", content[: len(content) // 2], b"no archive" * 50):
        path.write_bytes(damaged)
        with pytest.raises(ClassifierError) as caught:
            Exemplars.load(path)
        assert caught.value.where == path.name
    for other_header, other_arrays in (
        ({**header, "format": "cake"}, arrays),
        ({**header, "version": header["version"] + 1}, arrays),
        ({**header, "descriptor_version": header["descriptor_version"] + 1}, arrays),
        ({key: value for key, value in header.items() if key != "digests"}, arrays),
        ({**header, "class_names": ["table"]}, arrays),
        ({**header, "class_names": ["table", "cross", "sword"]}, arrays),
        (header, {key: value for key, value in arrays.items() if key != "numbers"}),
        (header, {**arrays, "classes": arrays["classes"][:-1]}),
        (header, {**arrays, "levels": arrays["levels"][:, :-1]}),
        (header, {**arrays, "levels": arrays["levels"] + np.uint8(64)}),
        (header, {**arrays, "levels": arrays["levels"][:, :-1], "largest": arrays["largest"][:-1]}),
    ):
        write_arrays(path, other_header, other_arrays)
        with pytest.raises(ClassifierError):
            Exemplars.load(path)
    with pytest.raises(ClassifierError, match="cannot be read"):
        Exemplars.load(tmp_path / "missing.npz")
