"""Coverage: the nearest variation of each class is found, whatever was kept of earlier runs."""

import html.parser
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from small_dataset import bent_rod, rod, slab, write_dataset

from shapewright.distances.panorama import panorama_descriptor, panorama_distance
from shapewright.errors import Cancelled, EvaluationError
from shapewright.estimation.bank import PanoramaBank
from shapewright.estimation.rotation_like import rotation_like
from shapewright.evaluation import descriptor_cache
from shapewright.evaluation.coverage import Coverage, measure_coverage
from shapewright.evaluation.datasets import LabelledFile, of_classes, read_dataset
from shapewright.evaluation.descriptor_cache import BankRequest, DescriptorCache
from shapewright.evaluation.metrics import coverage_of_classes
from shapewright.evaluation.report import coverage_report
from shapewright.mesh.file import load_mesh
from shapewright.modeling import CompiledModel, compile_model
from shapewright.progress import CallbackProgress

SLAB, ROD, BENT = compile_model(slab()), compile_model(rod()), compile_model(bent_rod())
MODELS = {"rod": [ROD, BENT], "slab": [SLAB]}


@pytest.fixture(scope="module")
def items(tmp_path_factory: pytest.TempPathFactory) -> tuple[LabelledFile, ...]:
    folder = tmp_path_factory.mktemp("data")
    write_dataset(folder, [(SLAB, 3), (ROD, 2), (BENT, 2)])
    return of_classes(read_dataset(folder), MODELS)


@pytest.fixture(scope="module")
def filled(items: tuple[LabelledFile, ...], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache that a first run left."""
    folder = tmp_path_factory.mktemp("cache")
    measured(items, folder)
    return folder


@pytest.fixture
def cache(filled: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    return Path(shutil.copytree(filled, tmp_path / "cache"))


def measured(items: tuple[LabelledFile, ...], folder: Path, samples: int = 40, **options: object) -> Coverage:
    return measure_coverage(items, MODELS, DescriptorCache(folder), samples=samples, **options)  # type: ignore[arg-type]


def test_the_nearest_variation_is_as_near_as_is_told_and_none_is_nearer(
    items: tuple[LabelledFile, ...], cache: Path
) -> None:
    found = measured(items, cache)
    by_name = {compiled.model.name: compiled for models in MODELS.values() for compiled in models}
    assert {name: request.samples for name, request in found.requests.items()} == {
        "rod": 20, "rod_bent": 20, "slab": 40
    }  # fmt: skip
    for query, neighbours in zip(found.queries, found.neighbours, strict=True):
        mesh = load_mesh(query.item.path)
        descriptor = panorama_descriptor(mesh.vertices, mesh.faces)
        for class_name, models in MODELS.items():
            nearest = neighbours[class_name]
            instance = by_name[nearest.model].instance(found.values(nearest))
            exact = panorama_distance(descriptor, panorama_descriptor(instance.vertices, instance.faces))
            assert exact == pytest.approx(nearest.distance, abs=1e-5)
            for compiled in models:
                for values in compiled.random_values(np.random.default_rng(0), 5):
                    other = compiled.instance(values)
                    away = panorama_distance(descriptor, panorama_descriptor(other.vertices, other.faces))
                    assert away >= nearest.distance - 1e-6


def test_own_variations_are_nearest_and_figures_agree(items: tuple[LabelledFile, ...], cache: Path) -> None:
    found = measured(items, cache)
    summed = coverage_of_classes(found)
    assert list(summed) == ["rod", "slab"]
    assert summed["rod"].n == 4
    assert summed["rod"].models == {"rod": 2, "rod_bent": 2}
    for name, figures in summed.items():
        own = [near[name].distance for q, near in zip(found.queries, found.neighbours, strict=True)
               if q.item.class_name == name]  # fmt: skip
        assert figures.own_median == pytest.approx(np.median(own))
        assert figures.own_is_nearest
        assert figures.share_nearest == 1.0
        assert figures.nearest_other_class != name
        assert figures.medians[name] == figures.own_median < figures.nearest_other_median  # type: ignore[operator]


def test_unreadable_meshes_are_skipped_by_name(items: tuple[LabelledFile, ...], cache: Path) -> None:
    for jobs in (1, 2):
        found = measured(items, cache, jobs=jobs)
        assert [skipped.file for skipped in found.skipped] == ["broken.off", "missing.off"]
        assert all(skipped.reason for skipped in found.skipped)
        assert len(found.queries) == len(items) - 2


def test_what_was_kept_is_used_again_and_changes_nothing(
    items: tuple[LabelledFile, ...], cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = measured(items, cache)

    def refuse(*arguments: object) -> None:
        raise AssertionError("computed again")

    monkeypatch.setattr("shapewright.evaluation.coverage.panorama_descriptor", refuse)
    monkeypatch.setattr("shapewright.evaluation.coverage.panorama_distances", refuse)
    monkeypatch.setattr(descriptor_cache, "build_bank", refuse)
    again = measured(items, cache)
    assert again.neighbours == first.neighbours
    with pytest.raises(AssertionError, match="computed again"):
        measured(items, cache, seed=1)


def test_a_changed_model_replaces_what_was_kept_of_it(tmp_path: Path) -> None:
    cache = DescriptorCache(tmp_path)
    cache.bank(BankRequest(SLAB, 8, 0))
    cache.bank(BankRequest(ROD, 8, 0))
    parameter = replace(SLAB.model.parameters[0], maximum=1.5)
    changed = compile_model(replace(SLAB.model, parameters=(parameter,)))
    bank = cache.bank(BankRequest(changed, 8, 0))
    assert bank.model_digest == changed.model.digest
    assert sorted(path.name.split("-")[0] for path in tmp_path.glob("*.npz")) == ["rod", "slab"]


class MovedModel(CompiledModel):
    """The same document, another kernel: what a changed program would make of it."""

    def random_values(self, rng: np.random.Generator, count: int) -> np.ndarray:
        return super().random_values(rng, count)[::-1].copy()


def test_a_bank_that_the_program_would_not_make_any_more_is_made_anew(tmp_path: Path) -> None:
    cache = DescriptorCache(tmp_path)
    old = np.array(cache.bank(BankRequest(SLAB, 8, 0)).values)
    new = cache.bank(BankRequest(MovedModel(SLAB.model), 8, 0))
    np.testing.assert_array_equal(new.values, old[::-1])


def test_a_bank_that_another_process_maps_is_replaced_in_one_step(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = DescriptorCache(tmp_path)
    cache.bank(BankRequest(SLAB, 8, 0))
    save = PanoramaBank.save
    there = []

    def watched(self: PanoramaBank, path: Path) -> None:
        there.append(path.exists())
        save(self, path)

    monkeypatch.setattr(PanoramaBank, "save", watched)
    cache.bank(BankRequest(MovedModel(SLAB.model), 8, 0))
    assert there == [True]


def test_damaged_files_of_the_cache_are_made_anew(items: tuple[LabelledFile, ...], cache: Path) -> None:
    first = measured(items, cache)
    for path in cache.iterdir():
        path.write_bytes(path.read_bytes()[:20])
    assert measured(items, cache).neighbours == first.neighbours


def test_misuse_is_refused(items: tuple[LabelledFile, ...], cache: Path) -> None:
    with pytest.raises(EvaluationError, match="rod: no procedural model"):
        measure_coverage(items, {"slab": [SLAB]}, DescriptorCache(cache), samples=5)
    with pytest.raises(EvaluationError, match="too few for 2 models"):
        measured(items, cache, samples=1)
    with pytest.raises(EvaluationError, match="broken"):
        measured(tuple(item for item in items if item.file == "broken.off"), cache)


def test_progress_rises_and_may_cancel(items: tuple[LabelledFile, ...], cache: Path) -> None:
    told: list[float] = []
    measured(items, cache, seed=3, progress=CallbackProgress(lambda fraction, _: told.append(fraction)))
    assert told == sorted(told)

    def cancel(fraction: float, message: str) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        measured(items, cache, seed=4, progress=CallbackProgress(cancel))


def test_a_mesh_is_turned_like_the_variation_beside_it() -> None:
    wanted = ROD.instance(np.array([1.3]))
    turn = np.array([[0.0, -1.0, 0.0], [0.6, 0.0, -0.8], [0.8, 0.0, 0.6]])
    turned = wanted.transformed(turn, np.array([3.0, 1.0, 2.0]), 4.0)
    found = rotation_like(turned, wanted, np.random.default_rng(0)) @ turn
    np.testing.assert_allclose(found[2, 2], 1.0, atol=0.02)  # the rod stands upright, its foot down
    assert np.linalg.det(found) == pytest.approx(1.0)


class PageReader(html.parser.HTMLParser):
    """Collects what a page refers to, and its text."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href")]

    def handle_data(self, data: str) -> None:
        self.text += data


def test_the_report_holds_its_pictures_and_escapes_names(items: tuple[LabelledFile, ...], cache: Path) -> None:
    found = measured(items, cache)
    reader = PageReader()
    reader.feed(coverage_report(found, coverage_of_classes(found), title="<b>mine</b> & more", worst=2))
    assert len(reader.addresses) == 2 * 2 * 2
    assert all(address.startswith("data:image/png;base64,") for address in reader.addresses)
    assert reader.text.count("Coverage of <b>mine</b> & more") == 2
    assert "broken.off" in reader.text
    assert "rod_bent 2×" in reader.text
